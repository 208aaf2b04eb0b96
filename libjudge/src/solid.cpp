// Exact meshes against each other: trees of boxes in the meshes' own frames, triangles by CGAL.

#include <kaboum/judge/solid.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangle_3.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace kaboum::judge {
namespace {

using geom::Transform;
using geom::Vec3;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

/// Boxes are larger by this share of the meshes' sizes than needed: they only leave out.
constexpr double kSlack = 1e-9;

Point point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

bool is_flat(const std::array<Vec3, 3>& t) {
  return CGAL::collinear(point(t[0]), point(t[1]), point(t[2]));
}

bool triangles_meet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  for (int k = 0; k < 3; ++k) {
    const auto [a_low, a_high] = std::minmax({a[0][k], a[1][k], a[2][k]});
    const auto [b_low, b_high] = std::minmax({b[0][k], b[1][k], b[2][k]});
    if (a_high < b_low || b_high < a_low) return false;
  }
  // Where placing made one flat, its neighbours have its edges.
  if (is_flat(a) || is_flat(b)) return false;
  return CGAL::do_intersect(Kernel::Triangle_3(point(a[0]), point(a[1]), point(a[2])),
                            Kernel::Triangle_3(point(b[0]), point(b[1]), point(b[2])));
}

double square_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(d) / length, 0.0, 1.0) : 0;
  return (p - a - t * d).squaredNorm();
}

double square_to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  bool above = n.squaredNorm() > 0;
  for (int i = 0; i < 3 && above; ++i) above = (t[(i + 1) % 3] - t[i]).cross(p - t[i]).dot(n) >= 0;
  if (above) {
    const double height = n.dot(p - t[0]);
    return height * height / n.squaredNorm();
  }
  return std::min({square_to_segment(p, t[0], t[1]), square_to_segment(p, t[1], t[2]),
                   square_to_segment(p, t[2], t[0])});
}

/// Where the nearest points are inside of both segments; elsewhere corners are nearest.
double square_between_edges(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w),
               vw = v.dot(w), det = uu * vv - uv * uv;
  double best = std::min({square_to_segment(a, c, d), square_to_segment(b, c, d),
                          square_to_segment(c, a, b), square_to_segment(d, a, b)});
  if (!(det > 0)) return best;
  const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
    best = std::min(best, (w + s * u - t * v).squaredNorm());
  return best;
}

double square_between(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    best = std::min({best, square_to_triangle(a[i], b), square_to_triangle(b[i], a)});
    for (int j = 0; j < 3; ++j)
      best = std::min(best, square_between_edges(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return best;
}

/// Whether boxes round triangles, or the plane of one, show that they are farther apart.
bool are_beyond(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double reach) {
  const auto low = [](const std::array<Vec3, 3>& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]); };
  const auto high = [](const std::array<Vec3, 3>& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]); };
  const Vec3 gap = (low(a) - high(b)).cwiseMax(low(b) - high(a)).cwiseMax(0.0);
  if (gap.squaredNorm() > reach * reach) return true;
  for (const auto& [t, other] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const Vec3 along = (*t)[1] - (*t)[0], across = (*t)[2] - (*t)[0], n = along.cross(across);
    // The normal of a sliver is not known well enough.
    if (n.norm() < 1e-6 * along.norm() * across.norm()) continue;
    const double most = reach * n.norm() * (1 + 1e-9);
    std::array<double, 3> height{};
    for (std::size_t i = 0; i < 3; ++i) height[i] = n.dot((*other)[i] - (*t)[0]);
    if (std::ranges::all_of(height, [&](double h) { return h > most; }) ||
        std::ranges::all_of(height, [&](double h) { return h < -most; }))
      return true;
  }
  return false;
}

std::array<Vec3, 3> placed(const Transform& at, const std::array<Vec3, 3>& t) {
  return {at * t[0], at * t[1], at * t[2]};
}

}  // namespace

/// Two trees, the second one seen from the first.
struct Solid::Pair {
  const Solid &a, &b;
  const Transform &at_a, &at_b;
  Eigen::Matrix3d turn, extent;  ///< from b to a, and its absolute values
  Vec3 shift;
  double slack;

  Pair(const Solid& first, const Transform& at_first, const Solid& second,
       const Transform& at_second)
      : a(first),
        b(second),
        at_a(at_first),
        at_b(at_second),
        turn(at_a.linear.transpose() * at_b.linear),
        extent(turn.cwiseAbs()),
        shift(at_a.linear.transpose() * (at_b.translation - at_a.translation)),
        slack(kSlack * (a.size_ + b.size_ + shift.norm())) {}

  /// Not above the distance of the boxes.
  [[nodiscard]] double apart(const Node& x, const Node& y) const {
    const Vec3 between = turn * y.center + shift - x.center;
    const double in_a = (between.cwiseAbs() - x.half - extent * y.half).maxCoeff();
    const double in_b =
        ((turn.transpose() * between).cwiseAbs() - y.half - extent.transpose() * x.half).maxCoeff();
    return std::max(in_a, in_b) - slack;
  }

