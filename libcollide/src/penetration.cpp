// Penetration depths: a polytope inside the difference of two bodies grows at the facet nearest to
// the origin (G. van den Bergen, Proximity queries and penetration depth computation on 3D game
// objects, 2001); every bound is checked with its error.

#include <kaboum/collide/penetration.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "lengths.h"

namespace kaboum::collide {
namespace {

using detail::kSumUp;
using detail::kUnit;
using detail::kUp;
using geom::Vec3;

constexpr int kMostSteps = 128;
/// Of the upper end: brackets as narrow end the search.
constexpr double kNarrow = 1e-10;
/// Lengths of directions that are safe to square.
constexpr double kLeastLength = 1e-140, kMostLength = 1e140;

/// The differences of two bodies' points: a convex set that holds the origin where they meet. The
/// depth is the distance of the origin from its boundary.
class Difference {
 public:
  Difference(const Posed& a, const Posed& b)
      : a_(a), b_(b), magnitude_(a.magnitude() + b.magnitude()) {}

  /// How far it reaches along d at most; takes in the point found. @pre d ≠ 0
  double reach(const Vec3& d) {
    const Polytope::Support p = a_.support(d), q = b_.support(-d);
    if (seen_.insert({p.index, q.index}).second)
      points_.emplace_back(a_.point(p.index) - b_.point(q.index));
    const double sum = p.value + q.value + kUnit * d.cwiseAbs().dot(magnitude_);
    const double length = d.norm();
    return sum > 0 ? sum * kUp / length * kUp : sum / (length * kUp);
  }

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  /// How far a rounded point may be from its exact one. [length]
  [[nodiscard]] double error() const { return kUnit * magnitude_.lpNorm<1>() * kUp; }
  [[nodiscard]] Vec3 between() const { return a_.center() - b_.center(); }

 private:
  const Posed &a_, &b_;
  Vec3 magnitude_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen_;
  std::vector<Vec3> points_;
};

bool is_direction(const Vec3& d) {
  const double length = d.norm();
  return length > kLeastLength && length < kMostLength;
}

/// No point of the triangle is nearer to the origin: the least of its corners along d.
double least_along(const Vec3& d, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double least = std::min({d.dot(a), d.dot(b), d.dot(c)});
  const double size = std::max({a.lpNorm<1>(), b.lpNorm<1>(), c.lpNorm<1>()});
  return (least - 0x1p-50 * d.cwiseAbs().maxCoeff() * size) / d.norm() / kUp;
}

/// Keeps the best of what is known.
class Bracket {
 public:
  void look(Difference& difference, const Vec3& d) {
    if (!is_direction(d)) return;
    const double reach = difference.reach(d);
    if (reach >= out_.upper) return;
    out_.upper = reach;
    out_.direction = d.normalized();
  }
  void raise(double lower) { out_.lower = std::max(out_.lower, lower); }
  [[nodiscard]] const Penetration& value() const { return out_; }

 private:
  Penetration out_{.lower = 0, .upper = std::numeric_limits<double>::infinity()};
};

/// The facet of the hull that is nearest to the origin, and by how much at least.
struct Nearest {
  Vec3 normal = Vec3::Zero();  ///< outwards, not normalised
  double lower = 0;            ///< ≤ 0: the origin may be outside
};

Nearest nearest_facet(const geom::HullBuilder& hull, const std::vector<Vec3>& points) {
  Nearest out{.lower = std::numeric_limits<double>::infinity()};
  for (const auto& [i, j, k] : hull.triangles()) {
    const Vec3 &a = points[i], &b = points[j], &c = points[k];
    const Vec3 normal = (b - a).cross(c - a);
    const bool inside = geom::orient3d(a, b, c, Vec3::Zero()) == geom::Sign::Negative;
    const double lower = is_direction(normal) ? least_along(normal, a, b, c) : 0;
    const double counted = inside ? lower : std::min(lower, 0.0);
    if (counted >= out.lower && out.normal != Vec3::Zero()) continue;
    out.lower = std::min(out.lower, counted);
    if (is_direction(normal)) out.normal = normal;
  }
  return out;
}

}  // namespace

Penetration penetration_between(const Posed& a, const Posed& b) {
  Difference difference(a, b);
  Bracket bracket;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) bracket.look(difference, sign * Vec3::Unit(k));
  bracket.look(difference, difference.between());
  bracket.look(difference, -difference.between());
  geom::HullBuilder hull;
  for (int step = 0; step < kMostSteps && bracket.value().upper > 0; ++step) {
    const std::size_t known = difference.points().size();
    if (!hull.build(difference.points())) {
      // All in one plane so far: what is beside it.
      Vec3 normal = Vec3::Zero();
      const std::vector<Vec3> points = difference.points();
      for (std::size_t i = 1; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j) {
          const Vec3 n = (points[i] - points[0]).cross(points[j] - points[0]);
          if (n.squaredNorm() > normal.squaredNorm()) normal = n;
        }
      bracket.look(difference, normal);
      bracket.look(difference, -normal);
    } else {
      const Nearest nearest = nearest_facet(hull, difference.points());
      bracket.raise(nearest.lower - difference.error());
      bracket.look(difference, nearest.normal);
    }
    const Penetration& now = bracket.value();
    if (difference.points().size() == known || now.upper - now.lower <= kNarrow * now.upper) break;
  }
  Penetration out = bracket.value();
  out.upper = std::max(out.upper, 0.0);
  out.lower = std::clamp(out.lower, 0.0, out.upper);
  return out;
}

