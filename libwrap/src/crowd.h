#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <vector>

#include "separation.h"

namespace kaboum::wrap {

/// Boxes of triangles that change, in a hierarchy: boxes of nodes only grow, until it is built
/// anew.
class Crowd {
 public:
  /// Builds the hierarchy, of those triangles for which in_use is not 0.
  void build(const std::vector<geom::Vec3>& points, const std::vector<geom::Triangle>& triangles,
             const std::vector<char>& in_use);

  /// A triangle of the hierarchy has another box now.
  void grow(std::uint32_t triangle, const geom::Box3& box);
  /// A new triangle, near one that is in the hierarchy.
  void add(std::uint32_t triangle, std::uint32_t near, const geom::Box3& box);
  /// Whether so much was changed that it should be built anew.
  [[nodiscard]] bool stale() const { return changes_ > 2 * built_; }

  /// A triangle of the hierarchy is no more.
  void remove(std::uint32_t triangle) { entries_[entry_[triangle]].box = {}; }

  /// Calls visit(triangle), for triangles whose boxes overlap `box`, until it returns false.
  /// @return whether it never did
  template <class Visit>
  bool all_near(const geom::Box3& box, Visit&& visit) const {
    if (nodes_.empty()) return true;
    std::uint32_t stack[geom::Bvh::kMaxDepth];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::uint32_t index = stack[--size];
      const Node& node = nodes_[index];
      if (!overlap(node.box, box)) continue;
      if (node.right != 0) {
        stack[size++] = node.right;
        stack[size++] = index + 1;
        continue;
      }
      for (std::uint32_t e = node.first; e < node.end; ++e)
        if (overlap(entries_[e].box, box) && !visit(entries_[e].triangle)) return false;
      for (std::uint32_t e = node.added; e != kNone; e = entries_[e].next)
        if (overlap(entries_[e].box, box) && !visit(entries_[e].triangle)) return false;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Node {
    geom::Box3 box;
    std::uint32_t parent = kNone;
    std::uint32_t right = 0;           ///< 0: a leaf
    std::uint32_t first = 0, end = 0;  ///< leaf: entries
    std::uint32_t added = kNone;       ///< leaf: one more, which names the next
  };
  struct Entry {
    geom::Box3 box;
    std::uint32_t triangle, next = kNone;
  };
  void enlarge(std::uint32_t node, const geom::Box3& box);

  std::vector<Node> nodes_;
  std::vector<Entry> entries_;               ///< those of a leaf side by side
  std::vector<std::uint32_t> leaf_, entry_;  ///< per triangle
  std::size_t built_ = 0, changes_ = 0;
};

}  // namespace kaboum::wrap
