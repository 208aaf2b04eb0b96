#pragma once

#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <vector>

namespace kaboum::io {

/// Triangles that stand for the exact faces of a CAD file.
struct CadResult {
  ReadResult read;  ///< millimetres; positions that faces share are one vertex of the file
  /// No point of the exact faces and edges is farther from the triangles: proved, not measured
  /// (docs/algorithms/cad.md). [length]
  double deviation = 0;
};

/// Whether the name is that of a STEP or IGES file, by its extension.
bool is_cad_file(const std::filesystem::path& path);

/// Reads STEP or IGES through OpenCASCADE, a module that is loaded in a child process with limits
/// of memory and time.
/// @param bytes_out  the file's bytes, when not null
/// @throws Error{NotBuilt} where the module is not there; Error{InvalidInput} when the file cannot
///   be read, or when it may hold shape that is not read: naming file and entity.
CadResult read_cad(const std::filesystem::path& path, std::vector<char>* bytes_out = nullptr);

}  // namespace kaboum::io
