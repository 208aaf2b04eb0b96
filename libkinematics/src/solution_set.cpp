// All configurations for a pose, with the families that free joints make.
// docs/algorithms/inverse-kinematics.md, "Families of solutions", derives them.
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/solution_set.h>

#include <cmath>
#include <optional>

#include "improve.h"
#include "interval.h"
#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

double square(double x) { return x * x; }
double clamped(double x, double lower, double upper) { return std::clamp(x, lower, upper); }

constexpr unsigned bit(std::size_t joint) { return 1U << joint; }

/// Axes and origin of the last frame at the target, in the first frame.
struct Goal {
  Vec3 n, s, z, t;
};

/// The joints' angles in the formulas. Some are given: free ones, and what they branch off at.
struct Branch {
  unsigned free = 0, given = 0;   ///< joints as bits; the free ones are given
  std::array<double, 6> angle{};  ///< of those that are given and not free
  double elbow = 1;               ///< sign of the elbow's sine
  double wrist = 1;  ///< sign of that of the wrist; where axes are aligned cosine of joint 5
  unsigned singular = kRegular;
};

/// Whether the elbow's triangle closes: for some numbers of an interval, for all.
struct Closes {
  bool maybe = true, always = true;
};

Closes closing(const Interval& cosine) {
  // What is stretched all the way is decided by the check of each configuration.
  const bool same = cosine.width() < 1e-9;
  const bool maybe = cosine.upper >= -1 - kBorder && cosine.lower <= 1 + kBorder;
  return {maybe, maybe && (same || (cosine.lower > -1 && cosine.upper < 1))};
}
Closes closing(double cosine) {
  const bool closes = std::abs(cosine) <= 1 + kBorder;
  return {closes, closes};
}

/// The angles that are not given follow, by the formulas of `solve`; of intervals, what holds them.
template <class T>
Closes follow(const ClosedForm& f, const Goal& g, const Branch& b, std::array<T, 6>& angle) {
  using std::atan2, std::cos, std::sin, std::sqrt;
  const T s0 = sin(angle[0]), c0 = cos(angle[0]), along = c0 * g.t.x() + s0 * g.t.y();
  const bool spherical = f.family == Family::SphericalWrist;
  T x = along - T(f.a1), y = T(-g.t.z()), sum = T(0);
  double second = f.forearm, bend = f.bend;
  if (!spherical) {
    const T zn = s0 * g.n.x() - c0 * g.n.y(), zs = s0 * g.s.x() - c0 * g.s.y(),
            zz = s0 * g.z.x() - c0 * g.z.y();
    T s = c0 * g.z.x() + s0 * g.z.y(), c = T(-g.z.z());
    if (f.family == Family::FiveAxes) {
      angle[4] = atan2(zn, zs);
    } else {
      if ((b.given & bit(5)) != 0) {
        angle[4] = T(b.wrist > 0 ? 0 : kPi);
      } else {
        angle[4] = atan2(b.wrist * sqrt(square(zn) + square(zs)), zz);
        angle[5] = atan2(-b.wrist * zs, b.wrist * zn);
      }
      const T s5 = sin(angle[5]), c5 = cos(angle[5]);
      s = -(c0 * (s5 * g.n.x() + c5 * g.s.x()) + s0 * (s5 * g.n.y() + c5 * g.s.y()));
      c = s5 * g.n.z() + c5 * g.s.z();
    }
    sum = atan2(s, c);
    x = x - f.a4 * c - f.d5 * s;
    y = T(g.t.z()) - f.a4 * s + f.d5 * c;
    second = f.a3;
    bend = 0;
  }
  const T v = square(x) + square(y);
  T cosine = (v - T(square(f.a2) + square(second))) / (2 * f.a2 * second);
  const Closes closes = closing(cosine);
  if (!closes.maybe) return closes;
  cosine = clamped(cosine, -1, 1);
  const T sine = sqrt((T(1) - cosine) * (T(1) + cosine));
  angle[2] = b.elbow * atan2(sine, cosine) - T(bend);
  if ((b.given & bit(1)) == 0) {
    const T k1 = T(f.a2) + second * cosine, k2 = b.elbow * second * sine;
    angle[1] = atan2(k1 * y - k2 * x, k1 * x + k2 * y);
  }
  if (!spherical) {
    angle[3] = sum - angle[1] - angle[2];
    return closes;
  }
  const T s12 = sin(angle[1] + angle[2]), c12 = cos(angle[1] + angle[2]);
  // Directions of the target in frame 3.
  const auto x3 = [&](const Vec3& d) { return c12 * (c0 * d.x() + s0 * d.y()) - s12 * d.z(); };
  const auto y3 = [&](const Vec3& d) { return s0 * d.x() - c0 * d.y(); };
  const auto z3 = [&](const Vec3& d) { return -(s12 * (c0 * d.x() + s0 * d.y())) - c12 * d.z(); };
  if ((b.given & bit(3)) != 0) {
    angle[4] = T(b.wrist > 0 ? 0 : kPi);
    const T s3 = sin(angle[3]), c3 = cos(angle[3]);
    angle[5] = atan2(s3 * x3(g.n) - c3 * y3(g.n), s3 * x3(g.s) - c3 * y3(g.s));
  } else {
    const T zx = x3(g.z), zy = y3(g.z);
    angle[3] = atan2(b.wrist * zy, b.wrist * zx);
    angle[4] = atan2(b.wrist * sqrt(square(zx) + square(zy)), -z3(g.z));
    angle[5] = atan2(-b.wrist * z3(g.s), b.wrist * z3(g.n));
  }
  return closes;
}

