// Many boxes against one, as many at a time as the processor can.

#include "meeting.h"

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::collide::detail {
namespace {

std::uint64_t by_ones(const BoxRows& rows, std::size_t from, std::size_t count,
                      const FloatBox& box) {
  std::uint64_t out = 0;
  for (std::size_t j = 0; j < count; ++j) {
    bool meet = true;
    for (std::size_t k = 0; k < 3; ++k)
      meet = meet && rows.high[k][from + j] >= box.low[k] && rows.low[k][from + j] <= box.high[k];
    if (meet) out |= std::uint64_t{1} << j;
  }
  return out;
}

#ifdef KABOUM_AVX2
[[gnu::target("avx2")]] std::uint64_t by_eights(const float* const* lows, const float* const* highs,
                                                std::size_t from, std::size_t count,
                                                const FloatBox& box) {
  __m256 least[3], most[3];
  for (int k = 0; k < 3; ++k) {
    least[k] = _mm256_set1_ps(box.low[k]);
    most[k] = _mm256_set1_ps(box.high[k]);
  }
  std::uint64_t out = 0;
  for (std::size_t j = 0; j < count; j += kBoxesAtOnce) {
    const std::size_t at = from + j;
    __m256 meet = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
    for (int k = 0; k < 3; ++k) {
      const __m256 high = _mm256_loadu_ps(highs[k] + at), low = _mm256_loadu_ps(lows[k] + at);
      meet = _mm256_and_ps(meet, _mm256_cmp_ps(high, least[k], _CMP_GE_OQ));
      meet = _mm256_and_ps(meet, _mm256_cmp_ps(low, most[k], _CMP_LE_OQ));
    }
    out |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm256_movemask_ps(meet))) << j;
  }
  return count < 64 ? out & ((std::uint64_t{1} << count) - 1) : out;
}
#endif

}  // namespace

std::uint64_t meeting_boxes(const BoxRows& rows, std::size_t from, std::size_t count,
                            const FloatBox& box, [[maybe_unused]] bool wide) {
#ifdef KABOUM_AVX2
  if (wide) return by_eights(rows.low.data(), rows.high.data(), from, count, box);
#endif
  return by_ones(rows, from, count, box);
}

}  // namespace kaboum::collide::detail