  /// Calls leaf(triangle of a, triangle of b) for those whose boxes are not farther apart than
  /// `reach`, the nearer boxes first, until it is true.
  template <typename Leaf>
  bool visit(std::uint32_t i, std::uint32_t j, double reach, const Leaf& leaf) const {
    const Node &x = a.nodes_[i], &y = b.nodes_[j];
    if (x.count > 0 && y.count > 0) {
      for (std::uint32_t s = x.first; s < x.first + x.count; ++s)
        for (std::uint32_t t = y.first; t < y.first + y.count; ++t)
          if (leaf(s, t)) return true;
      return false;
    }
    const bool split_a = y.count > 0 || (x.count == 0 && x.half.sum() > y.half.sum());
    std::array<std::array<std::uint32_t, 2>, 2> next{{{i, j}, {i, j}}};
    next[0][split_a ? 0 : 1] = split_a ? x.left : y.left;
    next[1][split_a ? 0 : 1] = split_a ? x.right : y.right;
    std::array<double, 2> gap{};
    for (int k = 0; k < 2; ++k) gap[k] = apart(a.nodes_[next[k][0]], b.nodes_[next[k][1]]);
    if (gap[1] < gap[0]) {
      std::swap(gap[0], gap[1]);
      std::swap(next[0], next[1]);
    }
    return (gap[0] <= reach && visit(next[0][0], next[0][1], reach, leaf)) ||
           (gap[1] <= reach && visit(next[1][0], next[1][1], reach, leaf));
  }
};

Solid::Solid(const geom::Mesh& mesh) {
  std::map<std::tuple<double, double, double>, std::uint32_t> number;
  std::vector<std::uint32_t> of(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3& p = mesh.vertices[i];
    const auto [found, is_new] =
        number.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, points_.size());
    if (is_new) points_.push_back(p);
    of[i] = found->second;
    size_ = std::max(size_, p.norm());
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // chain of directed edges
  std::vector<std::uint32_t> part(points_.size());
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](std::uint32_t i) {
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
  };
  for (const geom::Triangle& t : mesh.triangles) {
    const geom::Triangle own{of[t[0]], of[t[1]], of[t[2]]};
    triangles_.push_back(own);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t p = own[i], q = own[(i + 1) % 3];
      if (p != q) edges[std::minmax(p, q)] += p < q ? 1 : -1;
      part[root(p)] = root(q);
    }
  }
  closed_ = std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
  std::erase_if(triangles_, [&](const geom::Triangle& t) {
    return is_flat({points_[t[0]], points_[t[1]], points_[t[2]]});
  });
  std::vector<char> seen(points_.size(), 0);
  for (const geom::Triangle& t : triangles_) {
    if (seen[root(t[0])] == 0) parts_.push_back(t[0]);
    seen[root(t[0])] = 1;
  }
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

Solid::Corners Solid::corners(std::uint32_t triangle) const {
  const geom::Triangle& t = triangles_[triangle];
  return {points_[t[0]], points_[t[1]], points_[t[2]]};
}

std::uint32_t Solid::build(std::uint32_t first, std::uint32_t count) {
  geom::Box3 box;
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const Vec3& p : corners(i)) box.extend(p);
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({0.5 * (box.min + box.max), 0.5 * (box.max - box.min), 0, 0, first, count});
  if (count <= 2) return at;
  int axis = 0;
  nodes_[at].half.maxCoeff(&axis);
  const std::uint32_t middle = count / 2;
  const auto along = [&](const geom::Triangle& t) {
    return points_[t[0]][axis] + points_[t[1]][axis] + points_[t[2]][axis];
  };
  std::nth_element(
      triangles_.begin() + first, triangles_.begin() + first + middle,
      triangles_.begin() + first + count,
      [&](const geom::Triangle& s, const geom::Triangle& t) { return along(s) < along(t); });
  const std::uint32_t left = build(first, middle), right = build(first + middle, count - middle);
  nodes_[at].left = left;
  nodes_[at].right = right;
  nodes_[at].count = 0;
  return at;
}

bool Solid::count_crossings(std::uint32_t node, const Vec3& from, const Vec3& to,
                            int& winding) const {
  const Node& n = nodes_[node];
  const Vec3 low = n.center - n.half - Vec3::Constant(kSlack * size_),
             high = n.center + n.half + Vec3::Constant(kSlack * size_);
  for (int k = 0; k < 3; ++k)
    if (std::max(from[k], to[k]) < low[k] || std::min(from[k], to[k]) > high[k]) return true;
  // The segment runs along x nearly; boxes off its line are left out by y and z above.
  if (n.count == 0)
    return count_crossings(n.left, from, to, winding) &&
           count_crossings(n.right, from, to, winding);
  const Point p = point(from), q = point(to);
  for (std::uint32_t t = n.first; t < n.first + n.count; ++t) {
    const Corners c = corners(t);
    const Point a = point(c[0]), b = point(c[1]), d = point(c[2]);
    const CGAL::Orientation at_p = CGAL::orientation(a, b, d, p),
                            at_q = CGAL::orientation(a, b, d, q);
    if (at_p != CGAL::ZERO && at_p == at_q) continue;
    const CGAL::Orientation u = CGAL::orientation(p, q, a, b), v = CGAL::orientation(p, q, b, d),
                            w = CGAL::orientation(p, q, d, a);
    const bool positive = u == CGAL::POSITIVE || v == CGAL::POSITIVE || w == CGAL::POSITIVE;
    const bool negative = u == CGAL::NEGATIVE || v == CGAL::NEGATIVE || w == CGAL::NEGATIVE;
    if (positive && negative) continue;
    if (at_p == CGAL::ZERO || at_q == CGAL::ZERO || u == CGAL::ZERO || v == CGAL::ZERO ||
        w == CGAL::ZERO)
      return false;
    // Orientation is positive above the triangle (its normal's side): leaving counts +1.
    winding += at_q == CGAL::POSITIVE ? 1 : -1;
  }
  return true;
}

