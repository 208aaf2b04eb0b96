// Building a hierarchy of boxes: items are halved at the median of their centres, along the longest
// axis.
#include <kaboum/base/parallel.h>
#include <kaboum/geom/bvh.h>

#include <algorithm>
#include <utility>

#include "slanted.h"

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kLeafSize = 4;

struct Item {
  Vec3 center;
  std::uint32_t index;
};

/// Nodes of a tree over n triangles, and over n + 1.
std::pair<std::uint32_t, std::uint32_t> nodes_of(std::uint32_t n) {
  if (n < kLeafSize) return {1, 1};
  if (n == kLeafSize) return {1, 3};
  const auto [half, more] = nodes_of(n / 2);
  if (n % 2 == 0) return {1 + 2 * half, 1 + half + more};
  return {1 + half + more, 1 + 2 * more};
}

/// @tparam BoxOf  of what an item's index stands for.
template <class BoxOf>
struct Builder {
  const BoxOf& box_of;
  std::vector<Item>& items;
  std::vector<Bvh::Node>& nodes;

  void build(std::uint32_t self, std::uint32_t begin, std::uint32_t end) {
    Bvh::Node& node = nodes[self];
    if (end - begin <= kLeafSize) {
      node.first = begin;
      node.count = end - begin;
      for (std::uint32_t i = begin; i < end; ++i) node.box.extend(box_of(items[i].index));
      return;
    }
    Box3 centers;
    for (std::uint32_t i = begin; i < end; ++i) centers.extend(items[i].center);
    int axis = 0;
    (centers.max - centers.min).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(items.begin() + begin, items.begin() + middle, items.begin() + end,
                     [axis](const Item& a, const Item& b) {
                       const double ca = a.center[axis], cb = b.center[axis];
                       return ca < cb || (ca == cb && a.index < b.index);
                     });
    const std::uint32_t left = self + 1, right = left + nodes_of(middle - begin).first;
    constexpr std::uint32_t kLarge = 4096;
    if (end - begin > kLarge) {
      parallel_invoke([&] { build(left, begin, middle); }, [&] { build(right, middle, end); });
    } else {
      build(left, begin, middle);
      build(right, middle, end);
    }
    node.first = right;
    node.count = 0;
    node.box = nodes[left].box;
    node.box.extend(nodes[right].box);
  }
};

/// The tree over n boxes; order[i] is the index of the i-th box in the leaves.
template <class BoxOf>
void build(std::uint32_t n, const BoxOf& box_of, std::vector<Bvh::Node>& nodes,
           std::vector<std::uint32_t>& order) {
  if (n == 0) return;
  std::vector<Item> items(n);
  for (std::uint32_t i = 0; i < n; ++i) items[i] = {box_of(i).center(), i};
  nodes.resize(nodes_of(n).first);
  Builder<BoxOf>{box_of, items, nodes}.build(0, 0, n);
  order.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) order[i] = items[i].index;
}

}  // namespace

Bvh::Bvh(const Mesh& mesh) {
  const auto box_of = [&](std::uint32_t i) {
    Box3 box;
    for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.vertices[v]);
    return box;
  };
  build(static_cast<std::uint32_t>(mesh.triangles.size()), box_of, nodes_, order_);
}

Bvh Bvh::of_parts(const Mesh& mesh) {
  const std::vector<BoxedPiece> parts = cut_slanted(mesh);
  if (parts.empty()) return Bvh(mesh);
  Bvh out;
  build(
      static_cast<std::uint32_t>(parts.size()), [&](std::uint32_t i) { return parts[i].box; },
      out.nodes_, out.order_);
  for (std::uint32_t& i : out.order_) i = parts[i].triangle;
  return out;
}

}  // namespace kaboum::geom
