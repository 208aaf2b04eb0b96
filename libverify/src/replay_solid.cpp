// The original's solid as the checker of logs sees it: winding numbers and separated tetrahedra,
// exactly. docs/algorithms/bounding-mesh.md.
#include "replay_solid.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <numeric>

namespace kaboum::verify {

namespace {
using ExactKernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
constexpr std::size_t kLeaf = 8;
}  // namespace

ReplaySolid::ReplaySolid(std::vector<Point> points, std::vector<Corners> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (triangles_.empty()) return;
  std::size_t leaves = 1;
  while (leaves * kLeaf < triangles_.size()) leaves *= 2;
  boxes_.resize(2 * leaves - 1);
  build(0, 0, order_.size());
  all_ = boxes_[0];
}

ReplaySolid::Box ReplaySolid::box_of(std::uint32_t triangle) const {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const auto& c = triangles_[triangle];
    const std::array<double, 3> x{points_[c[0]][k], points_[c[1]][k], points_[c[2]][k]};
    box.lo[k] = *std::min_element(x.begin(), x.end());
    box.hi[k] = *std::max_element(x.begin(), x.end());
  }
  return box;
}

void ReplaySolid::build(std::size_t node, std::size_t begin, std::size_t end) {
  if (begin >= end) {
    boxes_[node].lo.fill(1);
    boxes_[node].hi.fill(-1);
    return;
  }
  Box box = box_of(order_[begin]);
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Box b = box_of(order_[i]);
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = std::min(box.lo[k], b.lo[k]);
      box.hi[k] = std::max(box.hi[k], b.hi[k]);
    }
  }
  boxes_[node] = box;
  if (2 * node + 2 >= boxes_.size()) return;
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (box.hi[k] - box.lo[k] > box.hi[axis] - box.lo[axis]) axis = k;
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                   order_.begin() + static_cast<std::ptrdiff_t>(middle),
                   order_.begin() + static_cast<std::ptrdiff_t>(end),
                   [&](std::uint32_t s, std::uint32_t t) {
                     const Box a = box_of(s), b = box_of(t);
                     const double x = a.lo[axis] + a.hi[axis], y = b.lo[axis] + b.hi[axis];
                     return x < y || (x == y && s < t);
                   });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

/// Calls visit(triangle) for all triangles whose boxes meet the box, until it returns false.
/// @return whether it never did.
template <class Visit>
bool ReplaySolid::visit(const Box& box, Visit&& visit) const {
  if (boxes_.empty()) return true;
  const auto meets = [&](const Box& b) {
    for (int k = 0; k < 3; ++k)
      if (b.lo[k] > box.hi[k] || b.hi[k] < box.lo[k] || b.lo[k] > b.hi[k]) return false;
    return true;
  };
  struct Range {
    std::size_t node, begin, end;
  };
  std::vector<Range> stack{{0, 0, order_.size()}};
  while (!stack.empty()) {
    const Range r = stack.back();
    stack.pop_back();
    if (!meets(boxes_[r.node])) continue;
    if (2 * r.node + 2 < boxes_.size()) {
      const std::size_t middle = r.begin + (r.end - r.begin) / 2;
      stack.push_back({2 * r.node + 2, middle, r.end});
      stack.push_back({2 * r.node + 1, r.begin, middle});
      continue;
    }
    for (std::size_t i = r.begin; i < r.end; ++i)
      if (meets(box_of(order_[i])) && !visit(order_[i])) return false;
  }
  return true;
}

int ReplaySolid::side(const Point& a, const Point& b, const Point& c, const Point& d) {
  ++predicates_;
  return static_cast<int>(CGAL::orientation(a, b, c, d));
}

/// Some plane through three of the seven corners has the tetrahedron on one closed side and the
/// triangle on the other. All thirty-five are tried.
bool ReplaySolid::separated(const std::array<Point, 4>& tetrahedron,
                            const std::array<Point, 3>& triangle) {
  std::array<const Point*, 7> corner;
  for (int i = 0; i < 4; ++i) corner[i] = &tetrahedron[i];
  for (int i = 0; i < 3; ++i) corner[4 + i] = &triangle[i];
  for (int i = 0; i < 7; ++i) {
    for (int j = i + 1; j < 7; ++j) {
      for (int k = j + 1; k < 7; ++k) {
        bool plus[2] = {false, false}, minus[2] = {false, false};
        bool possible = true;
        for (int l = 0; l < 7 && possible; ++l) {
          if (l == i || l == j || l == k) continue;
          const int s = side(*corner[i], *corner[j], *corner[k], *corner[l]);
          plus[l / 4] = plus[l / 4] || s > 0;
          minus[l / 4] = minus[l / 4] || s < 0;
          possible = (!plus[0] && !minus[1]) || (!minus[0] && !plus[1]);
        }
        if (possible && (plus[0] || minus[0])) return true;
      }
    }
  }
  return false;
}

