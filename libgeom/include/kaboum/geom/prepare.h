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
  std::vector<std::uint32_t> source;              ///< per triangle: its index in the input
  std::vector<char> turned;                       ///< per triangle: orientation reversed
  std::vector<std::uint32_t> turned_and_dropped;  ///< input triangles: turned first, dropped later
  std::vector<char> border;      ///< per vertex: lies on an unbalanced edge and must not move
  bool closed = true;            ///< the triangles form a closed chain
  std::uint32_t components = 0;  ///< connected by shared edges
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
/// between touching bodies) cancel; components that are inside out are turned; identically oriented
/// copies are dropped where what is dropped is itself a closed chain and nothing is oriented
/// inwards.
///
/// A component of negative volume is a cavity, and stays one, if all of its corners lie in the
/// solid of the others; otherwise it is inside out. It is turned together with what lies inside it
/// if that nest has no solid of its own (a file inside out as a whole), else alone. A body inside
/// another body stays a body. Components that cross themselves or each other are judged by volumes
/// and corners.
///
/// Claims about a result are claims about this mesh; the counts below say how it differs from the
/// input.
///
/// @throws Error{InvalidInput} when no solid can be given: no triangles, a one-sided surface,
/// sheets
///   (unless dropped on request), nothing left, open while `require_closed`, coordinates beyond
///   1e60 or an extent below 1e-60 (their products would overflow or vanish).
Prepared prepare(const Mesh& input, const PrepareOptions& options = {});

}  // namespace kaboum::geom
