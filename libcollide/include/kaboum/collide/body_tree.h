#pragma once

#include <kaboum/collide/box_overlap.h>
#include <kaboum/geom/transform.h>

#include <cstddef>
#include <vector>

namespace kaboum::collide {

/// Tree of oriented boxes over the bodies of one rigid object, in its frame.
///
/// Boxes are made once and turn with the object, so they stay tight. (FCL gives an object that is
/// turned the box of its bounding sphere.)
class BodyTree {
 public:
  /// @pre bodies are convex and not empty.
  explicit BodyTree(const std::vector<geom::Mesh>& bodies);

 private:
  template <typename Narrow>
  friend bool any_pair(const BodyTree& a, const BodyTree& b, const geom::Transform& pose,
                       const Narrow& narrow);

  struct Node {
    Eigen::Matrix3d axes;  ///< of the box, columns
    geom::Vec3 center, half;
    double radius;
    int body;  ///< of a leaf; else −1
    std::size_t left, right;
  };

  static Node fitted(const std::vector<geom::Vec3>& points,
                     const std::vector<Eigen::Matrix3d>& frames);

  template <typename Narrow>
  static bool any_below(const BodyTree& a, const Node& x, const BodyTree& b, const Node& y,
                        const geom::Transform& pose, const Narrow& narrow) {
    const geom::Vec3 between = pose.linear * y.center + pose.translation - x.center;
    if (between.squaredNorm() > (x.radius + y.radius) * (x.radius + y.radius)) return false;
    const Eigen::Matrix3d turn = x.axes.transpose() * (pose.linear * y.axes);
    if (boxes_are_apart(turn, x.axes.transpose() * between, x.half, y.half)) return false;
    if (x.body >= 0 && y.body >= 0) return narrow(x.body, y.body);
    if (y.body >= 0 || (x.body < 0 && x.half.squaredNorm() > y.half.squaredNorm()))
      return any_below(a, a.nodes_[x.left], b, y, pose, narrow) ||
             any_below(a, a.nodes_[x.right], b, y, pose, narrow);
    return any_below(a, x, b, b.nodes_[y.left], pose, narrow) ||
           any_below(a, x, b, b.nodes_[y.right], pose, narrow);
  }

  std::vector<Node> nodes_;  ///< the root last
};

/// True if narrow(i, j) says so for body i of `a` and body j of `b`, which `pose` takes into the
/// frame of `a`; asked of pairs whose boxes meet, until it does.
template <typename Narrow>
bool any_pair(const BodyTree& a, const BodyTree& b, const geom::Transform& pose,
              const Narrow& narrow) {
  return !a.nodes_.empty() && !b.nodes_.empty() &&
         BodyTree::any_below(a, a.nodes_.back(), b, b.nodes_.back(), pose, narrow);
}

}  // namespace kaboum::collide
