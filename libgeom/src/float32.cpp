// Rounding to float32 and back, out of line: compilers drop a conversion that they see both ways
// of.
#include <kaboum/geom/float32.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kaboum::geom {

double to_float32(double x) { return static_cast<double>(static_cast<float>(x)); }

Vec3 to_float32(const Vec3& p) {
  // One at a time through volatile: see the header.
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    volatile float f = static_cast<float>(p[k]);
    out[k] = static_cast<double>(f);
  }
  return out;
}

bool is_float32(const Vec3& p) { return to_float32(p) == p; }

double float32_spacing(double x) {
  const float a = std::abs(static_cast<float>(x));
  if (!std::isfinite(a)) return std::numeric_limits<double>::infinity();
  const auto next = std::bit_cast<float>(std::bit_cast<std::uint32_t>(a) + 1);
  return static_cast<double>(next) - static_cast<double>(a);
}

}  // namespace kaboum::geom
