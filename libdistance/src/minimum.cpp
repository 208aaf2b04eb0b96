// Smallest distance between two surfaces. The exact test whether two triangles meet is CGAL's
// (Kernel, predicates only).
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <kaboum/base/error.h>
#include <kaboum/distance/minimum.h>
#include <kaboum/geom/bvh.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kaboum::distance {
namespace {

using geom::Box3;
using geom::Bvh;
using geom::Vec3;
using Corners = std::array<Vec3, 3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// A exact_point and a triangle, twice over: docs/algorithms/distances.md, "Smallest distance".
constexpr double kRounding = 2 * geom::kDistanceRounding;

Kernel::Point_3 exact_point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// The side of a triangle without area that holds all of it: its corners lie on a line, of which
/// the order of coordinates is the order of points.
Kernel::Segment_3 longest_side(const Corners& t) {
  const auto before = [](const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  const auto [first, last] = std::minmax_element(t.begin(), t.end(), before);
  return {exact_point(*first), exact_point(*last)};
}

/// Whether the closed triangles have a exact_point in common; exact, whatever their shapes.
bool meet(const Corners& s, const Corners& t) {
  const bool flat_s = geom::is_degenerate(s[0], s[1], s[2]);
  const bool flat_t = geom::is_degenerate(t[0], t[1], t[2]);
  const auto triangle = [](const Corners& c) {
    return Kernel::Triangle_3(exact_point(c[0]), exact_point(c[1]), exact_point(c[2]));
  };
  if (!flat_s && !flat_t) return CGAL::do_intersect(triangle(s), triangle(t));
  const auto meets_segment = [&](const Corners& whole, const Kernel::Segment_3& segment) {
    if (segment.is_degenerate()) return triangle(whole).has_on(segment.source());
    return CGAL::do_intersect(triangle(whole), segment);
  };
  if (!flat_s) return meets_segment(s, longest_side(t));
  if (!flat_t) return meets_segment(t, longest_side(s));
  const Kernel::Segment_3 e = longest_side(s), f = longest_side(t);
  if (e.is_degenerate()) return f.is_degenerate() ? e.source() == f.source() : f.has_on(e.source());
  if (f.is_degenerate()) return e.has_on(f.source());
  return CGAL::do_intersect(e, f);
}

struct Pair {
  double lower = 0, upper = std::numeric_limits<double>::infinity();
  Vec3 on_s = Vec3::Zero(), on_t = Vec3::Zero();
};

/// Nearest points of two segments: weights along both (Lumelsky 1985, in Ericson's form).
std::pair<double, double> nearest_on_segments(const Vec3& p, const Vec3& d, const Vec3& q,
                                              const Vec3& e) {
  const double a = d.dot(d), b = d.dot(e), c = e.dot(e);
  const Vec3 r = p - q;
  const double f = d.dot(r), g = e.dot(r);
  const auto clamp = [](double x) { return std::clamp(x, 0.0, 1.0); };
  if (!(a > 0)) return {0, c > 0 ? clamp(g / c) : 0};
  if (!(c > 0)) return {clamp(-f / a), 0};
  const double denominator = a * c - b * b;
  double s = denominator > 0 ? clamp((b * g - c * f) / denominator) : 0;
  double t = (b * s + g) / c;
  if (t < 0 || t > 1) {
    t = clamp(t);
    s = clamp((b * t - f) / a);
  }
  return {s, t};
}

/// Weights of the exact_point of a triangle nearest to p; any weights ≥ 0 with sum ≤ 1 are sound.
std::array<double, 2> nearest_in_plane(const Vec3& p, const Corners& t) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const Vec3 n = u.cross(v);
  const double square = n.squaredNorm();
  if (!(square > 0)) return {-1, -1};
  return {n.dot(w.cross(v)) / square, n.dot(u.cross(w)) / square};
}

/// Bracket of the distance of two triangles, both given relative to a exact_point near them.
///
/// The distance is attained between a corner and a face or between two edges. Each candidate pair
/// of points gives an upper bound; the plane across it separates the triangles by what their
/// corners say: a lower bound, whatever the candidate.
Pair triangle_distance(const Corners& s, const Corners& t) {
  double magnitude = 0;
  for (const Corners* c : {&s, &t})
    for (const Vec3& p : *c) magnitude = std::max(magnitude, p.cwiseAbs().maxCoeff());
  const double slack = kRounding * magnitude;
  Pair best;
  const auto separate = [&](const Vec3& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return;
    const auto along = [&](const Vec3& x) { return direction.dot(x); };
    const double gap = std::min({along(t[0]), along(t[1]), along(t[2])}) -
                       std::max({along(s[0]), along(s[1]), along(s[2])});
    best.lower = std::max(best.lower, gap / length * (1 - kRounding) - slack);
  };
  const auto consider = [&](const Vec3& x, const Vec3& y) {
    const Vec3 direction = y - x;
    const double upper = direction.norm() * (1 + kRounding) + slack;
    separate(direction);
    if (upper >= best.upper) return;
    best.upper = upper;
    best.on_s = x;
    best.on_t = y;
  };
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = s[(i + 1) % 3] - s[i];
    for (int j = 0; j < 3; ++j) {
      const Vec3 e = t[(j + 1) % 3] - t[j];
      const auto [u, v] = nearest_on_segments(s[i], d, t[j], e);
      consider(s[i] + u * d, t[j] + v * e);
      separate(Vec3(d.cross(e)));
      separate(Vec3(e.cross(d)));
    }
  }
  for (int i = 0; i < 3; ++i) {
    const auto inside = [](const std::array<double, 2>& w) {
      return w[0] >= 0 && w[1] >= 0 && w[0] + w[1] <= 1;
    };
    if (const auto w = nearest_in_plane(s[i], t); inside(w))
      consider(s[i], t[0] + w[0] * (t[1] - t[0]) + w[1] * (t[2] - t[0]));
    if (const auto w = nearest_in_plane(t[i], s); inside(w))
      consider(s[0] + w[0] * (s[1] - s[0]) + w[1] * (s[2] - s[0]), t[i]);
  }
  for (const Corners* c : {&s, &t}) {
    const Vec3 n = ((*c)[1] - (*c)[0]).cross((*c)[2] - (*c)[0]);
    separate(n);
    separate(Vec3(-n));
  }
  return best;
}

