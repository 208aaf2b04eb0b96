#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kaboum::kinematics {

/// A closed interval of numbers. Results of operations hold all results of the operands' numbers:
/// they are made wider than rounding may be wrong by.
struct Interval {
  double lower = 0, upper = 0;

  // NOLINTNEXTLINE(google-explicit-constructor): a number is an interval
  Interval(double x = 0) : lower(x), upper(x) {}
  Interval(double from, double to) : lower(from), upper(to) {}

  [[nodiscard]] bool holds(double x) const { return lower <= x && x <= upper; }
  [[nodiscard]] double width() const { return upper - lower; }
};

/// Wider by what rounding, and the library's sine, cosine, arc tangent and root, are wrong by.
inline Interval widened(double lower, double upper) {
  constexpr double kUlps = 1e-15, kLeast = 1e-290;
  return {lower - kUlps * std::abs(lower) - kLeast, upper + kUlps * std::abs(upper) + kLeast};
}

inline Interval operator-(const Interval& a) { return {-a.upper, -a.lower}; }
inline Interval operator+(const Interval& a, const Interval& b) {
  return widened(a.lower + b.lower, a.upper + b.upper);
}
inline Interval operator-(const Interval& a, const Interval& b) { return a + -b; }
inline Interval operator*(const Interval& a, const Interval& b) {
  const auto [least, most] =
      std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
  return widened(least, most);
}
/// @pre the number is above 0.
inline Interval operator/(const Interval& a, double b) { return widened(a.lower / b, a.upper / b); }

inline Interval square(const Interval& a) {
  const double most = std::max(std::abs(a.lower), std::abs(a.upper));
  const double least = a.holds(0) ? 0 : std::min(std::abs(a.lower), std::abs(a.upper));
  const Interval wide = widened(least * least, most * most);
  return {std::max(0.0, wide.lower), wide.upper};
}

/// Of what is not below 0.
inline Interval sqrt(const Interval& a) {
  const Interval wide =
      widened(std::sqrt(std::max(0.0, a.lower)), std::sqrt(std::max(0.0, a.upper)));
  return {std::max(0.0, wide.lower), wide.upper};
}

/// The part within [lower, upper]. @pre there is one, but for rounding.
inline Interval clamped(const Interval& a, double lower, double upper) {
  return {std::clamp(a.lower, lower, upper), std::clamp(a.upper, lower, upper)};
}

/// Whether an angle, whole turns added, may be in the interval.
inline bool may_hold_turned(const Interval& a, double angle) {
  constexpr double kTurn = 2 * std::numbers::pi, kSlack = 1e-12;
  return std::floor((a.upper + kSlack - angle) / kTurn) >=
         std::ceil((a.lower - kSlack - angle) / kTurn);
}

inline Interval cos(const Interval& a) {
  const double x = std::cos(a.lower), y = std::cos(a.upper);
  const double slack = 1e-15 * std::max(std::abs(a.lower), std::abs(a.upper));
  return clamped(widened(may_hold_turned(a, std::numbers::pi) ? -1 : std::min(x, y) - slack,
                         may_hold_turned(a, 0) ? 1 : std::max(x, y) + slack),
                 -1, 1);
}
inline Interval sin(const Interval& a) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const double x = std::sin(a.lower), y = std::sin(a.upper);
  const double slack = 1e-15 * std::max(std::abs(a.lower), std::abs(a.upper));
  return clamped(widened(may_hold_turned(a, -kQuarter) ? -1 : std::min(x, y) - slack,
                         may_hold_turned(a, kQuarter) ? 1 : std::max(x, y) + slack),
                 -1, 1);
}

/// The directions of a box's points, as an interval that may go past π: all where the box has the
/// origin.
inline Interval atan2(const Interval& y, const Interval& x) {
  constexpr double kPi = std::numbers::pi;
  if (x.holds(0) && y.holds(0)) return {-kPi, kPi};
  // A box without the origin is seen under less than a half turn: its corners are its borders.
  const double middle = std::atan2((y.lower + y.upper) / 2, (x.lower + x.upper) / 2);
  double least = 0, most = 0;
  for (const double cx : {x.lower, x.upper})
    for (const double cy : {y.lower, y.upper}) {
      const double turn = std::remainder(std::atan2(cy, cx) - middle, 2 * kPi);
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
  return {middle + least - 4e-15, middle + most + 4e-15};
}

}  // namespace kaboum::kinematics
