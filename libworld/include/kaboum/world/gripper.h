#pragma once

#include <kaboum/world/world.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

/// Grippers with joints and pads: how far they are open, and what their pads may touch.
/// docs/planning/grippers.md.
namespace kaboum::world {

/// The gripper with pads whose tool is fixed to a link, or to one that fixed joints connect with
/// it; null: there is none.
const Gripper* gripper_with_pads(const RobotModel& robot, std::uint32_t link);

/// Whether any gripper of a robot has pads.
bool has_pads(const RobotModel& robot);

/// Whether any gripper of a robot has joints of its own.
bool has_finger_joints(const RobotModel& robot);

/// The joint of a gripper with pads that moves a link of its robot, by its variable; nullopt: none
/// does.
std::optional<std::uint32_t> finger_joint_above(const RobotModel& robot, std::uint32_t link);

/// The hold of an object by a grasp: by the pads of the gripper at a link, opened as the grasp
/// states. Of a link without such a gripper: by the link, and the fingers that may touch.
/// @param pose  from the object's frame to the link's
/// @throws Error{InvalidArgument} where the grasp does not state a value for each joint, or names a
///   pad that the gripper does not have
Attachment hold_by(const World& world, std::size_t robot, std::uint32_t link, const Transform& pose,
                   const Grasp& grasp);

/// What a grasp and a gripper do not agree on, as a sentence; none: they agree.
std::optional<std::string> find_misfit(const RobotModel& robot, const Gripper& gripper,
                                       const Grasp& grasp);

/// The hold of what is mounted on a held object: it moves along, and no pad may touch it.
/// @param relative  from its frame to that of the object it is mounted on
Attachment carried_along(const Attachment& below, const Transform& relative);

/// Puts the joints of grippers where they are while robots hold what they hold: as the grasp
/// states, or as at the robot's home where a gripper with joints holds nothing by its pads.
void set_grippers(const World& world, WorldState& state);
/// The same of one robot. @param q  a value per variable
void set_grippers(const World& world, std::size_t robot,
                  const std::vector<std::optional<Attachment>>& attachments,
                  std::vector<double>& q);

/// A configuration with the joints of grippers as in another one.
std::vector<double> with_fingers_of(const RobotModel& robot, const std::vector<double>& other,
                                    std::vector<double> q);

/// How far the joints of a robot's grippers may be from where they were told to be, while it holds
/// things: MotionOptions::around; empty where none is off.
std::vector<double> finger_room(const World& world, std::size_t robot,
                                const std::vector<std::optional<Attachment>>& attachments);

/// The same for motions whose waypoints are known: with room, about these, for all that the grasps
/// of what is held allow. Where fingers are not as a grasp states, there is more.
/// @param path  a value per variable at each waypoint
/// @param what  of it, in messages: "waypoint"
/// @throws Error{InvalidArgument} where a joint of a gripper that holds something is farther than
///   `within` from where the grasp has it, naming the waypoint, the joint and the grasp's value
std::vector<double> finger_room_along(const World& world, std::size_t robot,
                                      const std::vector<std::optional<Attachment>>& attachments,
                                      std::span<const std::vector<double>> path,
                                      const std::string& what);

/// The joints of a robot's grippers that hold something, by their variables.
std::vector<std::uint32_t> holding_joints(
    std::size_t robot, const std::vector<std::optional<Attachment>>& attachments);

/// "arm/left and arm/right": the links that may touch what is held.
std::string name_pads(const World& world, const Attachment& held);

/// What is left out of contacts in what is certified of a world: "free but for the pads arm/left
/// and arm/right with what they hold", and the links without pads that may touch what they hold or
/// push, and contacts that the scene allows; empty: no gripper has pads.
std::string pads_claim(const World& world);

/// Sentences for the things that pads hold at first: which contact is left out.
std::vector<std::string> notes_of_pads(const World& world);

}  // namespace kaboum::world
