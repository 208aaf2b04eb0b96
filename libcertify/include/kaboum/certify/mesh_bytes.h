#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/io/mesh_io.h>

#include <string>
#include <vector>

namespace kaboum::certify {

/// The bytes of a mesh file, read back and compared: what is written is what was certified.
/// @throws Error{Internal} when they do not hold the mesh; Error as io::serialise_mesh.
std::vector<char> serialise_checked(const geom::Mesh& mesh, io::Format format,
                                    bool double_precision, const std::string& comment);

}  // namespace kaboum::certify
