#pragma once

#include <kaboum/geom/mesh.h>

#include <string>

namespace kaboum::tools {

/// Refuses names of files that do not hold doubles. Empty: none is asked for.
/// @throws Error{InvalidArgument}
void require_witness_format(const std::string& path);

/// Writes what refutes a claim, in doubles.
/// @param comment  what the triangles are
/// @throws Error{OutputFailed}
void write_witness(const std::string& path, const geom::Mesh& mesh, const std::string& comment);

}  // namespace kaboum::tools
