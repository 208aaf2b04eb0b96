#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <optional>

/// Whether one mesh encloses another, from the exact arrangement of all their triangles. Slow;
/// shares no code with the libraries but the Mesh struct: triangles are intersected and
/// triangulated by CGAL's exact kernel, winding numbers counted along exact lines. Both sides of
/// every cell of every triangle are looked at, so that nothing depends on an argument about which
/// sides matter.
namespace kaboum::test {

struct ArrangementVerdict {
  bool inner_closed = false, outer_closed = false;
  bool same_border = false;  ///< outer minus inner is a closed chain

  /// {w_inner ≥ 1} ⊆ {w_outer ≥ 1} off the surfaces. Both closed, else nullopt.
  std::optional<bool> solid;
  /// w_inner ≤ w_outer off the surfaces. Same border (so in particular when both are closed), else
  /// nullopt.
  std::optional<bool> difference;
  /// Every triangle of the inner mesh is in closure{w_outer ≥ 1}. Outer closed, else nullopt.
  std::optional<bool> surface;

  std::size_t cells = 0;          ///< of all triangles
  std::size_t intersections = 0;  ///< pairs of triangles that meet
  std::size_t solid_faults = 0, difference_faults = 0, surface_faults = 0;  ///< cell sides; cells
};

/// @pre indices in range, coordinates finite
ArrangementVerdict arrangement_verdict(const geom::Mesh& inner, const geom::Mesh& outer);

/// The mesh without its triangles of exactly no area, which bound nothing.
geom::Mesh with_area(geom::Mesh mesh);

}  // namespace kaboum::test
