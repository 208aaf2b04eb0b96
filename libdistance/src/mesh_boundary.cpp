// Boundary of a closed chain's solid: triangles that cross others are cut where they do, in exact
// arithmetic, and what remains is kept where exactly one side has a winding number of at least 1.
// The argument is in docs/algorithms/distances.md, "Solids".
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/distance/boundary.h>
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exact_polygon.h"

namespace kaboum::distance {
namespace {

using exact::Number;
using exact::Polygon;
using geom::Box3;
using geom::Mesh;
using geom::Triangle;
using geom::Vec3;
using Corners = std::array<Vec3, 3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr std::uint32_t kNone = ~0U;

bool overlap(const Box3& a, const Box3& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

Box3 box_of(const Corners& t) {
  Box3 box;
  for (const Vec3& p : t) box.extend(p);
  return box;
}

// -- which triangles meet ------------------------------------------------------------------------

Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
Kernel::Triangle_3 triangle(const Corners& t) { return {point(t[0]), point(t[1]), point(t[2])}; }

/// Whether two coplanar triangles with area have inner points in common: they do unless a side of
/// one of them has the other on its outside.
bool overlap_in_plane(const Corners& s, const Corners& t) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto side = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      return static_cast<int>(geom::orient2d(a[u], a[v], b[u], b[v], c[u], c[v]));
    };
    if (side(s[0], s[1], s[2]) == 0) continue;
    const auto apart = [&](const Corners& x, const Corners& y) {
      const int turn = side(x[0], x[1], x[2]);
      for (int k = 0; k < 3; ++k)
        if (std::all_of(y.begin(), y.end(),
                        [&](const Vec3& p) { return turn * side(x[k], x[(k + 1) % 3], p) <= 0; }))
          return true;
      return false;
    };
    return !apart(s, t) && !apart(t, s);
  }
  return false;
}

std::array<int, 3> sides(const Corners& plane, const Corners& t) {
  std::array<int, 3> s{};
  for (int k = 0; k < 3; ++k)
    s[k] = static_cast<int>(geom::orient3d(plane[0], plane[1], plane[2], t[k]));
  return s;
}
bool all_zero(const std::array<int, 3>& s) { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
bool one_sided(const std::array<int, 3>& s) { return s[0] != 0 && s[0] == s[1] && s[1] == s[2]; }

/// Cells of one triangle that are cut apart.
struct Cell {
  Polygon polygon;
  Box3 box;  ///< contains it
};

Box3 box_of(const Polygon& polygon) {
  Box3 box;
  for (const exact::Point& p : polygon) {
    const Vec3 x = exact::rounded(p);
    const Vec3 slack = 4e-16 * x.cwiseAbs() + Vec3::Constant(1e-300);
    box.extend(Vec3(x - slack));
    box.extend(Vec3(x + slack));
  }
  return box;
}

using Segment = std::array<exact::Point, 2>;

/// Where a triangle meets a plane that is not its own: no point, one, or the ends of a segment.
std::vector<exact::Point> meet(const Corners& t, const exact::Plane& plane) {
  std::array<exact::Point, 3> p;
  std::array<Number, 3> h;
  for (int k = 0; k < 3; ++k) {
    p[k] = exact::point(t[k]);
    h[k] = exact::height(plane, p[k]);
  }
  std::vector<exact::Point> out;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (h[i] == 0) out.push_back(p[i]);
    if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0)) {
      const Number s = h[i] / (h[i] - h[j]);
      exact::Point x;
      for (int k = 0; k < 3; ++k) x[k] = p[i][k] + s * (p[j][k] - p[i][k]);
      out.push_back(x);
    }
  }
  return out;
}

