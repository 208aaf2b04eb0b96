// robot-poses FILE...: what is read of robots, as JSON, for engines to be compared with: links,
// shapes, limits, joints that move, and the poses of all links at some configurations.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/robot_file.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

namespace {

using namespace kaboum;  // a program of one file
using Json = nlohmann::ordered_json;

constexpr int kConfigurations = 100;

Json to_json(const robot::Transform& pose) {
  Json out = Json::array();
  for (int i = 0; i < 9; ++i) out.push_back(pose.linear(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) out.push_back(pose.translation[i]);
  return out;
}

Json to_json(const std::vector<robot::Geometry>& shapes) {
  Json out = Json::array();
  for (const robot::Geometry& g : shapes)
    out.push_back({{"kind", robot::describe(g)},
                   {"size", {g.size.x(), g.size.y(), g.size.z()}},
                   {"mesh", g.mesh},
                   {"origin", to_json(g.origin)}});
  return out;
}

Json to_json(const robot::Robot& robot) {
  Json links = Json::array(), variables = Json::array(), joints = Json::array(),
       configurations = Json::array();
  for (const robot::Link& link : robot.links)
    links.push_back({{"name", link.name},
                     {"collision", to_json(link.collision)},
                     {"visual", to_json(link.visual)}});
  for (const robot::Variable& v : robot.variables)
    variables.push_back({{"name", v.name},
                         {"lower", v.lower ? Json(*v.lower) : Json()},
                         {"upper", v.upper ? Json(*v.upper) : Json()}});
  for (const robot::Joint& joint : robot.joints)
    if (joint.type != robot::JointType::Fixed)
      joints.push_back({{"name", joint.name},
                        {"variable", joint.variable},
                        {"multiplier", joint.multiplier},
                        {"offset", joint.offset}});
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp,cert-msc32-c): the same each time
  for (int k = 0; k < kConfigurations; ++k) {
    std::vector<double> q;
    for (std::size_t i = 0; i < robot.variables.size(); ++i)
      q.push_back(3 * (static_cast<double>(random() >> 1U) * 0x1p-31) - 1.5);
    Json poses = Json::array();
    for (const robot::Transform& pose : robot::forward(robot, q)) poses.push_back(to_json(pose));
    configurations.push_back({{"q", q}, {"poses", std::move(poses)}});
  }
  return {{"links", std::move(links)},
          {"variables", std::move(variables)},
          {"joints", std::move(joints)},
          {"unmodelled", robot.unmodelled},
          {"configurations", std::move(configurations)}};
}

}  // namespace

int main(int argc, char** argv) {
  Json out = Json::object();
  for (int i = 1; i < argc; ++i) {
    const std::string file = argv[i];
    try {
      out[file] = to_json(robot::read_robot(file, robot::Motions::None).robot);
    } catch (const Error& error) {
      out[file] = {{"error", error.what()}};
    }
  }
  std::cout << out.dump() << '\n';
  return 0;
}
