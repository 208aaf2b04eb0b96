// Balls against one of them, as many at once as the processor's vectors hold.

#include "balls.h"

#include <algorithm>

#ifdef KABOUM_AVX2
#include <immintrin.h>
#endif

namespace kaboum::world::detail {
namespace {

/// Coordinates and radii of balls, from some number on.
struct Rows {
  const float *x, *y, *z, *radius;
};

/// Bits of eight balls: 0 where they are apart from ball i of `all`.
std::uint64_t near_of_eight(const Rows& all, std::size_t i, std::size_t j) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const float dx = all.x[j + k] - all.x[i], dy = all.y[j + k] - all.y[i],
                dz = all.z[j + k] - all.z[i], sum = all.radius[j + k] + all.radius[i];
    const bool apart = dx * dx + dy * dy + dz * dz > sum * sum;
    out |= static_cast<std::uint64_t>(!apart) << k;
  }
  return out;
}

/// Of the balls from `first` to `end`, numbers that eight divides.
void look(const Rows& all, std::size_t i, std::size_t first, std::size_t end, std::uint64_t* near) {
  for (std::size_t j = first; j < end; j += 8)
    near[j / 64] = (j % 64 == 0 || j == first ? 0 : near[j / 64]) | near_of_eight(all, i, j)
                                                                        << (j % 64);
}

#ifdef KABOUM_AVX2
/// The same, in the same arithmetic.
[[gnu::target("avx2")]] void look_by_eights(const Rows& all, std::size_t i, std::size_t first,
                                            std::size_t end, std::uint64_t* near) {
  const __m256 x = _mm256_set1_ps(all.x[i]), y = _mm256_set1_ps(all.y[i]),
               z = _mm256_set1_ps(all.z[i]), radius = _mm256_set1_ps(all.radius[i]);
  for (std::size_t j = first; j < end;) {
    std::uint64_t& word = near[j / 64];
    const std::size_t end_of_word = std::min(end, (j / 64 + 1) * 64);
    std::uint64_t bits = 0;
    for (std::size_t shift = j % 64; j < end_of_word; j += 8, shift += 8) {
      const __m256 dx = _mm256_sub_ps(_mm256_loadu_ps(all.x + j), x),
                   dy = _mm256_sub_ps(_mm256_loadu_ps(all.y + j), y),
                   dz = _mm256_sub_ps(_mm256_loadu_ps(all.z + j), z),
                   sum = _mm256_add_ps(_mm256_loadu_ps(all.radius + j), radius);
      const __m256 square = _mm256_add_ps(
          _mm256_add_ps(_mm256_mul_ps(dx, dx), _mm256_mul_ps(dy, dy)), _mm256_mul_ps(dz, dz));
      const __m256 close = _mm256_cmp_ps(square, _mm256_mul_ps(sum, sum), _CMP_NGT_UQ);
      bits |= static_cast<std::uint64_t>(_mm256_movemask_ps(close)) << shift;
    }
    word = bits;
  }
}
#endif

}  // namespace

Balls::Balls(std::size_t count) : near_((count + 63) / 64) {
  const std::size_t eights = (count + 7) / 8 * 8;
  for (std::vector<float>* of_balls : {&x_, &y_, &z_, &radius_}) of_balls->assign(eights, 0);
}

const std::uint64_t* Balls::look_from(std::size_t i, [[maybe_unused]] bool wide) {
  const Rows all{x_.data(), y_.data(), z_.data(), radius_.data()};
  const std::size_t first = (i + 1) & ~std::size_t{7};
#ifdef KABOUM_AVX2
  if (wide) {
    look_by_eights(all, i, first, x_.size(), near_.data());
    return near_.data();
  }
#endif
  look(all, i, first, x_.size(), near_.data());
  return near_.data();
}

}  // namespace kaboum::world::detail
