#pragma once

#include <kaboum/geom/convex_set.h>

#include <filesystem>

namespace kaboum::tools {

/// Writes the bodies of a set as the collision geometry of the only link of a robot, in the frame
/// of the set: one STL per body in the folder NAME beside NAME.urdf, which is written last.
/// @pre the set's margin is 0.
/// @throws Error{OutputFailed}, as io::write_convex_set.
void write_swept_urdf(const std::filesystem::path& path, const geom::ConvexSet& set);

}  // namespace kaboum::tools
