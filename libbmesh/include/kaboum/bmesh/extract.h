#pragma once

#include <kaboum/bmesh/progressive.h>

namespace kaboum::bmesh {

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
/// nothing checked but that the steps can be taken: verify::replay_progressive does that.
///
/// @throws Error{InvalidInput} when a step cannot be taken or a level has not the vertices it says.
Extracted extract(const Progressive& progressive, std::size_t vertices, const std::string& name);

}  // namespace kaboum::bmesh
