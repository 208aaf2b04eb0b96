#include "solid.h"

#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

constexpr float kUnset = std::numeric_limits<float>::infinity();

}  // namespace

Solid::Solid(const Mesh& mesh, std::size_t nodes)
    : mesh_(mesh),
      box_(geom::bounding_box(mesh)),
      diagonal_(box_.diagonal()),
      surface_(mesh),
      winding_(mesh) {
  const Vec3 size = (box_.max - box_.min).cwiseMax(0.02 * diagonal_);
  spacing_ = std::cbrt(size.prod() / static_cast<double>(nodes));
  origin_ = box_.center() - 0.5 * size - Vec3::Constant(1.5 * spacing_);
  std::size_t total = 1;
  for (int k = 0; k < 3; ++k) {
    size_[k] = static_cast<int>(std::ceil(size[k] / spacing_)) + 4;
    total *= static_cast<std::size_t>(size_[k]);
  }
  value_ = std::make_unique<std::atomic<float>[]>(total);
  for (std::size_t i = 0; i < total; ++i) value_[i].store(kUnset, std::memory_order_relaxed);
}

bool Solid::contains(const Vec3& p) const {
  const auto w = winding_(p);
  return !w || *w >= 1;
}

float Solid::node(int x, int y, int z) const {
  const std::array<int, 3> at{x, y, z};
  const std::array<std::size_t, 3> step{
      1, static_cast<std::size_t>(size_[0]),
      static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1])};
  std::size_t index = 0;
  for (int k = 0; k < 3; ++k) index += static_cast<std::size_t>(at[k]) * step[k];
  const float known = value_[index].load(std::memory_order_relaxed);
  if (known != kUnset) return known;
  const Vec3 p = origin_ + spacing_ * Vec3(x, y, z);
  const double distance = surface_.nearest(p).upper;
  // A neighbour whose distance exceeds the way to here is on the same side.
  int side = 0;
  for (int k = 0; k < 3 && side == 0; ++k) {
    for (const int s : {-1, 1}) {
      if (at[k] + s < 0 || at[k] + s >= size_[k]) continue;
      const float v =
          value_[s < 0 ? index - step[k] : index + step[k]].load(std::memory_order_relaxed);
      if (v == kUnset || std::abs(v) <= 1.001 * spacing_) continue;
      side = v < 0 ? -1 : 1;
      break;
    }
  }
  if (side == 0) side = contains(p) ? -1 : 1;
  const auto value = static_cast<float>(side * distance);
  value_[index].store(value, std::memory_order_relaxed);
  computed_.fetch_add(1, std::memory_order_relaxed);
  return value;
}

double Solid::field(const Vec3& p) const {
  std::array<int, 3> cell{};
  Vec3 f;
  for (int k = 0; k < 3; ++k) {
    const double x = std::clamp((p[k] - origin_[k]) / spacing_, 0.0, size_[k] - 1.001);
    cell[k] = static_cast<int>(x);
    f[k] = x - cell[k];
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = (c >> 1) & 1, k = c >> 2;
    const double weight =
        (i != 0 ? f.x() : 1 - f.x()) * (j != 0 ? f.y() : 1 - f.y()) * (k != 0 ? f.z() : 1 - f.z());
    if (weight > 0) sum += weight * node(cell[0] + i, cell[1] + j, cell[2] + k);
  }
  return sum;
}

}  // namespace kaboum::bcd
