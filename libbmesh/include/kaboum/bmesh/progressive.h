#pragma once

#include <kaboum/bmesh/log.h>
#include <kaboum/bmesh/replay.h>
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
    std::size_t wished = 0;    ///< number of vertices asked for
    std::size_t vertices = 0;  ///< number of vertices there
    std::size_t steps = 0;     ///< how many lead to it
  };

  Log log;                        ///< of all levels: of the input file, as `bmesh-replay` reads it
  bool double_precision = false;  ///< results were wished for in double
  geom::Mesh base;                ///< as prepared
  std::vector<Level> levels;      ///< finest first: `wished` falls, `steps` never does
};

std::vector<char> serialise_progressive(const Progressive& progressive);

/// @throws Error{InvalidInput} on bytes without their checksum, malformed or truncated ones,
/// indices
///   out of range, coordinates that are not finite, levels out of order.
Progressive parse_progressive(std::span<const char> bytes, const std::string& name);

/// A mesh taken from a progressive one.
struct Extracted {
  geom::Mesh mesh;
  /// Steps taken: those of the level, or all up to the last before the next contraction.
  std::size_t steps = 0;
  bool level = false;    ///< it is a level's mesh, triangle by triangle
  bool reached = false;  ///< it has no more vertices than asked for
};

/// The level that was asked for with this number, if there is one; else the largest mesh on the way
/// that has no more vertices; the coarsest where there is none. Nothing is computed anew, and
/// nothing checked but that the steps can be taken: replay_progressive does that.
///
/// @throws Error{InvalidInput} when a step cannot be taken or a level has not the vertices it says.
Extracted extract(const Progressive& progressive, std::size_t vertices, const std::string& name);

/// Checks as `replay` does, but the base mesh and all levels instead of one result: the base is the
/// original as the log interprets it; every step is certified, against the level before (the
/// original, before the first level) where the mesh before the step alone does not do so; and
/// every level has the number of vertices it says. So each level encloses (Inner: is enclosed by)
/// the level before and the original; docs/algorithms/bounding-mesh.md, "Series".
///
/// @param original  as read from the input file.
/// @throws Error{InvalidInput} when the log refers to triangles or vertices that do not exist.
ReplayResult replay_progressive(const geom::Mesh& original, const Progressive& progressive);

}  // namespace kaboum::bmesh
