#pragma once

#include <kaboum/execution/simulation.h>
#include <kaboum/judge/cell.h>
#include <kaboum/world/world.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::execution {

/// Who moves, by which links it holds what, and where it goes.
struct MotionPart {
  std::size_t robot = 0;
  std::map<std::size_t, std::uint32_t> holds;  ///< objects, by what link
  robot::Path path;
  std::map<std::size_t, std::string> grasps = {};  ///< of those that pads hold, by what grasp
  /// The object that the fingers of a gripper close on, or open from; nothing else moves then.
  std::optional<std::size_t> closes = {}, opens = {};
  /// True if fingers move, and nothing else.
  [[nodiscard]] bool moves_fingers() const { return closes || opens; }
  /// Of each waypoint, as of motion::BlendedPath; nullopt: from rest to rest along each segment.
  std::optional<std::vector<double>> blends = {};
};

/// The motions of a payload; empty: it is of another kind.
/// @param where  in the plan it is: "node 3, grasp(o1)".
/// @throws Error{InvalidInput} for robots, objects and links that the scene does not have, paths
///   that do not fit their robot, and members of another kind; it begins with `where`.
std::vector<MotionPart> parts_of(const std::string& payload, const world::World& world,
                                 const std::string& where);

/// How a part holds an object. @pre it does
/// @param pose  from the object's frame to the link's
/// @throws Error{InvalidInput} for grasps that are none of the object's, or not for the gripper
world::Attachment hold_of(const MotionPart& part, const world::World& world, std::size_t object,
                          const geom::Transform& pose);
/// The same as a judge has it.
judge::Hold judged(const world::Attachment& held);
/// How far the joints of grippers may be off while a part is carried out: as
/// world::MotionOptions::around. @throws as hold_of
std::vector<double> finger_room_of(const MotionPart& part, const world::World& world);

/// Limits of a robot's joints, as motion::speed_limits.
/// @throws Error{InvalidArgument} for rates and limits that are not above 0, and names of joints
///   that no robot of the world has.
motion::SpeedLimits limits_of(const SimulationOptions& options, const world::World& world,
                              std::size_t robot);

/// @throws as limits_of, of each robot.
void require_valid(const SimulationOptions& options, const world::World& world);

/// The part in time.
/// @pre its path is not empty.
motion::Trajectory trajectory_of(const MotionPart& part, const world::World& world,
                                 const SimulationOptions& options);

}  // namespace kaboum::execution
