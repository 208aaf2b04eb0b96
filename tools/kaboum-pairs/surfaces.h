#pragma once

#include <kaboum/pairs/decide.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/robot_file.h>

#include <string>
#include <vector>

namespace kaboum::tools {

/// The shapes of a robot's links as meshes that hold them, and that lie in them. Mesh files get
/// their solid as in all programs, with all of their triangles; what fills holes is of the outer
/// mesh only. Where the solid of a mesh is a guess, the outer mesh shuts off all that it may be;
/// where a shape is not known, the link is unsure.
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} where a mesh cannot be read
std::vector<pairs::LinkSurface> surfaces_of(const robot::RobotFile& robot,
                                            const robot::ShapeChoice& choice,
                                            std::vector<std::string>& notes);

}  // namespace kaboum::tools
