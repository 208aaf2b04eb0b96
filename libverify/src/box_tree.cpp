// Building a binary tree of boxes along a curve through their middles.
#include "box_tree.h"

#include <algorithm>
#include <bit>

#include "curve.h"

namespace kaboum::verify {
namespace {
constexpr std::uint32_t kLeaf = 4;

/// Where the highest bit in which places differ changes. @pre the first and the last one do
std::uint32_t cut_of(std::span<const std::uint64_t> places, std::uint32_t first,
                     std::uint32_t last) {
  const std::uint64_t bit = std::bit_floor(places[first] ^ places[last - 1]);
  const auto begin = places.begin() + first, end = places.begin() + last;
  return static_cast<std::uint32_t>(
      std::partition_point(begin, end, [&](std::uint64_t p) { return (p & bit) == 0; }) -
      places.begin());
}
}  // namespace

BoxTree::BoxTree(std::vector<Bounds> boxes, std::vector<std::uint32_t> items) {
  std::vector<geom::Vec3> middles;
  middles.reserve(boxes.size());
  for (const Bounds& box : boxes) middles.push_back(middle_of(box));
  const std::vector<std::uint64_t> places = places_on_curve(middles);
  std::vector<std::uint64_t> sorted;
  sorted.reserve(places.size());
  boxes_.reserve(boxes.size());
  items_.reserve(boxes.size());
  for (const std::uint32_t i : ordered_by(places)) {
    sorted.push_back(places[i]);
    boxes_.push_back(boxes[i]);
    items_.push_back(items[i]);
  }
  *this = BoxTree(std::move(boxes_), std::move(items_), sorted);
}

BoxTree::BoxTree(std::vector<Bounds> boxes, std::vector<std::uint32_t> items,
                 std::span<const std::uint64_t> places)
    : boxes_(std::move(boxes)), items_(std::move(items)) {
  if (items_.empty()) return;
  nodes_.reserve(items_.size());
  build(places, 0, static_cast<std::uint32_t>(items_.size()));
}

Bounds BoxTree::build(std::span<const std::uint64_t> places, std::uint32_t first,
                      std::uint32_t last) {
  const std::size_t index = nodes_.size();
  nodes_.push_back({boxes_[first], first, last - first});
  Bounds box = boxes_[first];
  if (last - first <= kLeaf) {
    for (std::uint32_t i = first + 1; i < last; ++i) box.include(boxes_[i]);
  } else {
    const std::uint32_t middle =
        places[first] == places[last - 1] ? halve(first, last) : cut_of(places, first, last);
    box = build(places, first, middle);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].count = 0;
    box.include(build(places, middle, last));
  }
  nodes_[index].box = box;
  return box;
}

std::uint32_t BoxTree::halve(std::uint32_t first, std::uint32_t last) {
  struct Entry {
    Bounds box;
    std::uint32_t item;
  };
  std::vector<Entry> run;
  run.reserve(last - first);
  Bounds all = boxes_[first];
  for (std::uint32_t i = first; i < last; ++i) {
    run.push_back({boxes_[i], items_[i]});
    all.include(boxes_[i]);
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (all.high[k] - all.low[k] > all.high[axis] - all.low[axis]) axis = k;
  const std::uint32_t half = (last - first) / 2;
  std::nth_element(run.begin(), run.begin() + half, run.end(), [&](const Entry& a, const Entry& b) {
    const double x = middle_of(a.box)[axis], y = middle_of(b.box)[axis];
    return x != y ? x < y : a.item < b.item;
  });
  for (std::uint32_t i = first; i < last; ++i) {
    boxes_[i] = run[i - first].box;
    items_[i] = run[i - first].item;
  }
  return first + half;
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
