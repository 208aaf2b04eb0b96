#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <functional>
#include <string>

namespace kaboum::wrap {

struct WrapOptions {
  /// Largest distance of the wrap from the input where it can get near it; > 0. [length]
  double offset = 0;
  /// Hollows that no ball of this diameter can reach from outside without touching the input are
  /// filled; > 0. Also the scale of the search: time and memory grow with its inverse. [length]
  double seal = 0;
  /// No point of the wrap is nearer to the input than this, so that all that is so near to a
  /// triangle is inside as well; ≥ 0, and below a third of the offset. [length]
  double clearance = 0;
  /// The wrap's coordinates are float32 numbers; else any doubles.
  bool float32 = true;
  std::size_t max_points = std::size_t{1} << 22U;  ///< of the tetrahedra that are carved
  std::function<void(const std::string& stage)> progress;
};

/// True if float32 numbers are near enough to each other for a wrap of what is in the box.
bool float32_is_fine(const geom::Box3& box, const WrapOptions& options);

/// A closed surface that encloses triangles.
struct Wrap {
  /// Closed, manifold and free of self-intersections, decided exactly. Every triangle of the input
  /// lies off the mesh, and inside: docs/algorithms/wrapping.md.
  geom::Mesh mesh;
  std::size_t points = 0;           ///< of the tetrahedra that were carved
  std::size_t first_triangles = 0;  ///< of what was carved, with which the search began
};

/// An enclosing closed mesh of any triangles: open, crossing each other, wrongly oriented.
///
/// Carves Delaunay tetrahedra from outside, as far as a ball of diameter `seal` gets, and moves,
/// splits and contracts their boundary as near to the input as it may. Each step adds tetrahedra of
/// which none meets the input, and new triangles that meet no others. docs/algorithms/wrapping.md
/// has the proof. How far the wrap reaches is not promised by this function: measure it
/// (geom::directed_distance).
///
/// The result does not depend on the number of threads.
///
/// @throws Error{InvalidInput} when the input has no triangles, numbers that are not finite, or
///   coordinates too large for `seal` and the precision, or a size beyond 1e±40.
///   Error{InvalidArgument} on lengths that are not positive, or a clearance too large for the
///   offset; Error{LimitReached} when more than max_points are needed, or
///   an estimate says so.
Wrap wrap(const geom::Mesh& input, const WrapOptions& options);

}  // namespace kaboum::wrap
