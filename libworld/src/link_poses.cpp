// Where the links of a robot are.

#include "link_poses.h"

#include <cmath>

namespace kaboum::world::detail {

LinkPoses::LinkPoses(const robot::Robot& robot, const Transform& base)
    : base_(base), at_origin_(base.linear.isIdentity(0) && base.translation.isZero(0)) {
  double defects = 0;
  places_.emplace_back();
  for (const robot::Joint& joint : robot.joints) {
    const Eigen::Matrix3d& o = joint.origin.linear;
    defects += (o.transpose() * o - Eigen::Matrix3d::Identity()).norm();
    const Place& parent = places_[joint.parent];
    const Transform origin = parent.is_fixed ? parent.fixed * joint.origin : joint.origin;
    if (joint.type == robot::JointType::Fixed) {
      places_.push_back({parent.moved, true, origin});
      continue;
    }
    const Eigen::Matrix3d& l = origin.linear;
    const Vec3& a = joint.axis;
    if (joint.type == robot::JointType::Revolute) defects += 16 * std::abs(a.norm() - 1);
    Eigen::Matrix3d cross;
    cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    const Eigen::Matrix3d parallel = a * a.transpose();
    steps_.push_back({joint.type == robot::JointType::Revolute, parent.moved, joint.variable,
                      joint.multiplier, joint.offset, origin, l * parallel,
                      l * (Eigen::Matrix3d::Identity() - parallel), l * cross, l * a});
    places_.push_back({steps_.size(), false, {}});
  }
  // Of a product of matrices with singular values within 1 ± d: while the sum of all d is small.
  defect_ = defects < 0.01 ? 2 * defects : HUGE_VAL;
}

void LinkPoses::compute(std::span<const double> q, std::vector<Transform>& moved) const {
  moved.resize(steps_.size() + 1);
  moved[0] = {};
  for (std::size_t j = 0; j < steps_.size(); ++j) {
    const Step& step = steps_[j];
    const Transform& parent = moved[step.parent];
    Transform& out = moved[j + 1];
    const double x = step.multiplier * q[step.variable] + step.offset;
    out.translation = parent * step.origin.translation;
    if (!step.turns) {
      out.linear.noalias() = parent.linear * step.origin.linear;
      out.translation += parent.linear * (x * step.along);
      continue;
    }
    const double c = std::cos(x), s = std::sin(x);
    const Eigen::Matrix3d local = step.still + c * step.cosine + s * step.sine;
    out.linear.noalias() = parent.linear * local;
  }
}

}  // namespace kaboum::world::detail