/// Finds the branches with free joints that a target has.
class Branches {
 public:
  Branches(const ClosedForm& form, const Goal& goal, double bound)
      : f_(form), g_(goal), within_(form, bound) {
    five_ = f_.family == Family::FiveAxes;
    spherical_ = f_.family == Family::SphericalWrist;
    const ShoulderTurns turns = shoulder_turns(f_, within_, spherical_ ? 1 : -1, g_.t, g_.z);
    if (turns.free)
      free_shoulder();
    else
      for (int i = 0; i < turns.count; ++i) at(turns.angle[static_cast<std::size_t>(i)], kRegular);
  }

  [[nodiscard]] const std::vector<Branch>& found() const { return found_; }
  /// A joint is nearly free somewhere: what is found need not be all.
  [[nodiscard]] bool nearly() const { return nearly_; }

 private:
  /// The two links' end as the elbow's formulas have it, for turns of the joints before.
  struct Elbow {
    double x = 0, y = 0;
  };

  bool is_nothing(double size, double limit, double unit) {
    const bool nothing = size <= limit;
    nearly_ |= !nothing && size < kNearlySingular * unit;
    return nothing;
  }
  bool is_aligned(double sine) { return is_nothing(std::abs(sine), within_.angle, 1); }
  bool is_folded(double x, double y) {
    const double second = spherical_ ? f_.forearm : f_.a3;
    // Only links of the same length fold onto each other.
    if (std::abs(f_.a2 - second) > kNearlySingular * f_.reach) return false;
    return is_nothing(std::hypot(x, y), within_.length, f_.reach);
  }
  bool closes(double x, double y) const {
    const double second = spherical_ ? f_.forearm : f_.a3;
    return std::abs((square(x) + square(y) - square(f_.a2) - square(second)) /
                    (2 * f_.a2 * second)) <= 1 + kBorder;
  }

  static Branch branch(double angle0, unsigned singular) {
    Branch b;
    b.given = bit(0);
    b.angle[0] = angle0;
    b.singular = singular;
    return b;
  }
  void add_free(Branch b, std::size_t joint, unsigned singular) {
    add(with_free(b, joint, singular));
  }
  static Branch with_free(Branch b, std::size_t joint, unsigned singular) {
    b.free |= bit(joint);
    b.given |= bit(joint);
    b.singular |= singular;
    return b;
  }
  static Branch with(Branch b, std::size_t joint, double angle) {
    b.given |= bit(joint);
    b.angle[joint] = angle;
    return b;
  }
  void add(const Branch& b) { found_.push_back(b); }
  /// Both sides of elbow and wrist, where they are not decided.
  void add_sides(Branch b, bool elbows, bool wrists) {
    for (int elbow = 0; elbow < (elbows ? 2 : 1); ++elbow)
      for (int wrist = 0; wrist < (wrists ? 2 : 1); ++wrist) {
        if (elbows) b.elbow = elbow == 0 ? 1 : -1;
        if (wrists) b.wrist = wrist == 0 ? 1 : -1;
        add(b);
      }
  }

