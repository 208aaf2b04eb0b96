// Distances of convex polytopes in rounded arithmetic, every answer of which is checked with a
// bound of its error (docs/algorithms/bounded-predicates.md): E. G. Gilbert, D. W. Johnson, S. S.
// Keerthi, A fast procedure for computing the distance between complex objects, 1988.

#include <kaboum/base/error.h>
#include <kaboum/collide/proximity.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "exact_proximity.h"
#include "farthest.h"
#include "lengths.h"
#include "simplex.h"

namespace kaboum::collide {
namespace {

using detail::kUnit;
using detail::kUp;
using detail::Simplex;
using geom::Vec3;

constexpr int kMostSteps = 32;
/// Of |direction| · extents: bounds the error of products in floats, twice over.
constexpr double kFloatUnit = 0x1p-19;
/// Magnitudes below it: products may lose digits to underflow.
constexpr double kSmallest = 1e-80;
/// Of vectors that are scaled to directions.
constexpr double kLeastLength = 1e-300, kMostLength = 1e300;

/// Scales the largest |component| to 1, up to rounding. @return false, and leaves the direction as
/// it is, for what has none: zeros, and numbers that are not finite.
bool scale(const Vec3& by, Vec3& direction) {
  const Vec3 size = by.cwiseAbs();
  const double sum = size.x() + size.y() + size.z();
  if (!(sum >= kLeastLength && sum <= kMostLength)) return false;
  direction = by * (1 / std::max(std::max(size.x(), size.y()), size.z()));
  return true;
}

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double sum_of_products(const Vec3& a, const Vec3& b) {
  return std::abs(a[0]) * b[0] + std::abs(a[1]) * b[1] + std::abs(a[2]) * b[2];
}

/// Transposed matrix times vector, entry by entry: vectors of two do not pay here.
Vec3 back(const Posed& body, const Vec3& d) {
  const Eigen::Matrix3d& l = body.pose().linear;
  return {dot(l.col(0), d), dot(l.col(1), d), dot(l.col(2), d)};
}

std::array<float, 3> in_floats(const Vec3& d) {
  return {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
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
  Search(const Posed& a, const Posed& b)
      : a_(a), b_(b), extent_(a.extent() + b.extent()), magnitude_(a.magnitude() + b.magnitude()) {}

  /// Where to look next. @return false, and it stays as it is, where that is no direction.
  bool aim(const Vec3& direction) { return scale(direction, direction_); }
  /// From one body to the other.
  void aim_between() {
    if (!aim(b_.center() - a_.center())) direction_ = Vec3::UnitX();
  }

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
  /// The same in floats, with what they may be wrong by.
  void look_roughly() {
    const Vec3 d = direction_, towards_a = back(a_, d), towards_b = -back(b_, d);
    const auto [p, q] = detail::farthest_of(a_.body().floats(), in_floats(towards_a),
                                            b_.body().floats(), in_floats(towards_b));
    p_ = {std::min(p.index, a_.body().size() - 1), p.product + dot(d, a_.pose().translation)};
    q_ = {std::min(q.index, b_.body().size() - 1), q.product - dot(d, b_.pose().translation)};
    const double error = kFloatUnit * sum_of_products(d, extent_) + 2e-29;
    const double sum = sum_of_products(d, magnitude_);
    gap_ = (-q_.value - p_.value) - error - kUnit * sum;
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
    simplex_.vertex[simplex_.size] = {b_.point(q_.index) - a_.point(p_.index), p_.index, q_.index};
    ++simplex_.size;
    const detail::Face face = nearest_face(simplex_);
    const double square = face.point.squaredNorm();
    if (!(square < square_)) {
      --simplex_.size;
      return false;
    }
    keep(simplex_, face);
    square_ = square;
    nearest_ = face.point;
    return aim(nearest_);
  }
  /// No difference's distance is known to be below it. [length]
  [[nodiscard]] double upper() const {
    return nearest_.norm() * kUp + kUnit * magnitude_.lpNorm<1>() * kUp;
  }
  [[nodiscard]] bool meet() const {
    return simplex_.size == 4 && holds_origin(simplex_, kUnit * magnitude_.maxCoeff());
  }

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
  Vec3 extent_, magnitude_;
  Vec3 direction_ = Vec3::UnitX();
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
  Search search(a, b);
  // Floats first: they find directions and corners as well, and most pairs are far from touching.
  bool rough = a.is_rough() && b.is_rough();
  // A direction that does not separate any more is a worse start than any, and what moved that far
  // will again: none is remembered this time.
  if (axis != nullptr && search.aim(*axis)) {
    search.look(rough);
    if (search.is_beyond(reach)) {
      if (decided != nullptr) ++decided->at_once;
      return false;
    }
    *axis = Axis::Zero();
    axis = nullptr;
  }
  search.aim_between();
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
  Search search(a, b);
  if (axis == nullptr || !search.aim(*axis)) search.aim_between();
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
