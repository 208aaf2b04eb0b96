#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/world/motion_check.h>

#include <string>

#include "cli.h"

/// What kaboum-check says of states and motions, in words and as a report.
namespace kaboum::tools {

/// "within epsilon", or "colliding" where that is certain.
std::string describe(const world::World& world, const world::Contact& contact);
Json to_json(const world::World& world, const world::Contact& contact);

std::string describe(const world::World& world, const world::MotionAnswer& answer);
Json to_json(const world::World& world, const world::MotionAnswer& answer);

Json to_json(const robot::Robot& robot, const motion::PathConstraint& constraint);

}  // namespace kaboum::tools
