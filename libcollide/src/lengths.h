#pragma once

#include <kaboum/base/error.h>

#include <cmath>
#include <string>

namespace kaboum::collide::detail {

/// Sums of several margins and errors are rounded up by it.
constexpr double kSumUp = 1 + 0x1p-50;
/// Of the sum of magnitudes: bounds the error of a gap, of a product with a direction, and of the
/// components of a difference (docs/algorithms/bounded-predicates.md).
constexpr double kUnit = 0x1p-48;
/// What follows from a few rounded operations is rounded up by it.
constexpr double kUp = 1 + 0x1p-48;

inline double require_length(double x, const char* what) {
  if (!(x >= 0) || !std::isfinite(x))
    throw Error(ErrorCode::InvalidArgument,
                std::string("a bounding set with ") + what + " that is no number from 0 on");
  return x;
}

}  // namespace kaboum::collide::detail
