#include <kaboum/geom/spatial_order.h>

#include <algorithm>
#include <array>

namespace kaboum::geom {
namespace {

/// The bits of a 10-bit number, two zeros between each.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000ffU;
  x = (x | x << 8) & 0x0300f00fU;
  x = (x | x << 4) & 0x030c30c3U;
  return (x | x << 2) & 0x09249249U;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const Mesh& mesh) {
  struct Item {
    std::uint32_t key, triangle;
  };
  const Box3 box = bounding_box(mesh);
  const Vec3 scale = (box.max - box.min).unaryExpr([](double extent) {
    return extent > 0 ? 1023.99 / extent : 0.0;
  });
  std::vector<Item> items(mesh.triangles.size()), sorted(items.size());
  for (std::uint32_t t = 0; t < items.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Vec3 middle = (0.5 * a.cwiseMin(b).cwiseMin(c) + 0.5 * a.cwiseMax(b).cwiseMax(c));
    std::uint32_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::clamp((middle[axis] - box.min[axis]) * scale[axis], 0.0, 1023.0);
      key |= spread(static_cast<std::uint32_t>(cell)) << axis;
    }
    items[t] = {key, t};
  }
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<std::uint32_t, 1025> start{};
    for (const Item& item : items) ++start[(item.key >> shift & 1023U) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const Item& item : items) sorted[start[item.key >> shift & 1023U]++] = item;
    items.swap(sorted);
  }
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].triangle;
  return order;
}

}  // namespace kaboum::geom
