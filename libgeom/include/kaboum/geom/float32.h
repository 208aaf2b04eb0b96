#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::geom {

/// The float32 number nearest to x, as a double. Infinite when |x| exceeds the largest float32.
///
/// Kept out of line: GCC 12 to 13 drop the conversion double → float → double when they vectorise
/// two of them in straight-line code (-O2 and up), and then numbers pass for float32 that are not.
double to_float32(double x);
Vec3 to_float32(const Vec3& p);

/// True if float32 holds x exactly.
inline bool is_float32(double x) { return to_float32(x) == x; }
bool is_float32(const Vec3& p);

/// Distance from |x| to the next larger float32 number; infinite beyond float32's range.
double float32_spacing(double x);

}  // namespace kaboum::geom
