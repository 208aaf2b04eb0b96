// Payloads of plans: who moves along which path, and what is held.

#include "motion_part.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace kaboum::execution {
namespace {

using nlohmann::json;

/// @throws json::exception for members of another kind.
MotionPart part_of(const json& motion, const world::World& world) {
  MotionPart part;
  const auto robot = world.find_robot(motion.at("robot").get<std::string>());
  if (!robot)
    throw Error(ErrorCode::InvalidInput, "a path of the plan is for robot '" +
                                             motion.at("robot").get<std::string>() +
                                             "', which the scene does not have");
  part.robot = *robot;
  part.path = motion.at("path").get<robot::Path>();
  const robot::Robot& kinematics = world.robots[*robot].kinematics;
  for (const robot::Path::value_type& q : part.path)
    if (q.size() != kinematics.variables.size())
      throw Error(ErrorCode::InvalidInput, "a path of the plan does not fit its robot");
  if (!motion.contains("holds")) return part;
  for (const auto& [name, link] : motion.at("holds").items()) {
    const auto object = world.find_object(name);
    const auto number = kinematics.find_link(link.get<std::string>());
    if (!object || !number)
      throw Error(ErrorCode::InvalidInput,
                  "a path of the plan holds '" + name + "', which the scene does not have");
    part.holds[*object] = *number;
  }
  return part;
}

}  // namespace

std::vector<MotionPart> parts_of(const std::string& payload, const world::World& world,
                                 const std::string& where) {
  std::vector<MotionPart> out;
  const json list = json::parse(payload, nullptr, false);
  if (!list.is_array()) return out;
  for (const json& motion : list) {
    if (!motion.is_object() || !motion.contains("path") || !motion.contains("robot")) return {};
    try {
      out.push_back(part_of(motion, world));
    } catch (const Error& e) {
      throw Error(e.code(), where + ": " + e.what());
    } catch (const json::exception&) {
      throw Error(ErrorCode::InvalidInput,
                  where +
                      R"(: a path of the plan is to be {"robot": NAME, "path": [[NUMBER, ...], )"
                      R"(...], "holds": {OBJECT: LINK, ...}})");
    }
  }
  return out;
}

namespace {

/// What is asked of the joints of a robot, and of all joints.
std::map<std::string, double> of_robot(const std::map<std::string, double>& asked,
                                       const char* option, const world::World& world,
                                       std::size_t robot) {
  std::map<std::string, double> out;
  std::vector<std::string> names;
  const auto has = [](const world::RobotModel& model, const std::string& name) {
    return std::ranges::find(model.kinematics.variables, name, &robot::Variable::name) !=
           model.kinematics.variables.end();
  };
  for (const world::RobotModel& model : world.robots)
    for (const robot::Variable& v : model.kinematics.variables) names.push_back(v.name);
  for (const auto& [name, value] : asked) {
    if (name.empty() || has(world.robots[robot], name)) out[name] = value;
    if (!name.empty() && std::ranges::find(names, name) == names.end())
      throw Error(ErrorCode::InvalidArgument, "«" + std::string(option) +
                                                  "»: no robot of the scene has a joint '" + name +
                                                  "'" + did_you_mean(name, names));
  }
  return out;
}

}  // namespace

motion::SpeedLimits limits_of(const SimulationOptions& options, const world::World& world,
                              std::size_t robot) {
  motion::TrajectoryOptions own = options.motion;
  if (!(own.rate > 0) || !std::isfinite(own.rate))
    throw Error(ErrorCode::InvalidArgument, "rates and limits must be above 0");
  own.velocities = of_robot(own.velocities, "max-velocity", world, robot);
  own.accelerations = of_robot(own.accelerations, "max-acceleration", world, robot);
  own.jerks = of_robot(own.jerks, "max-jerk", world, robot);
  return speed_limits(own, world.robots[robot].kinematics);
}

void require_valid(const SimulationOptions& options, const world::World& world) {
  for (std::size_t r = 0; r < world.robots.size(); ++r) limits_of(options, world, r);
}

motion::Trajectory trajectory_of(const MotionPart& part, const world::World& world,
                                 const SimulationOptions& options) {
  const motion::SpeedLimits limits = limits_of(options, world, part.robot);
  if (part.blends) return {part.path, *part.blends, limits, options.motion.rate};
  return {part.path, limits, options.motion.rate,
          options.motion.time_optimal ? motion::Profile::Trapezoid : motion::Profile::Quintic};
}

}  // namespace kaboum::execution