  /// Joint 1 is turned to an angle.
  void at(double angle0, unsigned singular) {
    const Branch b = branch(angle0, singular);
    const double s0 = std::sin(angle0), c0 = std::cos(angle0);
    const double along = c0 * g_.t.x() + s0 * g_.t.y();
    if (spherical_)
      spherical_at(b, along - f_.a1, c0 * g_.z.x() + s0 * g_.z.y(), s0 * g_.z.x() - c0 * g_.z.y());
    else if (five_)
      add_if_folded(b, along, c0 * g_.z.x() + s0 * g_.z.y(), -g_.z.z());
    else
      parallel_at(b, along, {s0, -c0, 0});
  }

  // Spherical wrist. `level`, `aside`: of the target's axis 6 along the arm's plane and across it.
  void spherical_at(Branch b, double x, double level, double aside) {
    const double y = -g_.t.z();
    if (!closes(x, y)) return;
    if (!is_folded(x, y)) {
      for (const double elbow : {1.0, -1.0}) {
        b.elbow = elbow;
        if (elbow < 0 && is_stretched(x, y)) break;
        add_if_wrist_aligned(b);
      }
      return;
    }
    // Joint 2 is free; where it brings axis 4 to axis 6, joint 4 is.
    add_sides(with_free(b, 1, kElbow), false, true);
    if (is_aligned(aside)) add_aligned_by_joint2(b, level);
  }

  [[nodiscard]] bool is_stretched(double x, double y) const {
    const double second = spherical_ ? f_.forearm : f_.a3;
    return square(x) + square(y) >= square(f_.a2 + second) * (1 - 1e-15);
  }

  /// Folded, with axis 6 in the arm's plane at joint 1's angle.
  void add_aligned_by_joint2(Branch b, double level) {
    b.singular |= kElbow;
    std::array<double, 6> angle = b.angle;
    Branch any = b;
    any.given |= bit(1);
    follow(f_, g_, any, angle);
    for (const double sign : {1.0, -1.0}) {  // of axis 6 along axis 4
      // z3 = (−c0 s12, −s0 s12, −c12) is sign · z.
      const double both = std::atan2(-sign * level, -sign * g_.z.z());
      Branch c = with(b, 1, both - angle[2]);
      c.wrist = -sign;
      add_free(c, 3, kWrist);
    }
  }

  /// Joints 1 to 3 of a branch without free ones: whether axes 4 and 6 are on one line there.
  void add_if_wrist_aligned(Branch b) {
    std::array<double, 6> angle = b.angle;
    if (!follow(f_, g_, b, angle).maybe) return;
    if (!is_aligned(std::sin(angle[4]))) return;
    b.wrist = std::cos(angle[4]) > 0 ? 1 : -1;
    add_free(b, 3, kWrist);
  }

  // Three parallel axes; `z1` is the direction of axis 2.
  void parallel_at(Branch b, double along, const Vec3& z1) {
    const double zn = z1.dot(g_.n), zs = z1.dot(g_.s);
    if (is_aligned(std::hypot(zn, zs))) {
      b.wrist = z1.dot(g_.z) > 0 ? 1 : -1;
      add_aligned(b, along);
      return;
    }
    for (const double wrist : {1.0, -1.0}) {
      b.wrist = wrist;
      std::array<double, 6> angle = b.angle;
      Branch any = b;
      any.given |= bit(1);
      follow(f_, g_, any, angle);
      const double s5 = std::sin(angle[5]), c5 = std::cos(angle[5]);
      const Vec3 z4 = -(s5 * g_.n + c5 * g_.s);
      add_if_folded(b, along, -z1.y() * z4.x() + z1.x() * z4.y(), -z4.z());
    }
  }

  /// `s`, `c`: sine and cosine of the sum of joints 2 to 4.
  void add_if_folded(const Branch& b, double along, double s, double c) {
    const double x = along - f_.a1 - f_.a4 * c - f_.d5 * s, y = g_.t.z() - f_.a4 * s + f_.d5 * c;
    if (is_folded(x, y)) add_free(b, 1, kElbow);
  }

