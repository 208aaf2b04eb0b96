#pragma once

#include <kaboum/pairs/decide.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/robot_file.h>

#include <string>
#include <vector>

namespace kaboum::tools {

/// The shapes of a robot's links as meshes that hold them, and that lie in them. Mesh files are
/// taken as they are; what has holes is closed as all programs do it, in the outer mesh only.
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} where a mesh cannot be read
std::vector<pairs::LinkSurface> surfaces_of(const robot::RobotFile& robot,
                                            const robot::ShapeChoice& choice,
                                            std::vector<std::string>& notes);

}  // namespace kaboum::tools
