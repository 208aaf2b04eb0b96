// Segments and boxes in vectors of floats, compiled for each instruction set. Points of segments
// that are nearest: C. Ericson, Real-time collision detection, 2005, §5.1.9; boxes: S. Gottschalk,
// M. C. Lin, D. Manocha, OBBTree, 1996.

#include "closed_forms.h"

#include <cstdint>

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::collide::detail {
namespace {

/// Of sizes: holds all rounding errors below.
constexpr float kUnit = 0x1p-17F;

namespace baseline {
#define KABOUM_LANES 4
#include "closed_forms.inl"
#undef KABOUM_LANES
}  // namespace baseline

#ifdef KABOUM_AVX2
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#define KABOUM_LANES 8
#include "closed_forms.inl"
#undef KABOUM_LANES
}  // namespace avx2
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

Verdicts look(const Lanes& lanes, const Facing& body, [[maybe_unused]] bool wide) {
#ifdef KABOUM_AVX2
  if (wide) return avx2::look(lanes, body);
#endif
  return baseline::look(lanes, body);
}

}  // namespace kaboum::collide::detail
