#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::geom {

struct PrepareOptions {
  bool drop_sheets = false;       ///< drop opposite coincident faces without volume, with a note
  bool require_closed = false;    ///< refuse open meshes
  bool keep_orientation = false;  ///< never turn a triangle
};

/// A mesh whose solid is defined, and how it came from the input.
struct Prepared {
  /// Welded, without unused vertices; vertices in the order of their first use by the triangles
  /// left, as the input orients these.
  Mesh mesh;
  std::vector<std::uint32_t> source;  ///< per triangle: its index in the input
  std::vector<char> turned;           ///< per triangle: orientation reversed
  std::vector<char> border;           ///< per vertex: lies on an unbalanced edge and must not move
  bool closed = true;                 ///< the triangles form a closed chain
  std::uint32_t components = 0;       ///< connected by shared edges
  std::size_t collapsed_triangles = 0;  ///< dropped: repeated corners
  std::size_t dropped_copies = 0;       ///< dropped: identically oriented copies
  std::size_t cancelled_walls = 0;      ///< dropped: triangles in opposite pairs inside the solid
  std::size_t dropped_sheets = 0;     ///< dropped: triangles in opposite pairs outside, on request
  std::size_t turned_components = 0;  ///< inside out, turned as a whole
  std::size_t turned_triangles = 0;   ///< against their neighbours or in a turned component
  std::vector<std::string> notes;
};

/// Gives the input a solid, or says why it has none.
///
/// In this order: equal vertices are merged and triangles with repeated corners dropped;
/// inconsistent neighbours are turned to agree; opposite coincident faces inside the solid (walls
/// between touching bodies) cancel; identically oriented copies are dropped where what is dropped
/// is itself a closed chain; a component whose inside would have a negative winding number is
/// turned together with all that is nested in it. A cavity (a component oriented inwards, inside
/// another) stays a cavity, and a body inside another body stays a body: the solid never shrinks by
/// a turn.
///
/// @throws Error{InvalidInput} when no solid can be given: no triangles, a one-sided surface,
/// sheets
///   (unless dropped on request), nothing left, or open while `require_closed`.
Prepared prepare(const Mesh& input, const PrepareOptions& options = {});

}  // namespace kaboum::geom