/// The segment in which two triangles meet whose planes differ; nullopt where it has no length.
std::optional<Segment> common_segment(const Corners& s, const Corners& t) {
  const exact::Plane ps = exact::plane_of(s), pt = exact::plane_of(t);
  std::vector<exact::Point> a = meet(s, pt), b = meet(t, ps);
  if (a.size() < 2 || b.size() < 2) return std::nullopt;
  const exact::Point direction = exact::cross(ps.normal, pt.normal);
  const auto sort = [&](std::vector<exact::Point>& ends) {
    if (exact::dot(direction, ends[0]) > exact::dot(direction, ends[1]))
      std::swap(ends[0], ends[1]);
  };
  sort(a);
  sort(b);
  const exact::Point& from =
      exact::dot(direction, a[0]) > exact::dot(direction, b[0]) ? a[0] : b[0];
  const exact::Point& to = exact::dot(direction, a[1]) < exact::dot(direction, b[1]) ? a[1] : b[1];
  if (exact::dot(direction, from) >= exact::dot(direction, to)) return std::nullopt;
  return Segment{from, to};
}

/// Cuts those cells, which lie in the plane with this normal, whose interior the segment enters.
void cut(std::vector<Cell>& cells, const exact::Point& normal, const Segment& segment) {
  const exact::Point along = exact::difference(segment[1], segment[0]);
  const exact::Plane plane{segment[0], exact::cross(normal, along)};
  const Box3 box = box_of(Polygon{segment[0], segment[1]});
  const Number length = exact::dot(along, along);
  Polygon below, above;
  for (std::size_t i = 0, end = cells.size(); i < end; ++i) {
    if (!overlap(box, cells[i].box)) continue;
    exact::split(cells[i].polygon, plane, below, above);
    if (below.empty() || above.empty()) continue;
    // Where the line enters and leaves the cell, along the segment.
    std::optional<Number> low, high;
    for (const exact::Point& p : below) {
      if (exact::height(plane, p) != 0) continue;
      const Number at = exact::dot(along, exact::difference(p, segment[0]));
      if (!low || at < *low) low = at;
      if (!high || at > *high) high = at;
    }
    if (!low || *low >= length || *high <= 0) continue;
    cells[i] = {below, box_of(below)};
    cells.push_back({above, box_of(above)});
  }
}

// -- winding numbers of sides --------------------------------------------------------------------

/// A point with its nearest doubles, by which most signs can be told.
struct Place {
  exact::Point exact;
  Vec3 near;
  double error;  ///< per coordinate
};

Place place_of(const exact::Point& p) {
  const Vec3 near = exact::rounded(p);
  return {p, near, 2.3e-16 * near.cwiseAbs().maxCoeff() + 1e-300};
}

/// Side of p with respect to a → b in the plane of coordinates u, v; where it is on the line, as if
/// it were at (u + ε, v + ε²). 0 where a and b fall together.
int perturbed_side(const Vec3& a, const Vec3& b, const Place& p, int u, int v) {
  const double ax = a[u] - p.near[u], ay = a[v] - p.near[v], bx = b[u] - p.near[u],
               by = b[v] - p.near[v];
  const double l = ax * by, r = ay * bx;
  const double bound =
      2e-15 * (std::abs(l) + std::abs(r)) +
      2 * p.error * (std::abs(ax) + std::abs(ay) + std::abs(bx) + std::abs(by) + 2 * p.error);
  if (l - r > bound) return 1;
  if (l - r < -bound) return -1;
  const Number d = (Number(a[u]) - p.exact[u]) * (Number(b[v]) - p.exact[v]) -
                   (Number(a[v]) - p.exact[v]) * (Number(b[u]) - p.exact[u]);
  if (d != 0) return d > 0 ? 1 : -1;
  if (a[v] != b[v]) return a[v] > b[v] ? 1 : -1;
  if (a[u] != b[u]) return b[u] > a[u] ? 1 : -1;
  return 0;
}

/// Side of p with respect to the triangle's plane: 1 above.
int side_of_plane(const Corners& t, const Place& p) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], d = p.near - t[0];
  double sum = 0, permanent = 0, weight = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double m = u[i] * v[j], n = u[j] * v[i];
    sum += d[k] * (m - n);
    permanent += std::abs(d[k]) * (std::abs(m) + std::abs(n));
    weight += std::abs(m) + std::abs(n);
  }
  const double bound = 4e-15 * permanent + 2 * p.error * weight;
  if (sum > bound) return 1;
  if (sum < -bound) return -1;
  const Number h = exact::height(exact::plane_of(t), p.exact);
  return h > 0 ? 1 : h < 0 ? -1 : 0;
}

