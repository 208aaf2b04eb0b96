// Many boxes against one, as many at a time as the processor can.

#include "meeting.h"

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::collide::detail {
namespace {

/// Of boxes from + first on.
std::uint64_t by_ones(const BoxRows& rows, std::size_t from, std::size_t first, std::size_t count,
                      const geom::Box3& box) {
  std::uint64_t out = 0;
  for (std::size_t j = first; j < count; ++j) {
    bool meet = true;
    for (std::size_t k = 0; k < 3; ++k)
      meet = meet && rows.high[k][from + j] >= box.min[static_cast<int>(k)] &&
             rows.low[k][from + j] <= box.max[static_cast<int>(k)];
    if (meet) out |= std::uint64_t{1} << j;
  }
  return out;
}

#ifdef KABOUM_AVX2
[[gnu::target("avx2")]] std::uint64_t by_fours(const BoxRows& rows, std::size_t from,
                                               std::size_t count, const geom::Box3& box) {
  __m256d least[3], most[3];
  for (int k = 0; k < 3; ++k) {
    least[k] = _mm256_set1_pd(box.min[k]);
    most[k] = _mm256_set1_pd(box.max[k]);
  }
  std::uint64_t out = 0;
  std::size_t j = 0;
  for (; j + 4 <= count; j += 4) {
    const std::size_t at = from + j;
    __m256d meet = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    for (int k = 0; k < 3; ++k) {
      const __m256d high = _mm256_loadu_pd(rows.high[k] + at),
                    low = _mm256_loadu_pd(rows.low[k] + at);
      meet = _mm256_and_pd(meet, _mm256_cmp_pd(high, least[k], _CMP_GE_OQ));
      meet = _mm256_and_pd(meet, _mm256_cmp_pd(low, most[k], _CMP_LE_OQ));
    }
    out |= static_cast<std::uint64_t>(_mm256_movemask_pd(meet)) << j;
  }
  return out | by_ones(rows, from, j, count, box);
}
#endif

}  // namespace

std::uint64_t meeting_boxes(const BoxRows& rows, std::size_t from, std::size_t count,
                            const geom::Box3& box, [[maybe_unused]] bool wide) {
#ifdef KABOUM_AVX2
  if (wide) return by_fours(rows, from, count, box);
#endif
  return by_ones(rows, from, 0, count, box);
}

}  // namespace kaboum::collide::detail
