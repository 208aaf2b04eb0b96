// Payloads of plans: who moves along which path, and what is held.

#include "motion_part.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/gripper.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "finger_motion.h"

namespace kaboum::execution {
namespace {

using nlohmann::json;

/// Refuses motions of fingers that are none: nothing else is looked at while they close or open.
void require_fingers_alone(const MotionPart& part, const world::RobotModel& robot,
                           std::uint32_t link) {
  const world::Gripper* gripper = gripper_with_pads(robot, link);
  bool alone = gripper != nullptr && part.path.size() == 2;
  for (std::uint32_t i = 0; alone && i < part.path.front().size(); ++i)
    alone = part.path.front()[i] == part.path.back()[i] ||
            std::ranges::find(gripper->joints, i) != gripper->joints.end();
  if (!alone)
    throw Error(ErrorCode::InvalidInput,
                "a path of the plan, of fingers, has two points that differ in joints of the "
                "gripper alone");
}

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
  const auto object_of = [&](const std::string& name) {
    const auto object = world.find_object(name);
    if (!object)
      throw Error(ErrorCode::InvalidInput, "a path of the plan is about the object '" + name +
                                               "', which the scene does not have");
    return *object;
  };
  if (motion.contains("closes")) part.closes = object_of(motion.at("closes").get<std::string>());
  if (motion.contains("opens")) part.opens = object_of(motion.at("opens").get<std::string>());
  if (motion.contains("grasps"))
    for (const auto& [name, grasp] : motion.at("grasps").items())
      part.grasps[object_of(name)] = grasp.get<std::string>();
  if (motion.contains("holds"))
    for (const auto& [name, link] : motion.at("holds").items()) {
      const auto object = world.find_object(name);
      const auto number = kinematics.find_link(link.get<std::string>());
      if (!object || !number)
        throw Error(ErrorCode::InvalidInput,
                    "a path of the plan holds '" + name + "', which the scene does not have");
      part.holds[*object] = *number;
    }
  const auto require_held = [&](std::size_t object, bool is_held, const char* how) {
    if (!is_held)
      throw Error(ErrorCode::InvalidInput,
                  "a path of the plan does not hold '" + world.objects[object].name + "', " + how);
  };
  for (const auto& [object, grasp] : part.grasps)
    require_held(object, part.holds.contains(object), "of which it states a grasp");
  if (part.closes && part.opens)
    throw Error(ErrorCode::InvalidInput, "fingers of the plan close and open at once");
  for (const auto& about : {part.closes, part.opens})
    if (about) {
      require_held(*about, part.grasps.contains(*about), "which fingers close on or open from");
      require_fingers_alone(part, world.robots[*robot], part.holds.at(*about));
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

world::Attachment hold_of(const MotionPart& part, const world::World& world, std::size_t object,
                          const geom::Transform& pose) {
  const std::uint32_t link = part.holds.at(object);
  const world::RobotModel& robot = world.robots[part.robot];
  const auto named = part.grasps.find(object);
  if (named != part.grasps.end()) {
    for (const world::Grasp& grasp : world.objects[object].grasps)
      if (const world::Gripper* gripper = gripper_with_pads(robot, link);
          grasp.name == named->second && gripper != nullptr && !find_misfit(robot, *gripper, grasp))
        return hold_by(world, part.robot, link, pose, grasp);
    throw Error(ErrorCode::InvalidInput, "a path of the plan holds '" + world.objects[object].name +
                                             "' by the grasp '" + named->second +
                                             "', which pads of '" + robot.name + "' do not");
  }
  world::Attachment out;
  if (gripper_with_pads(robot, link) == nullptr)
    return hold_by(world, part.robot, link, pose, world::Grasp{});
  out.robot = part.robot;
  out.link = link;
  out.pose = pose;
  // Pushed by the link; or mounted on what pads hold, which do not touch it.
  out.link_touches = std::ranges::none_of(
      part.grasps, [&](const auto& other) { return part.holds.at(other.first) == link; });
  return out;
}

judge::Hold judged(const world::Attachment& held) {
  return {held.robot, held.link, held.pose, held.touching, held.link_touches};
}

FingerMotion finger_motion_of(const MotionPart& part, const world::World& world) {
  return finger_motion_of(hold_of(part, world, part.closes ? *part.closes : *part.opens, {}), world,
                          part.path.front(), part.path.back());
}

FingerMotion finger_motion_of(const world::Attachment& held, const world::World& world,
                              const std::vector<double>& from, const std::vector<double>& to) {
  const world::RobotModel& robot = world.robots[held.robot];
  const world::Gripper& gripper = *gripper_with_pads(robot, held.link);
  FingerMotion out{gripper.name, {}, gripper.joints, {}, {}, 0, {}, gripper.force};
  for (const world::FingerValue& finger : held.fingers) {
    out.joint_names.push_back(robot.kinematics.variables[finger.variable].name);
    out.from.push_back(from[finger.variable]);
    out.to.push_back(to[finger.variable]);
    out.within = std::max(out.within, finger.within);
  }
  for (const std::uint32_t pad : held.touching)
    out.pads.push_back(robot.kinematics.links[pad].name);
  return out;
}

std::vector<double> finger_room_of(const MotionPart& part, const world::World& world) {
  std::vector<std::optional<world::Attachment>> held(world.objects.size());
  for (const auto& [object, link] : part.holds) held[object] = hold_of(part, world, object, {});
  return finger_room(world, part.robot, held);
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
