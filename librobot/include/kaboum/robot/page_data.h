#pragma once

#include <kaboum/robot/robot.h>

#include <string>

namespace kaboum::robot {

/// The joints as JSON from which a page computes the poses of all links: a list of objects with
/// type, parent, origin (a rotation row by row, then a translation), axis, variable, multiplier and
/// offset, as in Joint. docs/pages.md.
std::string joints_json(const Robot& robot);

}  // namespace kaboum::robot
