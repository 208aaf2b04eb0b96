#pragma once

#include <kaboum/bmesh/log.h>
#include <kaboum/bmesh/progressive.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <functional>
#include <string>

namespace kaboum::verify {

/// Is told now and then how far a replay is; what it throws ends the work. May be empty.
using ReplayProgress = std::function<void(const std::string& stage)>;

struct ReplayResult {
  bool verified = false;
  std::string violation;               ///< what was found wrong, with the step; empty when verified
  bool closed = false;                 ///< the input, as interpreted, is a closed chain
  std::size_t steps = 0;               ///< replayed
  std::size_t levels = 0;              ///< of a progressive mesh, reached
  std::uint64_t predicates = 0;        ///< exact orientation tests
  std::uint64_t against_original = 0;  ///< tetrahedra tested against the original's solid
  std::size_t dropped = 0;             ///< input triangles that the log leaves out
  std::size_t reversed = 0;            ///< input triangles that the log turns
  std::size_t filled = 0;              ///< triangles that the log adds to fill holes
};

/// Derives a result again from its input and its log, and checks every step.
///
/// Shares no code with the decimation but the types: its own merging of vertices, its own
/// adjacency, CGAL's exact orientation predicate directly. Verified means:
/// - Dropped triangles have repeated corners, cancel in opposite pairs, or are copies that form
///   closed chains by themselves.
/// - Every step's new vertex is on the right side of, or on, the plane of every triangle it
///   replaces, or the tetrahedron between them has no triangle of the original in its interior and
///   lies outside its solid (inner: inside; not checked for bmesh::Direction::Any, which claims
///   nothing).
/// - No vertex of an unbalanced edge moves.
/// - The triangles left are exactly those of `result`, coordinate by coordinate.
///
/// Where no triangle of the original, as interpreted, or of the result has an area, nothing is
/// verified.
///
/// The original is taken as the log interprets it: turned triangles are applied and counted,
/// whether they should be turned is not checked. Dropped copies are checked to be closed chains
/// that also stay; they lower the winding number but, unless something is oriented inwards, not the
/// solid. Triangles that fill holes are added to those of the input, which stay as they are. With
/// them the mesh is checked to be a closed chain, and they to be triangles and fans on the rims of
/// holes, each from the mean of its rim (docs/algorithms/preparation.md).
///
/// @param original  as read from the input file.
/// @param result    as read from the result file.
/// @throws Error{InvalidInput} when the log refers to triangles or vertices that do not exist.
ReplayResult replay(const geom::Mesh& original, const bmesh::Log& log, const geom::Mesh& result,
                    const ReplayProgress& progress = {});

/// Checks as `replay` does, but the base mesh and all levels instead of one result:
/// - The base is the original as the log interprets it.
/// - Every step is certified, against the level before (the original, before the first level) where
///   the mesh before the step alone does not do so.
/// - Every level has the number of vertices it says.
///
/// So each level encloses (Inner: is enclosed by) the level before and the original;
/// docs/algorithms/bounding-mesh.md, "Series".
///
/// @param original  as read from the input file.
/// @throws Error{InvalidInput} when the log refers to triangles or vertices that do not exist.
ReplayResult replay_progressive(const geom::Mesh& original, const bmesh::Progressive& progressive,
                                const ReplayProgress& progress = {});

}  // namespace kaboum::verify
