#pragma once

#include <kaboum/base/error.h>

#include <cmath>
#include <string>

namespace kaboum::collide::detail {

/// Sums of several margins and errors are rounded up by it.
constexpr double kSumUp = 1 + 0x1p-50;

inline double require_length(double x, const char* what) {
  if (!(x >= 0) || !std::isfinite(x))
    throw Error(ErrorCode::InvalidArgument,
                std::string("a bounding set with ") + what + " that is no number from 0 on");
  return x;
}

}  // namespace kaboum::collide::detail
