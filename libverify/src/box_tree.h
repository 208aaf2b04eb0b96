#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::verify {

/// Axis-aligned box of exact minima and maxima.
struct Bounds {
  std::array<double, 3> low, high;

  void include(const Bounds& other) {
    for (int k = 0; k < 3; ++k) {
      low[k] = other.low[k] < low[k] ? other.low[k] : low[k];
      high[k] = other.high[k] > high[k] ? other.high[k] : high[k];
    }
  }
  [[nodiscard]] bool meets(const Bounds& other) const {
    // Six comparisons are less than a branch that is guessed wrong.
    return (static_cast<int>(low[0] <= other.high[0]) & static_cast<int>(other.low[0] <= high[0]) &
            static_cast<int>(low[1] <= other.high[1]) & static_cast<int>(other.low[1] <= high[1]) &
            static_cast<int>(low[2] <= other.high[2]) &
            static_cast<int>(other.low[2] <= high[2])) != 0;
  }
};

inline geom::Vec3 middle_of(const Bounds& box) {
  return 0.5 * geom::Vec3(box.low.data()) + 0.5 * geom::Vec3(box.high.data());
}

/// Length of a box's diagonal.
inline double diagonal_of(const Bounds& box) {
  return (geom::Vec3(box.high.data()) - geom::Vec3(box.low.data())).norm();
}

/// Adds the halves of a box, cut across its longest edge.
inline void halve(const Bounds& box, std::vector<Bounds>& into) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
  const double middle = 0.5 * box.low[axis] + 0.5 * box.high[axis];
  into.push_back(box);
  into.back().high[axis] = middle;
  into.push_back(box);
  into.back().low[axis] = middle;
}

/// Binary tree of boxes over items: nodes in depth-first order, left child next to its parent.
class BoxTree {
 public:
  /// 63 bits of a place on the curve, and 32 halvings where places are equal: what is small beside
  /// the extent of all has one place.
  static constexpr std::size_t kMostLevels = 96;

  struct Node {
    Bounds box;
    std::uint32_t first;  ///< leaf: place of its first item; inner: index of the right child
    std::uint32_t count;  ///< leaf: number of items (≥ 1); inner: 0
  };

  BoxTree() = default;
  /// `boxes[i]` belongs to the item `items[i]`.
  BoxTree(std::vector<Bounds> boxes, std::vector<std::uint32_t> items);
  /// The same for boxes whose middles are in the order of their places on a curve.
  BoxTree(std::vector<Bounds> boxes, std::vector<std::uint32_t> items,
          std::span<const std::uint64_t> places);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] std::uint32_t item(std::uint32_t place) const { return items_[place]; }
  [[nodiscard]] const Bounds& box(std::uint32_t place) const { return boxes_[place]; }

  /// Calls visit(item) for the items whose boxes satisfy `wanted`, in the tree's order. wanted(box)
  /// must hold for every box that contains one for which it holds.
  template <class Predicate, class Visit>
  void query(Predicate&& wanted, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kMostLevels + 2> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t index = stack[--size];
      const Node& node = nodes_[index];
      if (!wanted(node.box)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = index + 1;
      } else {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (wanted(boxes_[i])) visit(items_[i]);
        }
      }
    }
  }

 private:
  Bounds build(std::span<const std::uint64_t> places, std::uint32_t first, std::uint32_t last);

  /// Halves items that have one place on the curve, along the longest axis of their box.
  std::uint32_t halve(std::uint32_t first, std::uint32_t last);

  std::vector<Node> nodes_;
  std::vector<Bounds> boxes_;  // in the tree's order
  std::vector<std::uint32_t> items_;
};

/// Calls visit(item of a, item of b) for all pairs of items whose boxes meet and that lie below one
/// of the pairs of nodes on the stack.
template <class Visit>
void meeting_pairs(const BoxTree& a, const BoxTree& b,
                   std::vector<std::pair<std::uint32_t, std::uint32_t>>& stack, Visit&& visit) {
  const auto extent = [](const Bounds& box) {
    return (box.high[0] - box.low[0]) + (box.high[1] - box.low[1]) + (box.high[2] - box.low[2]);
  };
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const BoxTree::Node &x = a.nodes()[i], &y = b.nodes()[j];
    if (!x.box.meets(y.box)) continue;
    if (x.count != 0 && y.count != 0) {
      for (std::uint32_t p = x.first; p < x.first + x.count; ++p) {
        if (!a.box(p).meets(y.box)) continue;
        for (std::uint32_t q = y.first; q < y.first + y.count; ++q) {
          if (a.box(p).meets(b.box(q))) visit(a.item(p), b.item(q));
        }
      }
      continue;
    }
    if (y.count != 0 || (x.count == 0 && extent(x.box) >= extent(y.box))) {
      stack.emplace_back(x.first, j);
      stack.emplace_back(i + 1, j);
    } else {
      stack.emplace_back(i, y.first);
      stack.emplace_back(i, j + 1);
    }
  }
}

/// The same for all pairs of which the first lies below the node `root` of a's tree.
template <class Visit>
void meeting_pairs(const BoxTree& a, std::uint32_t root, const BoxTree& b, Visit&& visit) {
  if (a.empty() || b.empty()) return;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{root, 0}};
  meeting_pairs(a, b, stack, visit);
}

/// Calls visit(first, second) for all pairs of one tree's items whose boxes meet, the first of
/// which lies below the node `root` and the second after it in the tree's order.
template <class Visit>
void meeting_pairs_within(const BoxTree& tree, std::uint32_t root, Visit&& visit) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;
  std::vector<std::uint32_t> own{root};  // nodes whose items are compared with each other
  for (std::uint32_t above = 0; above != root;) {
    const std::uint32_t right = tree.nodes()[above].first;
    if (root < right) stack.emplace_back(root, right);
    above = root < right ? above + 1 : right;
  }
  meeting_pairs(tree, tree, stack, visit);
  while (!own.empty()) {
    const std::uint32_t i = own.back();
    own.pop_back();
    const BoxTree::Node& x = tree.nodes()[i];
    if (x.count == 0) {
      own.push_back(x.first);
      own.push_back(i + 1);
      stack.emplace_back(i + 1, x.first);
      meeting_pairs(tree, tree, stack, visit);
      continue;
    }
    for (std::uint32_t p = x.first; p < x.first + x.count; ++p) {
      for (std::uint32_t q = p + 1; q < x.first + x.count; ++q) {
        if (tree.box(p).meets(tree.box(q))) visit(tree.item(p), tree.item(q));
      }
    }
  }
}

/// Roots of at most `wanted` disjoint subtrees that together hold all items.
std::vector<std::uint32_t> subtrees(const BoxTree& tree, std::size_t wanted);

}  // namespace kaboum::verify
