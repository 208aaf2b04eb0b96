#pragma once

#include <kaboum/geom/float32.h>

namespace kaboum::bcd {

/// The largest float32 number that is not above x > 0.
inline double float32_below(double x) {
  const double out = geom::to_float32(x);
  return out > x ? out - geom::float32_spacing(out * (1 - 1e-7)) : out;
}

}  // namespace kaboum::bcd
