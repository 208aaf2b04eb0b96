// A robot's kinematics as data of pages.

#include <kaboum/robot/page_data.h>

#include <nlohmann/json.hpp>

namespace kaboum::robot {
namespace {

const char* name_of(JointType type) {
  switch (type) {
    case JointType::Fixed:
      return "fixed";
    case JointType::Revolute:
      return "revolute";
    case JointType::Prismatic:
      break;
  }
  return "prismatic";
}

nlohmann::ordered_json pose_json(const Transform& pose) {
  auto out = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.push_back(pose.linear(row, column));
  for (const double x : pose.translation) out.push_back(x);
  return out;
}

}  // namespace

std::string joints_json(const Robot& robot) {
  auto joints = nlohmann::ordered_json::array();
  for (const Joint& joint : robot.joints)
    joints.push_back({{"type", name_of(joint.type)},
                      {"parent", joint.parent},
                      {"origin", pose_json(joint.origin)},
                      {"axis", {joint.axis.x(), joint.axis.y(), joint.axis.z()}},
                      {"variable", joint.variable},
                      {"multiplier", joint.multiplier},
                      {"offset", joint.offset}});
  return joints.dump();
}

}  // namespace kaboum::robot
