#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Bounding-volume hierarchy over the triangles of a mesh: a binary tree of axis-aligned boxes,
/// nodes in depth-first order, left child next to its parent. Boxes are exact (minima and maxima of
/// coordinates, no arithmetic; of_parts: those of parts are widened by more than their corners are
/// rounded), so a query that tests boxes exactly misses nothing.
class Bvh {
 public:
  struct Node {
    Box3 box;
    std::uint32_t first;  ///< leaf: first entry of order(); inner: index of the right child
    std::uint32_t count;  ///< leaf: number of triangles (≥ 1); inner: 0
    [[nodiscard]] bool leaf() const { return count != 0; }
  };

  Bvh() = default;
  /// Splits at the median of the centroids along the longest axis: O(n log n), deterministic.
  /// @pre indices in range, coordinates finite.
  explicit Bvh(const Mesh& mesh);
  /// The same, but triangles that lie slantwise in boxes much larger than themselves, as needles do
  /// round the tip of a cone, are cut into parts first: these are in several leaves then, where
  /// boxes hold parts of them. For searches that may look at a triangle more than once.
  static Bvh of_parts(const Mesh& mesh);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  /// Triangle indices, grouped by leaf; of_parts: some several times.
  [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

  /// Calls visit(triangle) for every triangle of each leaf whose box, and whose ancestors' boxes,
  /// satisfy descend(box).
  template <class Descend, class Visit>
  void traverse(Descend&& descend, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[kMaxDepth];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t index = stack[--size];
      const Node& node = nodes_[index];
      if (!descend(node.box)) continue;
      if (node.leaf()) {
        for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
      } else {
        stack[size++] = node.first;
        stack[size++] = index + 1;
      }
    }
  }

  /// Bound of the tree's depth: median splits halve 2^32 triangles at most 32 times.
  static constexpr int kMaxDepth = 64;

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace kaboum::geom
