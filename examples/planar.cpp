#include "planar.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace kaboum::examples {
namespace {

__extension__ using Wide = __int128;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Twice the signed area of (a, b, c); positive when counter-clockwise.
std::int64_t cross(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d lies strictly inside the circle through the counter-clockwise a, b, c.
bool in_circle(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const auto square = [&](const GridPoint& p) {
    return Wide(p.x - d.x) * (p.x - d.x) + Wide(p.y - d.y) * (p.y - d.y);
  };
  return square(a) * cross(d, b, c) + square(b) * cross(d, c, a) + square(c) * cross(d, a, b) > 0;
}

/// Triangulation with neighbours: adjacent[i] is across the side from corner i to corner i+1.
class Triangulation {
 public:
  explicit Triangulation(std::vector<GridPoint> points) : points_(std::move(points)) {
    const std::int64_t far = std::int64_t{1} << 27;
    first_extra_ = static_cast<std::uint32_t>(points_.size());
    points_.push_back({-far, -far});
    points_.push_back({far, -far});
    points_.push_back({0, far});
    faces_.push_back({{first_extra_, first_extra_ + 1, first_extra_ + 2}, {kNone, kNone, kNone}});
    for (std::uint32_t p = 0; p < first_extra_; ++p) insert(p);
  }

  /// Enforces every edge; flips for one leave the others alone, because they do not cross.
  void enforce(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> present;
    for (const Face& f : faces_) {
      for (int i = 0; i < 3; ++i) present.emplace(f.corner[i], f.corner[(i + 1) % 3]);
    }
    for (const auto& [a, b] : edges) {
      if (present.count({a, b}) == 0) enforce(a, b);
    }
  }

  /// Flips edges until a–b is one. @pre no other point lies on a–b.
  void enforce(std::uint32_t a, std::uint32_t b) {
    std::deque<std::pair<std::uint32_t, std::uint32_t>> crossing = edges_crossing(a, b);
    std::size_t budget = 100 + 10 * crossing.size() * crossing.size();
    while (!crossing.empty()) {
      ensure(budget-- > 0, "an edge of a planar face could not be enforced");
      const auto [u, v] = crossing.front();
      crossing.pop_front();
      const auto [face, side] = find(u, v);
      const std::uint32_t other = faces_[face].adjacent[side];
      const std::uint32_t p = faces_[face].corner[(side + 2) % 3];
      const std::uint32_t q = faces_[other].corner[(side_to(other, face) + 2) % 3];
      if (cross(points_[p], points_[q], points_[v]) <= 0 ||
          cross(points_[q], points_[p], points_[u]) <= 0) {
        crossing.push_back({u, v});  // not convex yet
        continue;
      }
      flip(face, side);
      if (separates(a, b, p, q)) crossing.push_back({p, q});
    }
  }

  /// Triangles on the left of the given closed loops of edges.
  std::vector<std::array<std::uint32_t, 3>> inside(
      const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, bool> wall;
    for (const auto& e : edges) wall[e] = true;
    std::vector<char> state(faces_.size(), 0);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        if (wall.count({faces_[f].corner[i], faces_[f].corner[(i + 1) % 3]}) != 0)
          stack.push_back(f);
      }
    }
    while (!stack.empty()) {
      const std::uint32_t f = stack.back();
      stack.pop_back();
      if (state[f] != 0) continue;
      state[f] = 1;
      for (int i = 0; i < 3; ++i) {
        if (wall.count({faces_[f].corner[i], faces_[f].corner[(i + 1) % 3]}) != 0) continue;
        ensure(faces_[f].adjacent[i] != kNone, "a planar face leaks");
        stack.push_back(faces_[f].adjacent[i]);
      }
    }
    std::vector<std::array<std::uint32_t, 3>> result;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (state[f] == 0) continue;
      for (const std::uint32_t c : faces_[f].corner)
        ensure(c < first_extra_, "a planar face leaks");
      result.push_back(faces_[f].corner);
    }
    return result;
  }

 private:
  struct Face {
    std::array<std::uint32_t, 3> corner;
    std::array<std::uint32_t, 3> adjacent;
  };

  [[nodiscard]] const GridPoint& at(std::uint32_t face, int i) const {
    return points_[faces_[face].corner[i % 3]];
  }

  [[nodiscard]] int side_to(std::uint32_t face, std::uint32_t neighbour) const {
    for (int i = 0; i < 3; ++i) {
      if (faces_[face].adjacent[i] == neighbour) return i;
    }
    throw Error(ErrorCode::Internal, "internal error: neighbours of a planar face disagree");
  }

  /// Visibility walk to a triangle that contains p.
  std::uint32_t locate(const GridPoint& p) {
    std::uint32_t face = last_;
    for (std::size_t steps = 0; steps < 4 * faces_.size() + 10; ++steps) {
      int i = 0;
      const int turn = static_cast<int>(steps % 3);  // varied, or the walk may go in circles
      for (; i < 3; ++i) {
        const int s = (i + turn) % 3;
        if (cross(at(face, s), at(face, s + 1), p) < 0) {
          face = faces_[face].adjacent[s];
          break;
        }
      }
      if (i == 3) return face;
    }
    throw Error(ErrorCode::Internal, "internal error: planar point location does not end");
  }

  void insert(std::uint32_t index) {
    const GridPoint& p = points_[index];
    std::vector<std::uint32_t> cavity{locate(p)};
    std::vector<std::uint32_t> stack = cavity;
    std::map<std::uint32_t, bool> removed{{cavity[0], true}};
    while (!stack.empty()) {
      const std::uint32_t f = stack.back();
      stack.pop_back();
      for (const std::uint32_t n : faces_[f].adjacent) {
        if (n == kNone || removed.count(n) != 0) continue;
        if (!in_circle(at(n, 0), at(n, 1), at(n, 2), p)) continue;
        removed[n] = true;
        cavity.push_back(n);
        stack.push_back(n);
      }
    }
    struct Border {
      std::uint32_t from, to, outside;
    };
    std::vector<Border> border;
    for (const std::uint32_t f : cavity) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t n = faces_[f].adjacent[i];
        if (n != kNone && removed.count(n) != 0) continue;
        border.push_back({faces_[f].corner[i], faces_[f].corner[(i + 1) % 3], n});
      }
    }
    // The fan has two triangles more than the cavity: reuse its slots, then append.
    std::map<std::uint32_t, std::uint32_t> starting_at;
    std::vector<std::uint32_t> slot = cavity;
    while (slot.size() < border.size()) {
      slot.push_back(static_cast<std::uint32_t>(faces_.size()));
      faces_.emplace_back();
    }
    std::vector<std::pair<std::uint32_t, int>> outer_sides(border.size());
    for (std::size_t k = 0; k < border.size(); ++k) {
      const Border& b = border[k];
      ensure(cross(points_[b.from], points_[b.to], p) > 0, "two points of a planar face coincide");
      if (b.outside != kNone) {
        for (int i = 0; i < 3; ++i) {
          if (faces_[b.outside].corner[i] == b.to &&
              faces_[b.outside].corner[(i + 1) % 3] == b.from) {
            outer_sides[k] = {b.outside, i};
          }
        }
      }
    }
    for (std::size_t k = 0; k < border.size(); ++k) {
      const Border& b = border[k];
      faces_[slot[k]] = {{b.from, b.to, index}, {b.outside, kNone, kNone}};
      if (b.outside != kNone)
        faces_[outer_sides[k].first].adjacent[outer_sides[k].second] = slot[k];
      starting_at[b.from] = slot[k];
    }
    for (std::size_t k = 0; k < border.size(); ++k) {
      const std::uint32_t next = starting_at.at(border[k].to);
      faces_[slot[k]].adjacent[1] = next;
      faces_[next].adjacent[2] = slot[k];
    }
    last_ = slot[0];
  }

  /// The triangle and side that run u → v.
  [[nodiscard]] std::pair<std::uint32_t, int> find(std::uint32_t u, std::uint32_t v) const {
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        if (faces_[f].corner[i] == u && faces_[f].corner[(i + 1) % 3] == v) return {f, i};
      }
    }
    throw Error(ErrorCode::Internal, "internal error: an edge of a planar face is missing");
  }

  /// Whether the open segments a–b and u–v cross.
  [[nodiscard]] bool separates(std::uint32_t a, std::uint32_t b, std::uint32_t u,
                               std::uint32_t v) const {
    if (u == a || u == b || v == a || v == b) return false;
    const auto sign = [](std::int64_t s) { return (s > 0) - (s < 0); };
    return sign(cross(points_[a], points_[b], points_[u])) *
                   sign(cross(points_[a], points_[b], points_[v])) <
               0 &&
           sign(cross(points_[u], points_[v], points_[a])) *
                   sign(cross(points_[u], points_[v], points_[b])) <
               0;
  }

  [[nodiscard]] std::deque<std::pair<std::uint32_t, std::uint32_t>> edges_crossing(
      std::uint32_t a, std::uint32_t b) const {
    std::deque<std::pair<std::uint32_t, std::uint32_t>> result;
    for (const Face& f : faces_) {
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t u = f.corner[i], v = f.corner[(i + 1) % 3];
        if (u < v && separates(a, b, u, v)) result.emplace_back(u, v);
      }
    }
    return result;
  }

  /// Replaces the side u → v of `face`, with the opposite corners p and q, by p–q.
  void flip(std::uint32_t face, int side) {
    const std::uint32_t other = faces_[face].adjacent[side];
    const int back = side_to(other, face);
    const std::uint32_t u = faces_[face].corner[side], v = faces_[face].corner[(side + 1) % 3];
    const std::uint32_t p = faces_[face].corner[(side + 2) % 3];
    const std::uint32_t q = faces_[other].corner[(back + 2) % 3];
    const std::uint32_t vp = faces_[face].adjacent[(side + 1) % 3];
    const std::uint32_t pu = faces_[face].adjacent[(side + 2) % 3];
    const std::uint32_t uq = faces_[other].adjacent[(back + 1) % 3];
    const std::uint32_t qv = faces_[other].adjacent[(back + 2) % 3];
    faces_[face] = {{p, u, q}, {pu, uq, other}};
    faces_[other] = {{q, v, p}, {qv, vp, face}};
    if (uq != kNone) faces_[uq].adjacent[side_to(uq, other)] = face;
    if (vp != kNone) faces_[vp].adjacent[side_to(vp, face)] = other;
  }

  std::vector<GridPoint> points_;
  std::vector<Face> faces_;
  std::uint32_t first_extra_ = 0;
  std::uint32_t last_ = 0;
};