bool ReplaySolid::contains(const std::array<Point, 4>& tetrahedron, bool inside) {
  if (side(tetrahedron[0], tetrahedron[1], tetrahedron[2], tetrahedron[3]) == 0) return false;
  Box box;
  std::array<double, 3> middle{};
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = box.hi[k] = tetrahedron[0][k];
    for (const Point& p : tetrahedron) {
      box.lo[k] = std::min(box.lo[k], p[k]);
      box.hi[k] = std::max(box.hi[k], p[k]);
      middle[k] += 0.25 * p[k];
    }
  }
  const bool clear = visit(box, [&](std::uint32_t t) {
    const Corners& c = triangles_[t];
    return separated(tetrahedron, {points_[c[0]], points_[c[1]], points_[c[2]]});
  });
  if (!clear) return false;
  // A point of the interior speaks for all of it. Rounded, it may miss a thin one; then exactly.
  const Point p(middle[0], middle[1], middle[2]);
  bool hit = true;
  for (int k = 0; k < 4 && hit; ++k) {
    const Point &a = tetrahedron[(k + 1) % 4], &b = tetrahedron[(k + 2) % 4],
                &c = tetrahedron[(k + 3) % 4];
    hit = side(a, b, c, p) == side(a, b, c, tetrahedron[k]);
  }
  int w = 0;
  if (!hit) {
    std::array<ExactKernel::FT, 3> sum{0, 0, 0};
    for (const Point& corner : tetrahedron)
      for (int k = 0; k < 3; ++k) sum[k] += corner[k];
    if (!winding(ExactKernel::Point_3(sum[0] / 4, sum[1] / 4, sum[2] / 4), box, w)) return false;
  } else if (!winding(p, box, w)) {
    return false;
  }
  return inside ? w >= 1 : w <= 0;
}

/// Signed crossings of a segment from p, which lies in `box`, to a point outside; another one when
/// it meets an edge.
template <class PointType>
bool ReplaySolid::winding(const PointType& p, const Box& box, int& w) {
  const double height = all_.hi[2] - all_.lo[2] + 1;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const double size = 1e-3 * (1 + attempt) * (all_.hi[0] - all_.lo[0] + all_.hi[1] - all_.lo[1]);
    const std::array<double, 3> q{box.hi[0] + size * (0.37 + 0.11 * attempt),
                                  box.lo[1] - size * (0.29 + 0.07 * attempt),
                                  std::max(box.hi[2], all_.hi[2]) + height};
    Box swept = box;
    for (int k = 0; k < 3; ++k) {
      swept.lo[k] = std::min(box.lo[k], q[k]);
      swept.hi[k] = std::max(box.hi[k], q[k]);
    }
    w = 0;
    if (crossings(p, PointType(q[0], q[1], q[2]), swept, w)) return true;
  }
  return false;
}

template <class PointType>
bool ReplaySolid::crossings(const PointType& p, const PointType& q, const Box& swept, int& w) {
  const auto sign = [&](const PointType& a, const PointType& b, const PointType& c,
                        const PointType& d) {
    ++predicates_;
    return static_cast<int>(CGAL::orientation(a, b, c, d));
  };
  return visit(swept, [&](std::uint32_t t) {
    const auto corner = [&](int k) {
      const Point& x = points_[triangles_[t][k]];
      return PointType(x.x(), x.y(), x.z());
    };
    const PointType a = corner(0), b = corner(1), c = corner(2);
    const int sp = sign(a, b, c, p), sq = sign(a, b, c, q);
    // Neither end lies on the surface, so an end on the plane is no crossing; a segment in the
    // plane decides nothing, unless the triangle has no area.
    if (sp == 0 && sq == 0) return CGAL::collinear(a, b, c);
    if (sp * sq >= 0) return true;
    const int u = sign(p, q, a, b), v = sign(p, q, b, c), x = sign(p, q, c, a);
    if (std::min({u, v, x}) < 0 && std::max({u, v, x}) > 0) return true;
    if (u == 0 || v == 0 || x == 0) return false;
    w -= sp;  // leaving through the outer side counts +1
    return true;
  });
}

}  // namespace kaboum::verify
