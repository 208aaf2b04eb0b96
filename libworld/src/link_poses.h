#pragma once

#include <kaboum/robot/robot.h>

#include <span>
#include <vector>

namespace kaboum::world::detail {

using geom::Transform;
using geom::Vec3;

/// Forward kinematics of one robot, again and again: what does not depend on the joints' values is
/// multiplied beforehand. Errs by no more than what docs/algorithms/swept-volumes.md, "Rounding",
/// allows each factor.
class LinkPoses {
 public:
  /// Refers to nothing of the robot. @param base  of the root in the world
  LinkPoses(const robot::Robot& robot, const Transform& base);

  /// Poses of the root and of what each joint moves that is not fixed, relative to the root.
  /// @pre a value per variable.
  void compute(std::span<const double> q, std::vector<Transform>& moved) const;

  /// A link's pose in the world. @param moved  of compute
  void place(std::uint32_t link, const std::vector<Transform>& moved, Transform& pose) const {
    const Place& place = places_[link];
    const Transform& last = moved[place.moved];
    if (place.is_fixed)
      pose = last * place.fixed;
    else
      pose = last;
    if (!at_origin_) pose = base_ * pose;
  }

  /// Bounds |LᵀL − I| (Frobenius) of every pose's matrix L but for rounding: origins that are not
  /// quite rotations, axes that are not quite of unit length.
  [[nodiscard]] double defect() const { return defect_; }

 private:
  /// A joint that moves.
  struct Step {
    bool turns = true;
    std::size_t parent = 0;  ///< of the poses before
    std::uint32_t variable = 0;
    double multiplier = 1, offset = 0;
    Transform origin;  ///< from the joint's frame to the parent's, fixed joints between included
    /// Of a turn by x: origin · turn = still + cos x · cosine + sin x · sine.
    Eigen::Matrix3d still, cosine, sine;
    Vec3 along = Vec3::Zero();  ///< of a slide: origin · axis
  };
  /// Of a link: what moves it, and fixed joints from there.
  struct Place {
    std::size_t moved = 0;
    bool is_fixed = false;
    Transform fixed;
  };

  Transform base_;
  bool at_origin_ = true;
  std::vector<Step> steps_;
  std::vector<Place> places_;
  double defect_ = 0;
};

}  // namespace kaboum::world::detail