  /// Axis 6 is parallel to axis 2: joints 2, 3, 4 and 6 move in a plane, a four-bar linkage. Axis 5
  /// goes around the circle of radius `round` about (x, y).
  void add_aligned(const Branch& b, double along) {
    const Branch free = with_free(b, 5, kWrist);
    add_sides(free, true, false);
    if (std::abs(f_.a2 - f_.a3) > kNearlySingular * f_.reach) return;
    const double x = along - f_.a1, y = g_.t.z(), distance = std::hypot(x, y),
                 round = std::hypot(f_.a4, f_.d5);
    if (!is_nothing(std::abs(distance - round), within_.length, f_.reach)) return;
    if (is_nothing(round, within_.length, f_.reach)) {
      add_free(free, 1, kElbow);
      return;
    }
    const double sum = std::atan2(f_.d5, f_.a4) + std::atan2(y, x), s = std::sin(sum),
                 c = std::cos(sum);
    const Vec3 z4(std::cos(b.angle[0]) * s, std::sin(b.angle[0]) * s, -c);
    Branch folded = with(b, 5, std::atan2(-z4.dot(g_.n), -z4.dot(g_.s)));
    folded.singular |= kWrist;
    add_free(folded, 1, kElbow);
  }

  /// The wrist is on axis 1.
  void free_shoulder() {
    const Branch free = with_free(Branch{}, 0, kShoulder);
    if (spherical_)
      spherical_free(free);
    else if (five_)
      five_free(free);
    else
      parallel_free(free);
  }

  void spherical_free(const Branch& free) {
    const double x = -f_.a1, y = -g_.t.z(), level = std::hypot(g_.z.x(), g_.z.y());
    const bool upright = is_aligned(level), folded = is_folded(x, y);
    const double towards = std::atan2(g_.z.y(), g_.z.x());
    if (!closes(x, y)) return;
    // Stretched, the elbow turns by the root of how far the wrist is from axis 1.
    const double stretched = 1 - (square(x) + square(y)) / square(f_.a2 + f_.forearm);
    if (stretched < 1e-8 && std::hypot(g_.t.x(), g_.t.y()) > 1e-14 * f_.reach) nearly_ = true;
    if (folded) {
      add_sides(with_free(free, 1, kElbow), false, true);
      if (upright) {
        add_aligned_by_joint2(free, 0);
      } else {
        add_aligned_by_joint2(branch(towards, kShoulder), level);
        add_aligned_by_joint2(branch(towards + kPi, kShoulder), -level);
      }
      return;
    }
    for (const double elbow : {1.0, -1.0}) {
      if (elbow < 0 && is_stretched(x, y)) break;
      Branch b = free;
      b.elbow = elbow;
      // Axis 6 along axis 1, and axis 4 as well: joints 1 and 4 are free.
      std::array<double, 6> angle{};
      follow(f_, g_, b, angle);
      const double s12 = std::sin(angle[1] + angle[2]), c12 = std::cos(angle[1] + angle[2]);
      if (upright && is_aligned(s12)) {
        b.wrist = c12 * g_.z.z() > 0 ? 1 : -1;
        add_free(b, 3, kWrist);
        continue;
      }
      add_sides(b, false, true);
      if (upright) continue;
      for (const double side : {1.0, -1.0}) {
        const double off = side * c12 * level - s12 * g_.z.z();
        if (!is_aligned(off)) {
          // What the elbow is not known to turns joints 4 and 6 where they are nearly one.
          nearly_ |= error_after_elbow(f_, kRounding, std::hypot(x, y), f_.forearm, false) >
                     kCoarse * std::abs(off);
          continue;
        }
        Branch c = branch(side > 0 ? towards : towards + kPi, kShoulder);
        c.elbow = elbow;
        c.wrist = -(side * s12 * level + c12 * g_.z.z()) < 0 ? 1 : -1;
        add_free(c, 3, kWrist);
      }
    }
  }

  void parallel_free(const Branch& free) {
    add_sides(free, true, true);
    // Axis 2 may be turned to axis 6, where that is level.
    if (is_aligned(g_.z.z()))
      for (const double side : {1.0, -1.0})
        at(std::atan2(side * g_.z.x(), -side * g_.z.y()), kShoulder);
    if (std::abs(f_.a2 - f_.a3) > kNearlySingular * f_.reach) return;
    if (std::hypot(f_.a4, f_.d5) <= within_.length) {
      if (is_folded(-f_.a1, g_.t.z())) add_sides(with_free(free, 1, kElbow), false, true);
      return;
    }
    // The elbow may fold where joint 1 has some single value: not looked for.
    if (std::abs(std::hypot(f_.a1, g_.t.z()) - std::hypot(f_.a4, f_.d5)) <=
        kNearlySingular * f_.reach)
      nearly_ = true;
  }

