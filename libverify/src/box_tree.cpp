// Building a binary tree of boxes: items are halved along the longest axis of their box.
#include "box_tree.h"

#include <algorithm>
#include <numeric>

namespace kaboum::verify {
namespace {
constexpr std::uint32_t kLeaf = 4;
}

BoxTree::BoxTree(std::vector<Bounds> boxes, std::vector<std::uint32_t> items) {
  if (items.empty()) return;
  const auto count = static_cast<std::uint32_t>(items.size());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(2 * (count / (kLeaf / 2) + 1));
  build(order, boxes, 0, count);
  boxes_.reserve(count);
  items_.reserve(count);
  for (const std::uint32_t i : order) {
    boxes_.push_back(boxes[i]);
    items_.push_back(items[i]);
  }
}

void BoxTree::build(std::vector<std::uint32_t>& order, const std::vector<Bounds>& boxes,
                    std::uint32_t first, std::uint32_t last) {
  const std::size_t index = nodes_.size();
  Bounds box = boxes[order[first]];
  for (std::uint32_t i = first + 1; i < last; ++i) box.include(boxes[order[i]]);
  nodes_.push_back({box, first, last - first});
  if (last - first <= kLeaf) return;

  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
  }
  const auto centre = [&](std::uint32_t i) {
    return 0.5 * boxes[i].low[axis] + 0.5 * boxes[i].high[axis];
  };
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(order.begin() + first, order.begin() + middle, order.begin() + last,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double x = centre(i), y = centre(j);
                     return x != y ? x < y : i < j;
                   });
  nodes_[index].count = 0;
  build(order, boxes, first, middle);
  nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
  build(order, boxes, middle, last);
}

std::vector<std::uint32_t> subtrees(const BoxTree& tree, std::size_t wanted) {
  std::vector<std::uint32_t> roots;
  if (tree.empty()) return roots;
  roots.push_back(0);
  while (2 * roots.size() <= wanted) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t i : roots) {
      const BoxTree::Node& node = tree.nodes()[i];
      if (node.count != 0) {
        next.push_back(i);
      } else {
        next.push_back(i + 1);
        next.push_back(node.first);
      }
    }
    if (next.size() == roots.size()) break;
    roots = std::move(next);
  }
  return roots;
}

}  // namespace kaboum::verify