/// Lower bound of the distance of two boxes.
double box_distance(const Box3& a, const Box3& b) {
  const Vec3 d = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0);
  return d.norm() * (1 - kRounding);
}

class DualTraversal {
 public:
  DualTraversal(const geom::Mesh& a, const geom::Mesh& b) : a_(a), b_(b), tree_a_(a), tree_b_(b) {
    result_.upper = std::numeric_limits<double>::infinity();
    result_.lower = std::numeric_limits<double>::infinity();
  }

  Minimum run() {
    visit(0, 0, box_distance(tree_a_.nodes()[0].box, tree_b_.nodes()[0].box));
    return result_;
  }

 private:
  static Corners corners(const geom::Mesh& m, std::uint32_t t) {
    const auto& [i, j, k] = m.triangles[t];
    return {m.vertices[i], m.vertices[j], m.vertices[k]};
  }

  // What is skipped is farther apart than a pair that was found, so it cannot lower the minimum.
  void visit(std::uint32_t i, std::uint32_t j, double distance) {
    if (distance > result_.upper || result_.upper == 0) return;
    const Bvh::Node &m = tree_a_.nodes()[i], &n = tree_b_.nodes()[j];
    if (m.leaf() && n.leaf()) {
      for (std::uint32_t s = 0; s < m.count; ++s)
        for (std::uint32_t t = 0; t < n.count; ++t)
          consider(tree_a_.order()[m.first + s], tree_b_.order()[n.first + t]);
      return;
    }
    const bool split_a = !m.leaf() && (n.leaf() || m.box.diagonal() >= n.box.diagonal());
    std::array<std::uint32_t, 2> child =
        split_a ? std::array{i + 1, m.first} : std::array{j + 1, n.first};
    std::array<double, 2> gap{};
    for (int k = 0; k < 2; ++k)
      gap[k] = split_a ? box_distance(tree_a_.nodes()[child[k]].box, n.box)
                       : box_distance(m.box, tree_b_.nodes()[child[k]].box);
    const int near = gap[1] < gap[0] ? 1 : 0;
    for (const int k : {near, 1 - near})
      split_a ? visit(child[k], j, gap[k]) : visit(i, child[k], gap[k]);
  }

  void consider(std::uint32_t s, std::uint32_t t) {
    if (result_.upper == 0) return;
    ++result_.pairs;
    const Corners p = corners(a_, s), q = corners(b_, t);
    Box3 box_p, box_q;
    for (int k = 0; k < 3; ++k) {
      box_p.extend(p[k]);
      box_q.extend(q[k]);
    }
    if (box_distance(box_p, box_q) > result_.upper) return;
    const Vec3& origin = p[0];
    Corners x, y;
    for (int k = 0; k < 3; ++k) {
      x[k] = p[k] - origin;
      y[k] = q[k] - origin;
    }
    const Pair pair = triangle_distance(x, y);
    if (pair.lower <= 0 && meet(p, q)) {
      result_.lower = result_.upper = 0;
      result_.on_a = pair.on_s + origin;
      result_.on_b = pair.on_t + origin;
      return;
    }
    result_.lower = std::min(result_.lower, std::max(0.0, pair.lower));
    if (pair.upper < result_.upper) {
      result_.upper = pair.upper;
      result_.on_a = pair.on_s + origin;
      result_.on_b = pair.on_t + origin;
    }
  }

  const geom::Mesh &a_, &b_;
  Bvh tree_a_, tree_b_;
  Minimum result_;
};

}  // namespace

Minimum minimum_distance(const geom::Mesh& a, const geom::Mesh& b) {
  if (a.empty() || b.empty())
    throw Error(ErrorCode::InvalidInput, "distance of a mesh without triangles");
  return DualTraversal(a, b).run();
}

}  // namespace kaboum::distance
