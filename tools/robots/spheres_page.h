#pragma once

#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/sphere_verdict.h>

#include <string>

namespace kaboum::tools {

/// A page that shows a robot with spheres, at zero joint values: what sticks out in red, and a row
/// for each link. docs/pages.md.
/// @param file  of the spheres
std::string page_of_spheres(const robot::RobotFile& robot, const std::string& file,
                            const verify::SpheresVerdict& verdict);

}  // namespace kaboum::tools
