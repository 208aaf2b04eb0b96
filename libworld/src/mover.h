#pragma once

#include <kaboum/world/motion_check.h>

#include <vector>

#include "placement.h"

namespace kaboum::world {

/// Bounds the rounding of the few sums and products that say how far a mover gets.
inline constexpr double kUp = 1 + 0x1p-40;

}  // namespace kaboum::world

namespace kaboum::world::detail {

/// Something that a robot's motion moves: a shape of it, or an object that it carries.
struct Mover {
  Item item;
  std::size_t robot = 0;  ///< that moves it
  std::uint32_t link = 0;
  Transform on_link;  ///< identity for shapes of links
  sweep::Reach reach;
  double grasp_error = 0;
};

/// Whether an item moves when the robot does.
inline bool is_moved_by(std::size_t robot, const Item& item, const WorldState& state) {
  if (item.robot == robot) return true;
  if (item.robot != Item::kObject) return false;
  const auto& attachment = state.attachments[item.index];
  return attachment && attachment->robot == robot;
}

/// @pre is_moved_by(robot, item, state)
inline Mover mover_of(const Checker& checker, const WorldState& state, const Item& item) {
  Mover out;
  out.item = item;
  if (item.robot != Item::kObject) {
    out.robot = item.robot;
    out.reach = checker.reach_of(item.robot, item.index);
    out.link = checker.world().robots[item.robot].shapes[item.index].link;
    return out;
  }
  const Attachment& attachment = *state.attachments[item.index];
  out.robot = attachment.robot;
  out.link = attachment.link;
  out.on_link = attachment.pose;
  out.grasp_error = attachment_error(attachment.pose, radius_of(checker.world().outer(item)));
  std::vector<Vec3> points = checker.hull_of(item);
  for (Vec3& p : points) p = attachment.pose * p;
  const RobotModel& robot = checker.world().robots[attachment.robot];
  out.reach = sweep::reach_of(sweep::LinkMotion(robot.kinematics, out.link, robot.home, robot.home),
                              points);
  return out;
}

/// @throws Error{InvalidArgument} as check_motion, of robot, path and options.
void require_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                    const robot::Path& path, const MotionOptions& options);

/// How far a mover may be from where it is computed to be, anywhere in a segment; `speed` is the
/// bound of how fast it moves. The rounding of the instant itself moves a point by less than 2^-52
/// of that.
inline double error_of_motion(const Mover& mover, const sweep::MotionBounds& bounds, double speed,
                              const Transform& base) {
  return (placement_error(bounds, base) + mover.grasp_error + 0x1p-50 * speed) * (1 + 0x1p-40);
}

}  // namespace kaboum::world::detail
