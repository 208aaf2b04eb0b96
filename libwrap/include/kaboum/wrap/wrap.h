#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <functional>
#include <string>

namespace kaboum::wrap {

struct WrapOptions {
  /// How far the wrap may be from the input where it can get near it; > 0. [length]
  double offset = 0;
  /// Hollows that no ball of this diameter can reach from outside without touching the input are
  /// filled; > 0. Also the scale of the search: time and memory grow with its inverse. [length]
  double seal = 0;
  /// No point of the wrap is nearer to the input than this, so that all that is so near to a
  /// triangle is inside as well; ≥ 0, and below a third of the offset. [length]
  double clearance = 0;
  /// The wrap's coordinates are float32 numbers; else any doubles.
  bool float32 = true;
  std::size_t max_cells = std::size_t{1} << 31U;  ///< of the lattice
  std::function<void(const std::string& stage)> progress;
};

/// A closed chain of triangles that encloses others.
struct Wrap {
  /// Each edge is run through as often one way as the other. Every triangle of the input lies off
  /// the mesh, and the mesh winds at least once round it: docs/algorithms/wrapping.md.
  geom::Mesh mesh;
  double cell = 0;                  ///< side of the lattice's cells [length]
  std::size_t cells = 0;            ///< of the lattice
  std::size_t first_triangles = 0;  ///< of the boundary of cells that the search began with
};

/// An enclosing closed mesh of any triangles: open, crossing each other, wrongly oriented.
///
/// Starts from the boundary of the cells of a lattice that cannot be reached from outside by a ball
/// of diameter `seal`, and moves, splits and contracts it as near to the input as it may: each step
/// adds tetrahedra to the chain of which none meets the input, so that the winding number round the
/// input stays. docs/algorithms/wrapping.md has the proof. How far the wrap reaches is not promised
/// by this function: measure it (geom::directed_distance).
///
/// The result does not depend on the number of threads.
///
/// @throws Error{InvalidInput} when the input has no triangles, numbers that are not finite, or
///   coordinates too large for lattice and precision; Error{InvalidArgument} on lengths that are
///   not positive, or a clearance too large for the offset; Error{LimitReached} when the lattice
///   would have more than max_cells.
Wrap wrap(const geom::Mesh& input, const WrapOptions& options);

}  // namespace kaboum::wrap