  /// Axis 5 is along axis 1, too.
  void five_free(const Branch& free) {
    const double c = -g_.z.z(), x = -f_.a1 - f_.a4 * c, y = g_.t.z();
    if (is_folded(x, y))
      add_free(free, 1, kElbow);
    else
      add_sides(free, true, false);
  }

  const ClosedForm& f_;
  const Goal& g_;
  FreeWithin within_;
  std::vector<Branch> found_;
  bool nearly_ = false, five_ = false, spherical_ = false;
};

/// Looks where a branch is within the limits: boxes of values of its free joints are halved until
/// the others are within their limits in all of them, or one of them is outside in all, for
/// certain.
class Exploration {
 public:
  Exploration(const ClosedForm& form, const Goal& goal, const Transform& target,
              const SolutionSetOptions& options, const Branch& branch)
      : f_(form),
        goal_(goal),
        target_(target),
        options_(options),
        branch_(branch),
        axes_(form.arm.axes.size()) {
    for (std::size_t i = 0; i < axes_; ++i)
      if ((branch.free & bit(i)) != 0) free_.push_back(i);
    explore();
  }

  /// nullopt: nothing is within the limits.
  std::optional<SolutionFamily> family() {
    if (good_.empty()) return std::nullopt;
    SolutionFamily out;
    out.free = free_;
    out.singular = branch_.singular;
    // What the reference has, where that will do, comes first.
    std::array<double, 3> kept{};
    for (std::size_t k = 0; k < free_.size(); ++k) kept[k] = options_.solve.reference[free_[k]];
    add(out, kept);
    free_.size() == 1 ? curve(out) : surface(out);
    if (out.representatives.empty()) {
      decided_ = false;
      return std::nullopt;
    }
    return out;
  }
  /// What is not in the family is outside the limits, but for its borders.
  [[nodiscard]] bool decided() const { return decided_; }

 private:
  using Box = std::array<Interval, 3>;
  enum class Fit { Outside, Maybe, Within };

  /// Of evaluations; the narrowest boxes of one free joint, and of several. [rad]
  static constexpr int kMost = 5'000;
  static constexpr double kNarrow = 1e-6, kNarrowOfSeveral = 0.15;
  /// Ranges are as exact as this. [rad]
  static constexpr double kBorderOfRange = 1e-5;
  /// What is this near a limit is not certainly outside: more than the bound of solutions does to
  /// joints that are not nearly free. [rad]
  static constexpr double kSlack = 1e-6;

  [[nodiscard]] double angle_of(std::size_t joint, double q) const {
    return f_.sign[joint] * q + f_.offset[joint];
  }
  [[nodiscard]] Interval angle_of(std::size_t joint, const Interval& q) const {
    return f_.sign[joint] * q + Interval(f_.offset[joint]);
  }

  /// A joint's values that are looked at: its limits, or a whole turn within them.
  [[nodiscard]] Interval range_of(std::size_t joint) const {
    const Axis& axis = f_.arm.axes[joint];
    if (options_.limits) {
      if (axis.upper - axis.lower <= 2 * kPi) return {axis.lower, axis.upper};
      if (axis.lower > -kPi) return {axis.lower, axis.lower + 2 * kPi};
      if (axis.upper < kPi) return {axis.upper - 2 * kPi, axis.upper};
    }
    return {-kPi, kPi};
  }

  [[nodiscard]] Fit fit(std::size_t joint, const Interval& angle) const {
    const Axis& axis = f_.arm.axes[joint];
    if (!options_.limits) return Fit::Within;
    const Interval q = f_.sign[joint] * (angle - Interval(f_.offset[joint]));
    const double turn = 2 * kPi;
    if (std::floor((axis.upper + kSlack - q.lower) / turn) <
        std::ceil((axis.lower - kSlack - q.upper) / turn))
      return Fit::Outside;
    return std::floor((axis.upper + kOnLimit - q.upper) / turn) >=
                   std::ceil((axis.lower - kOnLimit - q.lower) / turn)
               ? Fit::Within
               : Fit::Maybe;
  }

