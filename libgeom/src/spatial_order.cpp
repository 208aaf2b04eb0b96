// Points and triangles in their order along a space-filling curve, so that neighbours in memory
// are near each other in space.

#include <kaboum/base/parallel.h>
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

struct Item {
  std::uint32_t key, index;
};

/// Place on the curve, for coordinates in [0, 1024) as far as they are inside the grid.
std::uint32_t key_of(const Vec3& cell) {
  std::uint32_t key = 0;
  for (int axis = 0; axis < 3; ++axis)
    key |= spread(static_cast<std::uint32_t>(std::clamp(cell[axis], 0.0, 1023.0))) << axis;
  return key;
}

/// By key; equal ones in the order given.
std::vector<std::uint32_t> sorted(std::vector<Item> items) {
  std::vector<Item> other(items.size());
  for (int shift = 0; shift < 30; shift += 10) {
    std::array<std::uint32_t, 1025> start{};
    for (const Item& item : items) ++start[(item.key >> shift & 1023U) + 1];
    for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
    for (const Item& item : items) other[start[item.key >> shift & 1023U]++] = item;
    items.swap(other);
  }
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = items[i].index;
  return order;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const Mesh& mesh) {
  const Box3 box = bounding_box(mesh);
  const Vec3 scale = (box.max - box.min).unaryExpr([](double extent) {
    return extent > 0 ? 1023.99 / extent : 0.0;
  });
  std::vector<Item> items(mesh.triangles.size());
  for (std::uint32_t t = 0; t < items.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Vec3 middle = (0.5 * a.cwiseMin(b).cwiseMin(c) + 0.5 * a.cwiseMax(b).cwiseMax(c));
    items[t] = {key_of((middle - box.min).cwiseProduct(scale)), t};
  }
  return sorted(std::move(items));
}

std::vector<std::uint32_t> spatial_order(std::span<const Vec3> points, double shift) {
  Box3 box;
  for (const Vec3& p : points) box.extend(p);
  const double extent = points.empty() ? 0.0 : (box.max - box.min).maxCoeff();
  const double scale = extent > 0 ? 511.99 / extent : 0.0;  // the grid is twice as large
  std::vector<Item> items(points.size());
  parallel_for_light(items.size(), [&](std::size_t i) {
    items[i] = {key_of(((points[i] - box.min).array() + shift * extent).matrix() * scale),
                static_cast<std::uint32_t>(i)};
  });
  return sorted(std::move(items));
}

}  // namespace kaboum::geom