bool Solid::holds(const Vec3& p) const {
  const Node& all = nodes_.front();
  if (((p - all.center).cwiseAbs().array() > all.half.array()).any()) return false;
  for (int attempt = 1; attempt < 20; ++attempt) {
    const Vec3 to = p + 3 * size_ * Vec3(1, 0.013 * attempt, 0.0071 * attempt * attempt);
    int winding = 0;
    if (count_crossings(0, p, to, winding)) return winding > 0;
  }
  return true;  // on the surface, as it seems
}

bool Solid::meets(const Transform& at, const Solid& other, const Transform& other_at) const {
  if (triangles_.empty() || other.triangles_.empty()) return false;
  const Pair pair(*this, at, other, other_at);
  if (pair.apart(nodes_[0], other.nodes_[0]) > 0) return false;
  if (pair.visit(0, 0, 0, [&](std::uint32_t i, std::uint32_t j) {
        return triangles_meet(placed(at, corners(i)), placed(other_at, other.corners(j)));
      }))
    return true;
  const auto inside = [](const Solid& inner, const Transform& at_inner, const Solid& outer,
                         const Transform& at_outer) {
    return outer.closed_ &&
           std::any_of(inner.parts_.begin(), inner.parts_.end(), [&](std::uint32_t i) {
             return outer.holds(at_outer.linear.transpose() *
                                (at_inner * inner.points_[i] - at_outer.translation));
           });
  };
  return inside(*this, at, other, other_at) || inside(other, other_at, *this, at);
}

bool Solid::is_within(const Transform& at, const Solid& other, const Transform& other_at,
                      double reach) const {
  if (triangles_.empty() || other.triangles_.empty()) return false;
  const Pair pair(*this, at, other, other_at);
  return pair.apart(nodes_[0], other.nodes_[0]) <= reach &&
         pair.visit(0, 0, reach, [&](std::uint32_t i, std::uint32_t j) {
           const Corners first = placed(at, corners(i));
           const Corners second = placed(other_at, other.corners(j));
           return !are_beyond(first, second, reach) &&
                  square_between(first, second) <= reach * reach;
         });
}

double Solid::square_distance(std::uint32_t node, const Vec3& p, double most) const {
  const Node& n = nodes_[node];
  if (n.count > 0) {
    for (std::uint32_t t = n.first; t < n.first + n.count; ++t)
      most = std::min(most, square_to_triangle(p, corners(t)));
    return most;
  }
  const auto to_box = [&](std::uint32_t i) {
    return ((p - nodes_[i].center).cwiseAbs() - nodes_[i].half).cwiseMax(0.0).squaredNorm();
  };
  std::array<std::uint32_t, 2> next{n.left, n.right};
  if (to_box(next[1]) < to_box(next[0])) std::swap(next[0], next[1]);
  for (const std::uint32_t i : next)
    if (to_box(i) < most) most = square_distance(i, p, most);
  return most;
}

double Solid::deepest_in(const Solid& other, const Eigen::Matrix3d& turn, const Vec3& shift,
                         double step, double best) const {
  if (!other.closed_) return best;
  const Node& all = other.nodes_.front();
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    Corners c = corners(t);
    for (Vec3& p : c) p = turn * p + shift;
    const double longest =
        std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    const double parts = std::ceil(longest / step);
    for (double i = 0; i <= parts; ++i)
      for (double j = 0; i + j <= parts; ++j) {
        const Vec3 p = c[0] + i / parts * (c[1] - c[0]) + j / parts * (c[2] - c[0]);
        if (((p - all.center).cwiseAbs() - all.half).maxCoeff() > -best) continue;
        const double square = other.square_distance(0, p, std::numeric_limits<double>::infinity());
        if (square > best * best && other.holds(p)) best = std::sqrt(square);
      }
  }
  return best;
}

double Solid::depth(const Transform& at, const Solid& other, const Transform& other_at,
                    double step) const {
  if (triangles_.empty() || other.triangles_.empty()) return 0;
  const Eigen::Matrix3d turn = other_at.linear.transpose() * at.linear;
  const Vec3 shift = other_at.linear.transpose() * (at.translation - other_at.translation);
  const double best = deepest_in(other, turn, shift, step, 0);
  return other.deepest_in(*this, turn.transpose(), -(turn.transpose() * shift), step, best);
}

}  // namespace kaboum::judge
