#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::bcd {

/// Points in a tree of boxes, in their order: neighbours in it should be near each other. Whole
/// boxes are left out that are on one side of a plane.
class PointTree {
 public:
  /// @param points  kept by reference.
  explicit PointTree(std::span<const geom::Vec3> points);

  /// An order of points in which neighbours are near each other.
  static std::vector<geom::Vec3> ordered(std::span<const geom::Vec3> points);

  /// Calls visit(p), in the points' order, for all with n·p > d, and some others; before each box,
  /// plane() tells n and d anew. Ends where visit returns false.
  template <class CurrentPlane, class Visit>
  void visit_above(CurrentPlane&& plane, Visit&& visit) const {
    for (std::size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      const auto& [n, d] = plane();
      if (n.dot(node.center) + n.cwiseAbs().dot(node.half) <= d) {
        i = node.next;
        continue;
      }
      ++i;
      if (node.next != i) continue;
      for (std::uint32_t k = node.first; k < node.last; ++k)
        if (!visit(points_[k])) return;
    }
  }

  /// Whether a point has n·p > d.
  [[nodiscard]] bool any_above(const geom::Vec3& n, double d) const;

 private:
  /// In depth-first order; a leaf's `next` is the node after it.
  struct Node {
    geom::Vec3 center, half;
    std::uint32_t first, last;  ///< of the points
    std::uint32_t next;         ///< the node after all that are below this one
  };
  geom::Box3 add(std::uint32_t first, std::uint32_t last);

  std::span<const geom::Vec3> points_;
  std::vector<Node> nodes_;
};

}  // namespace kaboum::bcd
