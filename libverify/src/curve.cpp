// Morton's curve: the bits of the three coordinates in turn.
#include "curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace kaboum::verify {
namespace {

constexpr unsigned kBits = 21;  // of each coordinate

/// Each bit of x to every third place.
std::uint64_t spread(std::uint64_t x) {
  x = (x | (x << 32U)) & 0x001F00000000FFFFU;
  x = (x | (x << 16U)) & 0x001F0000FF0000FFU;
  x = (x | (x << 8U)) & 0x100F00F00F00F00FU;
  x = (x | (x << 4U)) & 0x10C30C30C30C30C3U;
  return (x | (x << 2U)) & 0x1249249249249249U;
}

}  // namespace

std::vector<std::uint64_t> places_on_curve(std::span<const geom::Vec3> points) {
  std::vector<std::uint64_t> places(points.size(), 0);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  geom::Vec3 low = geom::Vec3::Constant(kInfinity), high = -low;
  for (const geom::Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double kLast = (1U << kBits) - 1;
  const double scale = kLast / (high - low).maxCoeff();
  if (!std::isfinite(scale) || !(scale > 0)) return places;  // one place for all
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      const double x = std::clamp((points[i][k] - low[k]) * scale, 0.0, kLast);
      places[i] |= spread(static_cast<std::uint64_t>(x)) << k;
    }
  }
  return places;
}

std::vector<std::uint32_t> ordered_by(std::span<const std::uint64_t> places) {
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0U);
  if (std::is_sorted(places.begin(), places.end())) return order;
  constexpr std::size_t kFew = 256;
  if (places.size() < kFew) {
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return places[a] < places[b]; });
    return order;
  }
  struct Keyed {
    std::uint64_t key;
    std::uint32_t number;
  };
  constexpr unsigned kDigit = 11, kDigits = 6;
  constexpr std::uint64_t kMask = (1U << kDigit) - 1;
  std::array<std::array<std::uint32_t, kMask + 1>, kDigits> first{};
  std::vector<Keyed> from(places.size()), to(places.size());
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    from[i] = {places[i], i};
    for (unsigned d = 0; d < kDigits; ++d) ++first[d][(places[i] >> (kDigit * d)) & kMask];
  }
  for (unsigned d = 0; d < kDigits; ++d) {
    std::uint32_t sum = 0;
    for (std::uint32_t& count : first[d]) sum += std::exchange(count, sum);
    for (const Keyed& k : from) to[first[d][(k.key >> (kDigit * d)) & kMask]++] = k;
    std::swap(from, to);
  }
  for (std::size_t i = 0; i < from.size(); ++i) order[i] = from[i].number;
  return order;
}

}  // namespace kaboum::verify