/// Winding numbers on both sides of a cell, and the first triangle of those that cover it.
struct Label {
  int outer = 0, inner = 0;
  std::uint32_t first = kNone;
  [[nodiscard]] bool bounds() const { return (outer >= 1) != (inner >= 1); }
};

class Arrangement {
 public:
  explicit Arrangement(const Mesh& input) {
    const Mesh welded = geom::weld(input);
    require_closed(welded);
    // Triangles without area go round no point off them.
    mesh_.vertices = welded.vertices;
    for (const Triangle& t : welded.triangles)
      if (!geom::is_degenerate(welded.vertices[t[0]], welded.vertices[t[1]], welded.vertices[t[2]]))
        mesh_.triangles.push_back(t);
    bvh_ = geom::Bvh(mesh_);
  }

  Boundary run() {
    find_meetings();
    Boundary out;
    keep_patches(out);
    keep_cells(out);
    return out;
  }

 private:
  static void require_closed(const Mesh& mesh) {
    std::size_t open = 0;
    geom::for_each_edge(geom::edge_uses(mesh), [&](std::span<const geom::EdgeUse> edge) {
      int balance = 0;
      for (const geom::EdgeUse& use : edge) balance += use.forward ? 1 : -1;
      open += balance != 0;
    });
    if (open > 0)
      throw Error(ErrorCode::InvalidInput,
                  "no closed chain (" + std::to_string(open) +
                      " edges run through more often one way than the other), so there is no "
                      "solid to measure; close the mesh, or measure surface to surface");
  }

  [[nodiscard]] Corners corners(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }

