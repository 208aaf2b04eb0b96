// Poses of links, their Jacobian, and Denavit–Hartenberg rows.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>

#include <cmath>

namespace kaboum::robot {
namespace {

double value(const Joint& joint, std::span<const double> q) {
  return joint.multiplier * q[joint.variable] + joint.offset;
}

void require_values(const Robot& robot, std::span<const double> q) {
  if (q.size() != robot.variables.size())
    throw Error(ErrorCode::InvalidArgument, std::to_string(q.size()) + " values for a robot with " +
                                                std::to_string(robot.variables.size()) +
                                                " variables");
}

}  // namespace

Mat3 rotation_about(const Vec3& a, double angle) {
  Mat3 cross;
  cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  const Mat3 along = a * a.transpose();
  return along + std::cos(angle) * (Mat3::Identity() - along) + std::sin(angle) * cross;
}

Mat3 rotation_from_rpy(double roll, double pitch, double yaw) {
  const double cr = std::cos(roll), sr = std::sin(roll), cp = std::cos(pitch), sp = std::sin(pitch),
               cy = std::cos(yaw), sy = std::sin(yaw);
  Mat3 r;
  r << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return r;
}

Transform dh_distal(const Dh& p) {
  const Transform first{rotation_about(Vec3::UnitZ(), p.theta), {0, 0, p.d}};
  return first * Transform{rotation_about(Vec3::UnitX(), p.alpha), {p.a, 0, 0}};
}

Transform dh_proximal(const Dh& p) {
  const Transform first{rotation_about(Vec3::UnitX(), p.alpha), {p.a, 0, 0}};
  return first * Transform{rotation_about(Vec3::UnitZ(), p.theta), {0, 0, p.d}};
}

std::vector<Transform> forward(const Robot& robot, std::span<const double> q) {
  require_values(robot, q);
  std::vector<Transform> poses(robot.links.size());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Joint& joint = robot.joints[j];
    Transform local = joint.origin;
    if (joint.type == JointType::Revolute)
      local.linear = (local.linear * rotation_about(joint.axis, value(joint, q))).eval();
    if (joint.type == JointType::Prismatic)
      local.translation += local.linear * (value(joint, q) * joint.axis);
    poses[j + 1] = poses[joint.parent] * local;
  }
  return poses;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(const Robot& robot, std::span<const double> q,
                                                  std::uint32_t link, const Vec3& point) {
  if (link >= robot.links.size()) throw Error(ErrorCode::InvalidArgument, "no such link");
  const std::vector<Transform> poses = forward(robot, q);
  const Vec3 p = poses[link] * point;
  Eigen::Matrix<double, 6, Eigen::Dynamic> out(6, static_cast<Eigen::Index>(q.size()));
  out.setZero();
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) {
    const Joint& joint = robot.joints[l - 1];
    if (joint.type == JointType::Fixed) continue;
    // The motion keeps its own axis, so the moved frame gives it as well.
    const Vec3 axis = joint.multiplier * (poses[l].linear * joint.axis);
    if (joint.type == JointType::Revolute) {
      out.col(joint.variable).head<3>() += axis.cross(p - poses[l].translation);
      out.col(joint.variable).tail<3>() += axis;
    } else {
      out.col(joint.variable).head<3>() += axis;
    }
  }
  return out;
}

std::optional<std::uint32_t> find_out_of_limits(const Robot& robot, std::span<const double> q) {
  require_values(robot, q);
  for (std::uint32_t i = 0; i < q.size(); ++i) {
    const Variable& v = robot.variables[i];
    if ((v.lower && q[i] < *v.lower) || (v.upper && q[i] > *v.upper)) return i;
  }
  return std::nullopt;
}

}  // namespace kaboum::robot
