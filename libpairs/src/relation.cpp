// What is between two links, by joints alone.

#include <kaboum/pairs/relation.h>

namespace kaboum::pairs {
namespace {

/// The link that fixed joints make one body with this one: the one nearest to the root.
std::uint32_t body_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// A link itself if it has shapes or moves against its parent; else the nearest such one on the way
/// to the root: flanges and frames between a joint and what it carries.
std::uint32_t carrier_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t link) {
  while (link > 0 && shaped[link] == 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// The child, but for frames without shapes that are fixed between it and the joint that it hangs
/// on.
std::uint32_t joint_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed &&
         robot.joints[link - 1].parent > 0 && shaped[robot.joints[link - 1].parent] == 0)
    link = robot.joints[link - 1].parent;
  return link;
}

}  // namespace

const char* name_of(Relation relation) {
  switch (relation) {
    case Relation::Adjacent:
      return "adjacent";
    case Relation::Fixed:
      return "fixed";
    default:
      return "moving";
  }
}

// What is fixed to the one elsewhere (a camera, a wall beside a rail) is not adjacent: it may well
// be touched.
bool are_adjacent(const robot::Robot& robot, const Shaped& shaped, std::uint32_t a,
                  std::uint32_t b) {
  const auto hangs_on = [&](std::uint32_t child, std::uint32_t parent) {
    if (child > 0 && robot.joints[child - 1].parent == parent) return true;
    const std::uint32_t joint = joint_of(robot, shaped, child);
    return joint > 0 && carrier_of(robot, shaped, robot.joints[joint - 1].parent) == parent;
  };
  return hangs_on(a, b) || hangs_on(b, a);
}

Relation relation_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t a,
                     std::uint32_t b) {
  if (body_of(robot, a) == body_of(robot, b)) return Relation::Fixed;
  return are_adjacent(robot, shaped, a, b) ? Relation::Adjacent : Relation::Moving;
}

}  // namespace kaboum::pairs