  [[nodiscard]] Fit look_at(const Box& box) const {
    std::array<Interval, 6> angle;
    for (std::size_t i = 0; i < axes_; ++i) angle[i] = branch_.angle[i];
    for (std::size_t k = 0; k < free_.size(); ++k) angle[free_[k]] = angle_of(free_[k], box[k]);
    const Closes closes = follow(f_, goal_, branch_, angle);
    if (!closes.maybe) return Fit::Outside;
    Fit out = closes.always ? Fit::Within : Fit::Maybe;
    for (std::size_t i = 0; i < axes_; ++i) {
      if ((branch_.free & bit(i)) != 0) continue;
      const Fit one = fit(i, angle[i]);
      if (one == Fit::Outside) return one;
      out = std::min(out, one);
    }
    return out;
  }

  /// The configuration for values of the free joints, when it is within the limits and reaches the
  /// target.
  [[nodiscard]] std::optional<Solution> solution_at(const std::array<double, 3>& values) const {
    std::array<double, 6> angle = branch_.angle;
    for (std::size_t k = 0; k < free_.size(); ++k) angle[free_[k]] = angle_of(free_[k], values[k]);
    if (!follow(f_, goal_, branch_, angle).maybe) return std::nullopt;
    Solution out;
    out.singular = branch_.singular;
    out.free = branch_.free;
    std::array<double, 6> near{};
    for (std::size_t i = 0; i < axes_; ++i) {
      out.q[i] = std::remainder(f_.sign[i] * (angle[i] - f_.offset[i]), 2 * kPi);
      near[i] = options_.solve.reference[i];
    }
    for (std::size_t k = 0; k < free_.size(); ++k) near[free_[k]] = out.q[free_[k]] = values[k];
    if (!reaches(out) && !improve(f_, target_, options_.solve, out)) return std::nullopt;
    if (!options_.limits) return out;
    const auto within = nearest_copy(f_.arm, std::span(out.q).first(axes_), near);
    if (!within) return std::nullopt;
    std::copy(within->begin(), within->end(), out.q.begin());
    return reaches(out) ? std::optional(out) : std::nullopt;
  }

  [[nodiscard]] bool reaches(Solution& s) const {
    const PoseError error = difference(forward(f_.arm, std::span(s.q).first(axes_)), target_);
    s.position_error = error.position;
    s.rotation_error = error.rotation;
    return error.position <= options_.solve.bound * f_.reach &&
           error.rotation <= options_.solve.bound;
  }

