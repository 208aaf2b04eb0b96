#pragma once

#include <kaboum/geom/convex_set.h>

#include <filesystem>
#include <string>

namespace kaboum::tools {

/// Writes the bodies of a set as the shapes, for collisions and for drawing, of the only link of a
/// robot that does not move, in the frame of the set: one STL per body in the folder NAME beside
/// NAME.urdf, which is written last.
/// @param prefix  of the files' names in the URDF, with a slash at its end; or empty.
/// @pre the set's margin is 0.
/// @throws Error{OutputFailed}, as io::write_convex_set.
void write_swept_urdf(const std::filesystem::path& path, const geom::ConvexSet& set,
                      const std::string& prefix);

}  // namespace kaboum::tools
