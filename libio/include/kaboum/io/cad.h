#pragma once

#include <kaboum/io/mesh_io.h>

#include <filesystem>
#include <vector>

namespace kaboum::io {

/// Triangles that stand for the exact faces of a CAD file.
struct CadResult {
  ReadResult read;  ///< millimetres; positions that faces share are one vertex of the file
  /// The exact faces are no farther from the triangles than this, as measured: twice the largest
  /// distance at samples, and the file's own tolerance (docs/formats.md). [length]
  double deviation = 0;
};

/// Whether the name is that of a STEP or IGES file, by its extension.
bool is_cad_file(const std::filesystem::path& path);

/// Reads STEP or IGES through OpenCASCADE, a module that is loaded in a child process with limits
/// of memory and time.
/// @param bytes_out  the file's bytes, when not null
/// @throws Error{NotBuilt} where the module is not there; Error{InvalidInput} when the file cannot
///   be read, naming it.
CadResult read_cad(const std::filesystem::path& path, std::vector<char>* bytes_out = nullptr);

}  // namespace kaboum::io
