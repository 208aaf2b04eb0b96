#pragma once

#include <kaboum/geom/float32.h>

#include <cmath>
#include <limits>

namespace kaboum::bcd {

/// The largest float32 number that is not above x.
inline double float32_below(double x) {
  const double f = geom::to_float32(x);
  return f <= x ? f
                : static_cast<double>(std::nextafter(static_cast<float>(f),
                                                     -std::numeric_limits<float>::infinity()));
}
/// The least float32 number that is not below x.
inline double float32_above(double x) { return -float32_below(-x); }

}  // namespace kaboum::bcd
