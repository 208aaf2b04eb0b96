// Payloads of plans: who moves along which path, and what is held.

#include "motion_part.h"

#include <kaboum/base/error.h>

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

void require_above_zero(const SimulationOptions& options) {
  if (!(options.rate > 0) || !(options.acceleration > 0) || !(options.usual_velocity > 0))
    throw Error(ErrorCode::InvalidArgument, "rates and limits must be above 0");
}

motion::Trajectory trajectory_of(const MotionPart& part, const world::World& world,
                                 const SimulationOptions& options) {
  motion::SpeedLimits limits;
  for (const robot::Variable& v : world.robots[part.robot].kinematics.variables)
    limits.velocity.push_back(v.velocity.value_or(options.usual_velocity));
  limits.acceleration.assign(part.path.front().size(), options.acceleration);
  return {part.path, limits, options.rate, options.profile};
}

}  // namespace kaboum::execution
