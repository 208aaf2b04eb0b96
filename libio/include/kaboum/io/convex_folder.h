#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <string>

namespace kaboum::io {

/// write_convex_set into a folder, with a choice of its files' format. Where a folder holds no STL
/// file, read_convex_set takes its OBJ files for bodies.
/// @param stem    of the files: engines tell meshes apart by it. No separators of paths.
/// @param bodies  Stl or Obj
/// @throws as write_convex_set
void write_convex_folder(const std::filesystem::path& path, const geom::ConvexSet& set,
                         const std::string& stem, Format bodies);

}  // namespace kaboum::io
