#pragma once

#include <kaboum/geom/mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::io {

/// Triangles that stand for the exact faces of a CAD file.
struct CadMesh {
  geom::Mesh
      mesh;  ///< millimetres; equal positions merged, triangles with repeated corners dropped
  std::size_t collapsed_triangles = 0;  ///< dropped
  /// The exact faces are no farther from the triangles than this, as measured: twice the largest
  /// distance at samples, and the file's own tolerance (docs/formats.md). [length]
  double deviation = 0;
  std::vector<std::string> notes;
};

/// Whether the name is that of a STEP or IGES file, by its extension.
bool is_cad_file(const std::filesystem::path& path);

/// Reads STEP or IGES through OpenCASCADE, a module that is loaded in a child process with limits
/// of memory and time.
/// @param bytes_out  the file's bytes, when not null
/// @throws Error{NotBuilt} where the module is not there; Error{InvalidInput} when the file cannot
///   be read, naming it.
CadMesh read_cad(const std::filesystem::path& path, std::vector<char>* bytes_out = nullptr);

}  // namespace kaboum::io
