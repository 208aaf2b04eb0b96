// Distances of convex polytopes in rounded arithmetic, every answer of which is checked with a
// bound of its error (docs/algorithms/bounded-predicates.md): E. G. Gilbert, D. W. Johnson, S. S.
// Keerthi, A fast procedure for computing the distance between complex objects, 1988.

#include <kaboum/base/error.h>
#include <kaboum/collide/proximity.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact_proximity.h"
#include "simplex.h"

namespace kaboum::collide {
namespace {

using detail::Simplex;
using geom::Vec3;

constexpr int kMostSteps = 32;
/// Of the sum of magnitudes: bounds the error of a gap, and of the components of a difference.
constexpr double kUnit = 0x1p-48;
constexpr double kUp = 1 + 0x1p-48;
/// Magnitudes below it: products may lose digits to underflow.
constexpr double kSmallest = 1e-80;

Vec3 scaled(const Vec3& d) { return d / d.cwiseAbs().maxCoeff(); }

/// From one body to the other.
Vec3 direction_between(const Posed& a, const Posed& b) {
  const Vec3 d = scaled(b.center() - a.center());
  return d.allFinite() ? d : Vec3::UnitX();
}

bool is_axis(const Axis* axis) {
  return axis != nullptr && axis->allFinite() && !axis->isZero(0) && scaled(*axis).allFinite();
}

/// Whether the four corners' hull certainly has the origin inside.
bool holds_origin(const Simplex& s, double error) {
  double largest = 0;
  for (int i = 0; i < 4; ++i) largest = std::max(largest, s.vertex[i].w.cwiseAbs().maxCoeff());
  if (!(largest > kSmallest)) return false;
  const double reach = largest + error;
  const double bound = (18 * error + 0x1p-46 * largest) * reach * reach;
  const auto volume = [&](int i, int j, int k) {
    return s.vertex[i].w.dot(s.vertex[j].w.cross(s.vertex[k].w));
  };
  const double v0 = volume(1, 2, 3), v1 = -volume(0, 2, 3), v2 = volume(0, 1, 3),
               v3 = -volume(0, 1, 2);
  const auto [least, most] = std::minmax({v0, v1, v2, v3});
  return least > bound || most < -bound;
}

/// One step after another towards the point of the differences nearest to the origin.
class Search {
 public:
  Search(const Posed& a, const Posed& b, const Axis* axis)
      : a_(a),
        b_(b),
        magnitude_(a.magnitude() + b.magnitude()),
        error_(kUnit * magnitude_.maxCoeff()),
        error_norm_(kUnit * magnitude_.lpNorm<1>()),
        direction_(is_axis(axis) ? scaled(*axis) : direction_between(a, b)) {}

  /// Looks along the direction: sets what no difference is nearer than. [length]
  void look() {
    p_ = a_.support(direction_);
    q_ = b_.support(-direction_);
    const double sum = direction_.cwiseAbs().dot(magnitude_);
    gap_ = (-q_.value - p_.value) - kUnit * sum;
    if (!(sum > kSmallest)) gap_ = -std::numeric_limits<double>::infinity();
  }
  void look(bool rough) {
    if (rough)
      look_roughly();
    else
      look();
  }
  void aim(const Vec3& direction) { direction_ = direction; }
  /// The same in floats, with what they may be wrong by.
  void look_roughly() {
    double error_a = 0, error_b = 0;
    p_ = a_.rough_support(direction_, error_a);
    q_ = b_.rough_support(-direction_, error_b);
    const double sum = direction_.cwiseAbs().dot(magnitude_);
    gap_ = (-q_.value - p_.value) - (error_a + error_b) - kUnit * sum;
    if (!(sum > kSmallest)) gap_ = -std::numeric_limits<double>::infinity();
  }
  /// Forgets the corners, keeps the direction.
  void restart() {
    simplex_.size = 0;
    square_ = std::numeric_limits<double>::infinity();
    nearest_ = Vec3::Constant(square_);
  }
  [[nodiscard]] bool is_beyond(double reach) const {
    return gap_ > 0 && gap_ > reach * direction_.norm() * kUp;
  }
  [[nodiscard]] double lower() const {
    return gap_ > 0 ? gap_ / (direction_.norm() * kUp * kUp) : 0;
  }