std::optional<SetPenetration> penetration(const PosedSet& a, const PosedSet& b) {
  std::optional<SetPenetration> out;
  std::vector<Vec3> directions;
  const double errors = (a.error() + b.error()) * kSumUp;
  const std::vector<geom::Box3> boxes_a = a.boxes(), boxes_b = b.boxes();
  const auto meet = [](const geom::Box3& x, const geom::Box3& y) {
    return (x.min.array() <= y.max.array()).all() && (y.min.array() <= x.max.array()).all();
  };
  // How far one of two boxes that meet has to move, along an axis, until they are apart.
  const auto depth_of = [](const geom::Box3& x, const geom::Box3& y) {
    return (x.max - y.min).cwiseMin(y.max - x.min).minCoeff();
  };
  constexpr std::size_t kVeryMany = 1 << 16;
  const bool very_many = a.set().size() * b.set().size() > kVeryMany;
  for (std::size_t i = 0; i < a.set().size(); ++i) {
    for (std::size_t j = 0; j < b.set().size(); ++j) {
      if (!meet(boxes_a[i], boxes_b[j])) continue;
      // No pair is deeper than its boxes: of very many pairs, only those are looked at that may be
      // deeper than the deepest so far.
      if (very_many && out && depth_of(boxes_a[i], boxes_b[j]) <= out->depth.lower) continue;
      const Posed body_a = a.body(i), body_b = b.body(j);
      const double above = (a.radius_above(i) + b.radius_above(j)) * kSumUp,
                   below = (a.radius_below(i) + b.radius_below(j)) / kSumUp;
      if (!are_within(body_a, body_b, (above + errors) * kSumUp)) continue;
      Penetration depth = penetration_between(body_a, body_b);
      double lower = depth.lower + below;
      if (depth.upper == 0 || depth.lower == 0) {
        const Gap gap = gap_between(body_a, body_b);
        if (gap.upper > 0) {
          lower = below - gap.upper;
          depth.direction = gap.on_b - gap.on_a;
        }
      }
      lower = std::max((lower - errors) / kSumUp, 0.0);
      if (is_direction(depth.direction)) directions.push_back(depth.direction);
      if (!out || lower > out->depth.lower) out = {{.lower = lower}, {i, j}};
    }
  }
  if (!out) return out;
  out->depth.upper = std::numeric_limits<double>::infinity();
  // Each direction is looked along by all bodies: of sets of very many, few are tried.
  constexpr std::size_t kMostWork = 20'000'000;
  const std::size_t fewest = 16,
                    few = std::max(fewest, kMostWork / (a.set().size() + b.set().size()));
  if (directions.size() > few) {
    std::vector<Vec3> some;
    for (std::size_t i = 0; i < few; ++i) some.push_back(directions[i * directions.size() / few]);
    directions = std::move(some);
  }
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) directions.emplace_back(sign * Vec3::Unit(k));
  for (const Vec3& d : directions) {
    const auto reach = [&](const PosedSet& set, const Vec3& along) {
      double most = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < set.set().size(); ++i) {
        const Posed body = set.body(i);
        const double value = body.support(along).value +
                             kUnit * along.cwiseAbs().dot(body.magnitude()) +
                             set.radius_above(i) * along.norm() * kUp;
        most = std::max(most, value);
      }
      return most;
    };
    const double overlap = reach(a, d) + reach(b, -d);
    const double length = d.norm();
    const double upper = (overlap > 0 ? overlap * kUp / length * kUp : 0.0) + errors;
    if (upper * kSumUp >= out->depth.upper) continue;
    out->depth.upper = upper * kSumUp;
    out->depth.direction = d.normalized();
  }
  out->depth.lower = std::min(out->depth.lower, out->depth.upper);
  return out;
}

}  // namespace kaboum::collide
