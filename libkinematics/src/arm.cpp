// Arms as products of exponentials: made of a robot's chain or of Denavit–Hartenberg rows.
#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/kinematics/arm.h>

#include <algorithm>
#include <cmath>

namespace kaboum::kinematics {
namespace {

std::uint32_t link_named(const robot::Robot& robot, std::string_view name) {
  if (const auto link = robot.find_link(name)) return *link;
  std::vector<std::string> known;
  for (const robot::Link& link : robot.links) known.push_back(link.name);
  std::string hint = did_you_mean(name, known);
  if (hint.empty()) {
    for (const std::string& link : known) hint += (hint.empty() ? "; it has '" : "', '") + link;
    hint += "'";
  }
  throw Error(ErrorCode::InvalidArgument, "there is no link '" + std::string(name) + "'" + hint);
}

/// The joints from `base` down to `tip`.
std::vector<const robot::Joint*> joints_between(const robot::Robot& robot, std::uint32_t base,
                                                std::uint32_t tip) {
  std::vector<const robot::Joint*> joints;
  for (std::uint32_t link = tip; link != base; link = joints.back()->parent) {
    if (link == 0)
      throw Error(ErrorCode::InvalidArgument,
                  "link '" + robot.links[base].name + "' is not between the root and link '" +
                      robot.links[tip].name + "'; the chain begins at the link nearer the root");
    joints.push_back(&robot.joints[link - 1]);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

Axis axis_of(const robot::Robot& robot, const robot::Joint& joint, const Transform& frame) {
  const robot::Variable& variable = robot.variables[joint.variable];
  if (joint.multiplier == 0)
    throw Error(ErrorCode::InvalidInput, "joint '" + joint.name + "' does not follow its variable");
  Axis axis;
  axis.turns = joint.type == robot::JointType::Revolute;
  axis.direction = (frame.linear * joint.axis).normalized();
  if (joint.multiplier < 0) axis.direction = -axis.direction;
  axis.point = frame.translation;
  axis.rate = std::abs(joint.multiplier);
  if (variable.lower) axis.lower = *variable.lower;
  if (variable.upper) axis.upper = *variable.upper;
  return axis;
}

/// What a joint's offset adds to the frame.
Transform offset_of(const robot::Joint& joint) {
  if (joint.type == robot::JointType::Revolute)
    return {robot::rotation_about(joint.axis, joint.offset), Vec3::Zero()};
  return {Mat3::Identity(), joint.offset * joint.axis};
}

Arm arm_of_rows(std::span<const robot::Dh> rows, bool distal) {
  Arm arm;
  for (const robot::Dh& row : rows) {
    Axis axis;
    Transform frame = arm.tool;
    if (!distal) frame = frame * robot::dh_proximal({0, 0, row.a, row.alpha});
    axis.direction = frame.linear.col(2);
    axis.point = frame.translation;
    arm.variables.push_back(static_cast<std::uint32_t>(arm.axes.size()));
    arm.axes.push_back(axis);
    arm.tool = arm.tool * (distal ? robot::dh_distal(row) : robot::dh_proximal(row));
  }
  return arm;
}

Transform motion(const Axis& axis, double q) {
  if (!axis.turns) return {Mat3::Identity(), axis.rate * q * axis.direction};
  Transform t{robot::rotation_about(axis.direction, axis.rate * q), Vec3::Zero()};
  t.translation = axis.point - t.linear * axis.point;
  return t;
}

}  // namespace

Arm arm_of(const robot::Robot& robot, std::string_view base, std::string_view tip) {
  Arm arm;
  for (const robot::Joint* joint :
       joints_between(robot, link_named(robot, base), link_named(robot, tip))) {
    arm.tool = arm.tool * joint->origin;
    if (joint->type == robot::JointType::Fixed) continue;
    if (std::find(arm.variables.begin(), arm.variables.end(), joint->variable) !=
        arm.variables.end())
      throw Error(ErrorCode::InvalidInput,
                  "joint '" + joint->name + "' follows variable '" +
                      robot.variables[joint->variable].name +
                      "', which moves another joint of the chain: no inverse kinematics of those");
    const Axis axis = axis_of(robot, *joint, arm.tool);
    arm.tool = arm.tool * offset_of(*joint);
    arm.axes.push_back(axis);
    arm.variables.push_back(joint->variable);
  }
  if (arm.axes.empty())
    throw Error(ErrorCode::InvalidArgument, "nothing moves between the links '" +
                                                std::string(base) + "' and '" + std::string(tip) +
                                                "'");
  return arm;
}

ArmFrame frame_of(const robot::Robot& robot, const Arm& arm, std::string_view base,
                  std::string_view link) {
  ArmFrame out;
  for (const robot::Joint* joint :
       joints_between(robot, link_named(robot, base), link_named(robot, link))) {
    out.pose = out.pose * joint->origin;
    if (joint->type == robot::JointType::Fixed) continue;
    bool same = out.axes < arm.axes.size() && arm.variables[out.axes] == joint->variable;
    if (same) {
      // A joint of another branch may follow the same variable.
      const Axis &known = arm.axes[out.axes], axis = axis_of(robot, *joint, out.pose);
      same = known.turns == axis.turns && known.rate == axis.rate &&
             known.direction == axis.direction && known.point == axis.point;
    }
    if (!same)
      throw Error(ErrorCode::InvalidArgument, "link '" + std::string(link) +
                                                  "' moves with joint '" + joint->name +
                                                  "', which is not the arm's");
    ++out.axes;
    out.pose = out.pose * offset_of(*joint);
  }
  return out;
}

Arm arm_to(const Arm& arm, const ArmFrame& frame) {
  const auto count = static_cast<std::ptrdiff_t>(frame.axes);
  return {{arm.axes.begin(), arm.axes.begin() + count},
          frame.pose,
          {arm.variables.begin(), arm.variables.begin() + count}};
}

Arm arm_of_distal(std::span<const robot::Dh> rows) { return arm_of_rows(rows, true); }
Arm arm_of_proximal(std::span<const robot::Dh> rows) { return arm_of_rows(rows, false); }

Transform forward(const Arm& arm, std::span<const double> q) {
  Transform pose;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) pose = pose * motion(arm.axes[i], q[i]);
  return pose * arm.tool;
}

Jacobian jacobian(const Arm& arm, std::span<const double> q, Transform* pose) {
  Jacobian out;
  Transform tool;
  jacobian(arm, {}, q, out, tool);
  if (pose != nullptr) *pose = tool;
  return out;
}

void jacobian(const Arm& arm, const Transform& base, std::span<const double> q, Jacobian& out,
              Transform& pose) {
  out.resize(6, static_cast<Eigen::Index>(arm.axes.size()));
  Transform moved = base;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    const Axis& axis = arm.axes[i];
    const auto column = static_cast<Eigen::Index>(i);
    const Vec3 direction = axis.rate * (moved.linear * axis.direction);
    out.col(column).head<3>() = axis.turns ? Vec3(moved * axis.point) : direction;
    out.col(column).tail<3>() = axis.turns ? direction : Vec3::Zero();
    moved = moved * motion(axis, q[i]);
  }
  pose = moved * arm.tool;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    if (!arm.axes[i].turns) continue;
    auto column = out.col(static_cast<Eigen::Index>(i));
    const Vec3 direction = column.tail<3>(), lever = pose.translation - column.head<3>();
    column.head<3>() = direction.cross(lever);
  }
}

double reach(const Arm& arm) {
  double sum = 0;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    const Axis& axis = arm.axes[i];
    const Vec3 next = i + 1 < arm.axes.size() ? arm.axes[i + 1].point : arm.tool.translation;
    sum += (next - axis.point).norm();
    if (axis.turns) continue;
    const double range = std::max(std::abs(axis.lower), std::abs(axis.upper));
    if (std::isfinite(range)) sum += axis.rate * range;
  }
  return sum;
}

bool within_limits(const Arm& arm, std::span<const double> q) {
  for (std::size_t i = 0; i < arm.axes.size(); ++i)
    if (!(q[i] >= arm.axes[i].lower && q[i] <= arm.axes[i].upper)) return false;
  return true;
}

PoseError difference(const Transform& a, const Transform& b) {
  return {(a.translation - b.translation).norm(), (a.linear - b.linear).norm()};
}

}  // namespace kaboum::kinematics
