#pragma once

#include <kaboum/bmesh/log.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kaboum::bmesh {

/// A series of bounding meshes in one: the mesh that decimation began with, its steps, and where
/// the levels are among them. Layout of the file: docs/formats.md.
struct Progressive {
  struct Level {
    std::size_t requested = 0;  ///< number of vertices asked for
    std::size_t vertices = 0;   ///< number of vertices there
    std::size_t steps = 0;      ///< how many lead to it
  };

  Log log;                        ///< of all levels: of the input file, as `bmesh-replay` reads it
  bool double_precision = false;  ///< results were asked for in double
  geom::Mesh base;                ///< as prepared
  std::vector<Level> levels;      ///< finest first: `requested` falls, `steps` never does
};

std::vector<char> serialise_progressive(const Progressive& progressive);

/// @throws Error{InvalidInput} on bytes without their checksum, malformed or truncated ones,
/// indices
///   out of range, coordinates that are not finite, levels out of order.
Progressive parse_progressive(std::span<const char> bytes, const std::string& name);

}  // namespace kaboum::bmesh