/// Square of the distance from p to the segment a–b.
double square_distance(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  const auto dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const auto px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double t = std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return (px - t * dx) * (px - t * dx) + (py - t * dy) * (py - t * dy);
}

bool well_inside(const GridPoint& p, const std::vector<Loop>& loops, double clearance) {
  bool odd = false;
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const GridPoint& a = loop[i];
      const GridPoint& b = loop[(i + 1) % loop.size()];
      if (square_distance(p, a, b) < clearance * clearance) return false;
      if ((a.y > p.y) != (b.y > p.y)) {
        const bool left = cross(a, b, p) > 0;
        if (left == (b.y > a.y)) odd = !odd;
      }
    }
  }
  return odd;
}

}  // namespace

PlanarMesh triangulate(const std::vector<Loop>& loops, double spacing) {
  PlanarMesh mesh;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  GridPoint low = loops.at(0).at(0), high = low;
  for (const Loop& loop : loops) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      mesh.points.push_back(loop[i]);
      edges.emplace_back(first + i, first + (i + 1) % count);
      low = {std::min(low.x, loop[i].x), std::min(low.y, loop[i].y)};
      high = {std::max(high.x, loop[i].x), std::max(high.y, loop[i].y)};
    }
  }
  // Rows of a triangular lattice.
  const auto dx = static_cast<std::int64_t>(spacing);
  const auto dy = static_cast<std::int64_t>(0.866 * spacing);
  int row = 0;
  for (std::int64_t y = low.y + dy / 2; y < high.y; y += dy, ++row) {
    for (std::int64_t x = low.x + (row % 2 == 0 ? dx / 2 : dx); x < high.x; x += dx) {
      if (well_inside({x, y}, loops, 0.6 * spacing)) mesh.points.push_back({x, y});
    }
  }
  Triangulation triangulation(mesh.points);
  triangulation.enforce(edges);
  mesh.triangles = triangulation.inside(edges);
  return mesh;
}

}  // namespace kaboum::examples
