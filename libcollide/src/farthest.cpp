// The largest of many products in floats, as wide as the processor is.

#include "farthest.h"

#include <cstring>
#include <limits>

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::collide::detail {
namespace {

constexpr std::size_t kStride = 3 * kFloatsAtOnce;

/// Two vectors of four: what every processor has.
Farthest farthest_by_fours(std::span<const float> points, const std::array<float, 3>& d) {
  using Floats [[gnu::vector_size(16)]] = float;
  using Ints [[gnu::vector_size(16)]] = std::int32_t;
  const auto four = [](const float* at) {
    Floats out;
    std::memcpy(&out, at, sizeof out);
    return out;
  };
  constexpr float kLeast = -std::numeric_limits<float>::infinity();
  Floats best{kLeast, kLeast, kLeast, kLeast}, other = best;
  Ints index{0, 1, 2, 3}, best_index = index, other_index = index + 4;
  const float* end = points.data() + points.size();
  for (const float* at = points.data(); at != end; at += kStride, index += 8) {
    const Floats along = d[0] * four(at) + d[1] * four(at + 8) + d[2] * four(at + 16);
    const Floats next = d[0] * four(at + 4) + d[1] * four(at + 12) + d[2] * four(at + 20);
    const Ints farther = along > best, next_farther = next > other;
    best = farther ? along : best;
    best_index = farther ? index : best_index;
    other = next_farther ? next : other;
    other_index = next_farther ? index + 4 : other_index;
  }
  const Ints farther = other > best;
  best = farther ? other : best;
  best_index = farther ? other_index : best_index;
  int lane = 0;
  for (int k = 1; k < 4; ++k)
    if (best[k] > best[lane]) lane = k;
  return {static_cast<std::uint32_t>(best_index[lane]), best[lane]};
}

#ifdef KABOUM_AVX2
/// The same products, eight at a time.
[[gnu::target("avx2"), gnu::always_inline]] inline Farthest farthest_by_eights(
    std::span<const float> points, const std::array<float, 3>& d) {
  const __m256 dx = _mm256_set1_ps(d[0]), dy = _mm256_set1_ps(d[1]), dz = _mm256_set1_ps(d[2]);
  __m256 best = _mm256_set1_ps(-std::numeric_limits<float>::infinity());
  __m256i index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), best_index = index;
  const __m256i eight = _mm256_set1_epi32(8);
  const float* end = points.data() + points.size();
  for (const float* at = points.data(); at != end; at += kStride) {
    const __m256 along = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(dx, _mm256_loadu_ps(at)),
                                                     _mm256_mul_ps(dy, _mm256_loadu_ps(at + 8))),
                                       _mm256_mul_ps(dz, _mm256_loadu_ps(at + 16)));
    const __m256 farther = _mm256_cmp_ps(along, best, _CMP_GT_OQ);
    best = _mm256_blendv_ps(best, along, farther);
    best_index = _mm256_blendv_epi8(best_index, index, _mm256_castps_si256(farther));
    index = _mm256_add_epi32(index, eight);
  }
  // The largest everywhere, then where it is.
  __m256 most = _mm256_max_ps(best, _mm256_permute2f128_ps(best, best, 1));
  most = _mm256_max_ps(most, _mm256_permute_ps(most, 0b01'00'11'10));
  most = _mm256_max_ps(most, _mm256_permute_ps(most, 0b10'11'00'01));
  const auto lanes =
      static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(best, most, _CMP_EQ_OQ)));
  const __m256i lane = _mm256_set1_epi32(lanes == 0 ? 0 : __builtin_ctz(lanes));
  const int at =
      _mm_cvtsi128_si32(_mm256_castsi256_si128(_mm256_permutevar8x32_epi32(best_index, lane)));
  return {static_cast<std::uint32_t>(at), _mm256_cvtss_f32(most)};
}

[[gnu::target("avx2")]] FarthestPair pair_by_eights(std::span<const float> a,
                                                    const std::array<float, 3>& along_a,
                                                    std::span<const float> b,
                                                    const std::array<float, 3>& along_b) {
  return {farthest_by_eights(a, along_a), farthest_by_eights(b, along_b)};
}
#endif

}  // namespace

FarthestPair farthest_of(std::span<const float> a, const std::array<float, 3>& along_a,
                         std::span<const float> b, const std::array<float, 3>& along_b,
                         [[maybe_unused]] bool wide) {
#ifdef KABOUM_AVX2
  if (wide) return pair_by_eights(a, along_a, b, along_b);
#endif
  return {farthest_by_fours(a, along_a), farthest_by_fours(b, along_b)};
}

}  // namespace kaboum::collide::detail
