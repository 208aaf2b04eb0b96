#pragma once

#include <kaboum/geom/mesh.h>

#include <string>
#include <vector>

/// What the module that reads STEP and IGES (libio/cad) gives to the reader that has loaded it.
namespace kaboum::io {

struct CadShape {
  std::vector<geom::Vec3> points;  ///< millimetres
  std::vector<geom::Triangle> triangles;
  std::vector<std::string> solids;  ///< a name each, perhaps empty
  std::size_t faces = 0;            ///< one for each place of a face
  std::size_t loose_faces = 0;      ///< in no solid
  std::size_t bare_faces = 0;       ///< that could not be made into triangles
  /// No point of the exact faces and edges is farther from the triangles, by the proof in
  /// docs/algorithms/cad.md.
  double deviation = 0;
  double gap = 0;                ///< of edges beside their faces, a part of the deviation
  std::string worst, worst_gap;  ///< what they were found at
  std::size_t pieces = 0;        ///< of faces and edges that were bounded
  std::string error;             ///< why nothing was read; empty if something was
};

/// The module's only function. Catches everything.
/// @param path  of a file that can be opened and read
using ReadCad = void(const char* path, bool iges, CadShape& result);
constexpr const char* kReadCad = "kaboum_read_cad";
constexpr const char* kCadModule = "libkaboum_cad.so";

}  // namespace kaboum::io