  /// Corners that two triangles share.
  [[nodiscard]] std::vector<std::uint32_t> shared(std::uint32_t s, std::uint32_t t) const {
    std::vector<std::uint32_t> out;
    for (const std::uint32_t v : mesh_.triangles[s])
      if (std::find(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), v) !=
          mesh_.triangles[t].end())
        out.push_back(v);
    return out;
  }

  /// Whether two triangles have more in common than a side or a corner of both: a segment, an area,
  /// or (harmlessly) a point where they share none.
  [[nodiscard]] bool meet_beyond_corners(std::uint32_t i, std::uint32_t j) const {
    const Corners s = corners(i), t = corners(j);
    const std::array<int, 3> t_to_s = sides(s, t);
    if (one_sided(t_to_s)) return false;
    if (all_zero(t_to_s)) return overlap_in_plane(s, t);
    const std::array<int, 3> s_to_t = sides(t, s);
    if (one_sided(s_to_t)) return false;
    const std::vector<std::uint32_t> common = shared(i, j);
    if (common.size() >= 2) return false;
    if (common.empty()) return CGAL::do_intersect(triangle(s), triangle(t));
    // Both meet the other's plane in a segment from the common corner to the side across.
    const auto across = [&](std::uint32_t k) {
      const Triangle& v = mesh_.triangles[k];
      const int at = v[0] == common[0] ? 0 : v[1] == common[0] ? 1 : 2;
      return Kernel::Segment_3(point(mesh_.vertices[v[(at + 1) % 3]]),
                               point(mesh_.vertices[v[(at + 2) % 3]]));
    };
    return CGAL::do_intersect(across(j), triangle(s)) || CGAL::do_intersect(across(i), triangle(t));
  }

  void find_meetings() {
    const auto n = static_cast<std::uint32_t>(mesh_.triangles.size());
    meets_.resize(n);
    parallel_for(std::uint32_t{0}, n, [&](std::uint32_t t) {
      const Box3 box = box_of(corners(t));
      bvh_.traverse(
          [&](const Box3& b) { return overlap(box, b); },
          [&](std::uint32_t other) {
            if (other > t && overlap(box, box_of(corners(other))) && meet_beyond_corners(t, other))
              meets_[t].push_back(other);
          });
      std::sort(meets_[t].begin(), meets_[t].end());
    });
    for (std::uint32_t t = 0; t < n; ++t)
      for (std::size_t i = 0; i < meets_[t].size() && meets_[t][i] > t; ++i)
        meets_[meets_[t][i]].push_back(t);
  }

  /// Triangles that meet others in common sides and corners only have one label on both sides of
  /// such a side.
  void keep_patches(Boundary& out) {
    const auto n = static_cast<std::uint32_t>(mesh_.triangles.size());
    std::vector<std::array<std::uint32_t, 3>> across(n, {kNone, kNone, kNone});
    geom::for_each_edge(geom::edge_uses(mesh_), [&](std::span<const geom::EdgeUse> edge) {
      if (edge.size() != 2 || edge[0].forward == edge[1].forward) return;
      const std::uint32_t s = edge[0].triangle, t = edge[1].triangle;
      if (!meets_[s].empty() || !meets_[t].empty()) return;
      across[s][edge[0].corner] = t;
      across[t][edge[1].corner] = s;
    });
    out.mesh.vertices = mesh_.vertices;
    std::vector<char> seen(n, 0);
    std::vector<std::uint32_t> stack, patch;
    for (std::uint32_t first = 0; first < n; ++first) {
      if (seen[first] != 0 || !meets_[first].empty()) continue;
      patch.clear();
      stack.assign(1, first);
      seen[first] = 1;
      while (!stack.empty()) {
        const std::uint32_t t = stack.back();
        stack.pop_back();
        patch.push_back(t);
        for (const std::uint32_t other : across[t]) {
          if (other == kNone || seen[other] != 0) continue;
          seen[other] = 1;
          stack.push_back(other);
        }
      }
      const Corners t = corners(first);
      const Label label =
          label_of(first, {exact::point(t[0]), exact::point(t[1]), exact::point(t[2])});
      if (!label.bounds()) continue;
      for (const std::uint32_t k : patch) add(out, k, mesh_.triangles[k], label, true);
    }
  }

  void keep_cells(Boundary& out) {
    struct Part {
      std::vector<Cell> cells;
      std::vector<Label> labels;
    };
    std::vector<std::uint32_t> crossed;
    for (std::uint32_t t = 0; t < meets_.size(); ++t)
      if (!meets_[t].empty()) crossed.push_back(t);
    std::vector<Part> parts(crossed.size());
    parallel_for(std::size_t{0}, crossed.size(), [&](std::size_t i) {
      parts[i].cells = cells_of(crossed[i]);
      for (const Cell& cell : parts[i].cells)
        parts[i].labels.push_back(label_of(crossed[i], cell.polygon));
    });
    bool cut_any = false;
    for (std::size_t i = 0; i < crossed.size(); ++i) {
      for (std::size_t k = 0; k < parts[i].cells.size(); ++k) {
        const Label& label = parts[i].labels[k];
        if (!label.bounds() || label.first != crossed[i]) continue;
        cut_any = cut_any || parts[i].cells.size() > 1;
        const Polygon& polygon = parts[i].cells[k].polygon;
        const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
        for (const exact::Point& p : polygon) out.mesh.vertices.push_back(exact::rounded(p));
        for (std::uint32_t j = 2; j < polygon.size(); ++j)
          add(out, crossed[i], {first, first + j - 1, first + j}, label,
              parts[i].cells.size() == 1);
      }
    }
    if (!cut_any) return;
    const Box3 box = geom::bounding_box(mesh_);
    out.error = exact::kRounding * box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  }

  /// Adds a part of triangle t, turned so that the solid is below it.
  void add(Boundary& out, std::uint32_t t, Triangle part, const Label& label, bool whole) const {
    Corners facet = corners(t);
    if (label.outer >= 1) {
      std::swap(part[1], part[2]);
      std::swap(facet[1], facet[2]);
    }
    out.mesh.triangles.push_back(part);
    out.facet.push_back(facet);
    out.whole.push_back(whole ? 1 : 0);
  }

  /// Cuts a triangle along all segments in which others meet it, and along the sides of those that
  /// lie on it: no other triangle enters the inside of a cell, or it covers the cell.
  [[nodiscard]] std::vector<Cell> cells_of(std::uint32_t t) const {
    const Corners own = corners(t);
    const Polygon whole{exact::point(own[0]), exact::point(own[1]), exact::point(own[2])};
    const exact::Point normal = exact::plane_of(own).normal;
    std::vector<Cell> cells{{whole, box_of(whole)}};
    for (const std::uint32_t other : meets_[t]) {
      const Corners c = corners(other);
      if (all_zero(sides(own, c))) {
        for (int k = 0; k < 3; ++k)
          cut(cells, normal, {exact::point(c[k]), exact::point(c[(k + 1) % 3])});
      } else if (const auto segment = common_segment(own, c)) {
        cut(cells, normal, *segment);
      }
    }
    return cells;
  }

  /// Label of a cell of triangle t, found at one of its inner points.
  [[nodiscard]] Label label_of(std::uint32_t t, const Polygon& cell) const {
    // Should another triangle touch that very point, another one will do.
    for (int attempt = 0; attempt < 64; ++attempt) {
      exact::Point sum{0, 0, 0};
      Number weights = 0;
      for (std::size_t i = 0; i < cell.size(); ++i) {
        const Number w(static_cast<double>(1 + attempt * (i + 1) * (i + 1)));
        for (int k = 0; k < 3; ++k) sum[k] += w * cell[i][k];
        weights += w;
      }
      for (Number& x : sum) x /= weights;
      if (const auto label = label_at(t, sum)) return *label;
    }
    throw Error(ErrorCode::Internal, "no inner point of a facet is free of other triangles");
  }

  /// Counts crossings of a ray from p, an inner point of a cell of t, along the axis that is
  /// nearest to t's normal. nullopt if a triangle across t's plane contains p.
  [[nodiscard]] std::optional<Label> label_at(std::uint32_t t, const exact::Point& p) const {
    const Corners own = corners(t);
    const exact::Plane plane = exact::plane_of(own);
    int axis = 0;
    exact::rounded(plane.normal).cwiseAbs().maxCoeff(&axis);
    for (int k = 0; plane.normal[axis] == 0; ++k) axis = k;  // underflow
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Place place = place_of(p);
    const Vec3 low = place.near - Vec3::Constant(place.error),
               high = place.near + Vec3::Constant(place.error);
    const auto above = [&](const Box3& box) {
      return high[u] >= box.min[u] && low[u] <= box.max[u] && high[v] >= box.min[v] &&
             low[v] <= box.max[v] && low[axis] <= box.max[axis];
    };
    int winding = 0, sheets = 0;
    bool touched = false;
    Label label;
    bvh_.traverse(above, [&](std::uint32_t other) {
      const Corners c = corners(other);
      if (touched || !above(box_of(c))) return;
      const int turn = perturbed_side(c[0], c[1], place, u, v);
      if (turn == 0 || perturbed_side(c[1], c[2], place, u, v) != turn ||
          perturbed_side(c[2], c[0], place, u, v) != turn)
        return;
      const int height = other == t ? 0 : side_of_plane(c, place);
      if (height == 0) {
        if (!all_zero(sides(own, c))) {
          touched = true;
          return;
        }
        const exact::Point n = exact::plane_of(c).normal;
        sheets += exact::dot(n, plane.normal) > 0 ? 1 : -1;
        label.first = std::min(label.first, other);
      } else if (height == -turn) {
        winding += turn;
      }
    });
    if (touched) return std::nullopt;
    // `winding` is that of the side where the ray goes; inside is one more per sheet.
    label.outer = plane.normal[axis] > 0 ? winding : winding - sheets;
    label.inner = label.outer + sheets;
    return label;
  }

  Mesh mesh_;  // welded, triangles with area
  geom::Bvh bvh_;
  std::vector<std::vector<std::uint32_t>> meets_;  // beyond common sides and corners
};

}  // namespace

Boundary solid_boundary(const Mesh& mesh) {
  Boundary boundary = Arrangement(mesh).run();
  if (boundary.mesh.empty())
    throw Error(ErrorCode::InvalidInput,
                "the solid is empty: no point has a winding number of 1 or more (are the triangles "
                "oriented inwards, or is it a sheet?); measure surface to surface");
  return boundary;
}

}  // namespace kaboum::distance