  /// Takes in the corner seen. @return false when that leads no nearer.
  bool step() {
    if (simplex_.size == 4 || simplex_.has(p_.index, q_.index)) return false;
    simplex_.add({b_.point(q_.index) - a_.point(p_.index), p_.index, q_.index});
    Simplex next = simplex_;
    const Vec3 nearest = reduce_to_nearest(next);
    const double square = nearest.squaredNorm();
    if (!(square < square_)) return false;
    simplex_ = next;
    square_ = square;
    nearest_ = nearest;
    const Vec3 d = scaled(nearest);
    if (!d.allFinite()) return false;
    direction_ = d;
    return true;
  }
  /// No difference's distance is known to be below it. [length]
  [[nodiscard]] double upper() const { return nearest_.norm() * kUp + error_norm_ * kUp; }
  [[nodiscard]] bool meet() const { return simplex_.size == 4 && holds_origin(simplex_, error_); }

  [[nodiscard]] const Vec3& direction() const { return direction_; }
  [[nodiscard]] const Simplex& simplex() const { return simplex_; }
  [[nodiscard]] Vec3 point_of_a() const { return point(a_, true); }
  [[nodiscard]] Vec3 point_of_b() const { return point(b_, false); }

 private:
  [[nodiscard]] Vec3 point(const Posed& body, bool first) const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < simplex_.size; ++i) {
      const auto& v = simplex_.vertex[i];
      sum += simplex_.share[i] * body.point(first ? v.a : v.b);
    }
    return sum;
  }

  const Posed &a_, &b_;
  Vec3 magnitude_;
  double error_, error_norm_;
  Vec3 direction_;
  Polytope::Support p_, q_;
  double gap_ = 0;
  Simplex simplex_;
  double square_ = std::numeric_limits<double>::infinity();
  Vec3 nearest_ = Vec3::Constant(std::numeric_limits<double>::infinity());
};

}  // namespace

bool are_within(const Posed& a, const Posed& b, double reach, Axis* axis, Decided* decided) {
  if (!(reach >= 0) || !std::isfinite(reach))
    throw Error(ErrorCode::InvalidArgument, "a reach must be a number from 0 on");
  Search search(a, b, axis);
  // Floats first: they find directions and corners as well, and most pairs are far from touching.
  bool rough = a.is_rough() && b.is_rough();
  // A direction that does not separate any more is a worse start than any, and what moved that far
  // will again: none is remembered this time.
  if (is_axis(axis)) {
    search.look(rough);
    if (search.is_beyond(reach)) {
      if (decided != nullptr) ++decided->at_once;
      return false;
    }
    *axis = Axis::Zero();
    axis = nullptr;
    search.aim(direction_between(a, b));
  }
  for (;; rough = false) {
    for (int steps = 0; steps < kMostSteps; ++steps) {
      search.look(rough);
      if (search.is_beyond(reach)) {
        if (axis != nullptr) *axis = search.direction();
        if (decided != nullptr) ++decided->rounded;
        return false;
      }
      const bool nearer = search.step();
      if (search.meet() || search.upper() <= reach) {
        if (decided != nullptr) ++decided->rounded;
        return true;
      }
      if (!nearer) break;
    }
    if (!rough) break;
    search.restart();
  }
  if (decided != nullptr) ++decided->exactly;
  return detail::are_within_exactly(a, b, reach, search.simplex());
}

Gap gap_between(const Posed& a, const Posed& b, Axis* axis) {
  Search search(a, b, axis);
  Gap best;
  best.upper = std::numeric_limits<double>::infinity();
  for (int steps = 0; steps < kMostSteps; ++steps) {
    search.look();
    if (search.lower() > best.lower) {
      best.lower = search.lower();
      if (axis != nullptr) *axis = search.direction();
    }
    const bool nearer = search.step();
    if (search.upper() < best.upper) {
      best.upper = search.upper();
      best.on_a = search.point_of_a();
      best.on_b = search.point_of_b();
    }
    if (search.meet()) {
      best.lower = best.upper = 0;
      break;
    }
    if (!nearer || best.upper - best.lower <= 0x1p-44 * best.upper) break;
  }
  return best;
}

}  // namespace kaboum::collide
