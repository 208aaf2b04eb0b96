#pragma once

#include <kaboum/filter/batch_checker.h>

#include <cmath>
#include <span>

#include "lanes.h"
#include "model.h"

namespace kaboum::filter {

struct BatchChecker::Impl {
  const world::Checker* checker;
  world::WorldState state;
  std::size_t robot;
  Instructions instructions;
  detail::Model model;

  /// @param pairs  as of detail::filter_rows
  void filter(std::span<const double> rows, std::span<BatchChecker::Answer> answers,
              detail::OpenPairs* pairs) const;
};

namespace detail {

/// A resolution as motions are looked at with it: rounded up, as sums of floats need it, with what
/// check_motion allows for the rounding of instants.
/// @param size  of the robot
inline float slack_of(double resolution, double size) {
  return std::nextafter(static_cast<float>((resolution + 0x1p-29 * size) * (1 + 0x1p-20)),
                        HUGE_VALF);
}

/// True if the vector code says something of motions between rows that are within the model's
/// values.
inline bool decides_motions(const Model& model, double resolution) {
  constexpr double kLargestResolution = 1e6;  // lengths that errors of floats are bounded for
  return !model.unusable && !model.always_contact && model.variables > 0 && resolution > 0 &&
         resolution < kLargestResolution &&
         slack_of(resolution, model.size) <= kReachSlack * model.size;
}

inline bool is_within(const Model& model, std::span<const double> row) {
  for (std::size_t k = 0; k < row.size(); ++k)
    if (!(row[k] >= model.low[k] && row[k] <= model.high[k])) return false;
  return true;
}

/// A stretch of a motion, from a share of its way to another one.
struct Share {
  double begin = 0, end = 1;
};

/// A stretch of a variable: its value at the middle, and half of its way from there on, both up to
/// 2⁻⁵⁰ of the largest values between.
inline void put_stretch(const Share& s, double a, double b, double& value, double& way) {
  const double middle = 0.5 * (s.begin + s.end), half = 0.5 * (s.end - s.begin);
  const double at = a + middle * (b - a), low = a < b ? a : b, high = a < b ? b : a;
  value = at < low ? low : at > high ? high : at;
  way = half * (b - a);
}

}  // namespace detail
}  // namespace kaboum::filter