  [[nodiscard]] std::array<double, 3> middle(const Box& box) const {
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < free_.size(); ++k) out[k] = (box[k].lower + box[k].upper) / 2;
    return out;
  }

  void explore() {
    const bool several = free_.size() > 1;
    Box whole;
    for (std::size_t k = 0; k < free_.size(); ++k) whole[k] = range_of(free_[k]);
    std::vector<Box> open{whole};
    // Of one joint in ascending order: the lower half is looked at first.
    for (int count = 0; !open.empty(); ++count) {
      const Box box = open.back();
      open.pop_back();
      const Fit how = look_at(box);
      if (how == Fit::Outside) continue;
      std::size_t widest = 0;
      for (std::size_t k = 1; k < free_.size(); ++k)
        if (box[k].width() > box[widest].width()) widest = k;
      const double width = box[widest].width();
      // Wide boxes are halved all the same: pieces are what representatives are spread over.
      if (how == Fit::Within && (!several || width < 0.5)) {
        good_.push_back(box);
      } else if (count >= kMost || width <= (several ? kNarrowOfSeveral : kNarrow)) {
        // A piece that is given up before it is narrow may hold anything.
        if (!several && width > kNarrow) decided_ = false;
        if (solution_at(middle(box)))
          good_.push_back(box);
        else
          unknown_.push_back(box);
      } else {
        std::array<Box, 2> halves{box, box};
        halves[0][widest].upper = halves[1][widest].lower =
            (box[widest].lower + box[widest].upper) / 2;
        open.push_back(halves[1]);
        open.push_back(halves[0]);
      }
    }
    if (several) {
      decided_ = unknown_.empty() || !good_.empty();
      return;
    }
    // What is not known is at the border of what is within the limits, or may be more of it.
    for (const Box& box : unknown_)
      if (!std::any_of(good_.begin(), good_.end(), [&](const Box& good) {
            return box[0].lower <= good[0].upper + kBorderOfRange &&
                   box[0].upper >= good[0].lower - kBorderOfRange;
          }))
        decided_ = false;
  }

  void curve(SolutionFamily& out) {
    double length = 0;
    for (const Box& box : good_) {
      if (!out.ranges.empty() && box[0].lower <= out.ranges.back().upper + 1e-12)
        out.ranges.back().upper = box[0].upper;
      else
        out.ranges.push_back({box[0].lower, box[0].upper});
      length += box[0].width();
    }
    for (const JointRange& range : out.ranges) {
      const double width = range.upper - range.lower;
      const double share = length > 0 ? width / length : 1;
      const double count =
          width > 0
              ? std::max(1.0, std::round(share * static_cast<double>(options_.representatives)))
              : 1;
      for (double i = 0; i < count; ++i)
        add(out, {range.lower + width * ((i + 0.5) / count), 0, 0});
    }
  }

  void surface(SolutionFamily& out) {
    out.ranges.assign(free_.size(), {HUGE_VAL, -HUGE_VAL});
    for (const std::vector<Box>* boxes : {&good_, &unknown_})
      for (const Box& box : *boxes)
        for (std::size_t k = 0; k < free_.size(); ++k) {
          out.ranges[k].lower = std::min(out.ranges[k].lower, box[k].lower);
          out.ranges[k].upper = std::max(out.ranges[k].upper, box[k].upper);
        }
    const std::size_t step =
        std::max<std::size_t>(1, good_.size() / (2 * options_.representatives));
    for (std::size_t i = step / 2; i < good_.size(); i += step) add(out, middle(good_[i]));
  }

  void add(SolutionFamily& out, const std::array<double, 3>& values) const {
    if (auto solution = solution_at(values)) out.representatives.push_back(*solution);
  }

  const ClosedForm& f_;
  const Goal& goal_;
  const Transform& target_;
  const SolutionSetOptions& options_;
  const Branch& branch_;
  std::size_t axes_;
  std::vector<std::size_t> free_;
  std::vector<Box> good_, unknown_;
  bool decided_ = true;
};

/// Whether a solution is outside the limits by so little that its accuracy does not decide it.
bool is_at_limit(const Arm& arm, const Solution& s) {
  bool outside = false;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    if (!has_copy(arm.axes[i], s.q[i], std::max(kOnLimit, s.accuracy))) return false;
    outside |= !has_copy(arm.axes[i], s.q[i], kOnLimit);
  }
  return outside;
}

}  // namespace

SolutionSet solve_set(const ClosedForm& form, const Transform& target,
                      const SolutionSetOptions& options) {
  SolutionSet out;
  out.isolated = solve(form, target, options.solve);
  const auto doubt = [&](const char* reason) {
    if (out.complete) out.reason = reason;
    out.complete = false;
  };
  // Of a model that is not the arm, branches are missed at the borders of what is within reach.
  constexpr double kExact = 1e-8, kExactFamilies = 1e-10;
  const double off = std::max(form.model_error.position / form.reach, form.model_error.rotation);
  if (off > kExact) doubt("the arm is only nearly of its family");
  if (options.limits)
    for (const Solution& s : out.isolated)
      if (s.free == 0 && is_at_limit(form.arm, s))
        doubt("a configuration is at a limit, as nearly as it is known");
  out.isolated.keep_if([](const Solution& s) { return s.free == 0; });

  const Transform flange = form.base_inverse * target * form.tool_inverse;
  const Goal goal{flange.linear.col(0), flange.linear.col(1), flange.linear.col(2),
                  flange.translation};
  const Branches branches(form, goal, options.solve.bound);
  if (branches.nearly() || out.isolated.nearly_singular ||
      std::any_of(out.isolated.begin(), out.isolated.end(),
                  [](const Solution& s) { return s.accuracy > kCoarse; }))
    doubt("the pose is nearly singular: rounding decides which configurations reach it");
  if (!branches.found().empty() && off > kExactFamilies)
    doubt("a joint is free, and the arm is only nearly of its family");
  for (const Branch& branch : branches.found()) {
    Exploration exploration(form, goal, target, options, branch);
    if (auto family = exploration.family()) out.families.push_back(std::move(*family));
    if (!exploration.decided())
      doubt("a joint is free, and whether all others can be within their limits is undecided");
  }
  return out;
}

}  // namespace kaboum::kinematics
