#pragma once

#include <kaboum/bmesh/decimate.h>

#include "error_bound_certificate.h"
#include "neighbour_collapse.h"
#include "optimiser_context.h"
#include "placement.h"
#include "reference_solid.h"
#include "sampled_error.h"
#include "star_step.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// Gives back what decimation has added beyond need: moves vertices towards the
/// original and flips edges, so that the deviation falls. Source:
/// [gaschler2016] §7.2 names it as future work; how the steps are certified:
/// docs/algorithms/bounding-mesh.md, "Steps against the original".
///
/// Every step keeps: the exact certificate against the original's solid (unless
/// direction is Any), the carried error bound, border vertices, and float32
/// coordinates where they are asked for.
///
/// Several optimisers of one mesh, with the same notes and no error bound, may
/// pull back and collapse at once where none moves a vertex that another one
/// moves, or a neighbour of such a vertex.
class Optimiser : private OptimiserContext {
 public:
  /// What the references are to must outlive this object. `solid` may be null for Direction::Any
  /// only.
  Optimiser(const OptimiserContext& context, ReferenceSolid* solid, const geom::Mesh& original);
  Optimiser(const Optimiser&) = delete;
  Optimiser& operator=(const Optimiser&) = delete;
  ~Optimiser() = default;

  /// Whether new triangles are measured at more points.
  void set_dense(bool dense) { step_.set_dense(dense); }

  /// Moves v to a better place, if there is one. @return whether it has moved.
  bool pull_back(std::uint32_t v, bool alone = true);

  /// Seeks for a vertex that is to replace the star `removed` by the triangles
  /// `added`, whose first corners are where it is now, a place that only the
  /// original bounds, not the present mesh.
  ///
  /// @param quadric  to be minimised, relative to `origin`.
  /// @return the place, where float32 is asked for rounded; nullopt when there
  /// is none.
  std::optional<Vec3> place_against_original(std::span<const std::uint32_t> removed,
                                             std::span<const NewTriangle> added,
                                             const Quadric& quadric, const Vec3& origin) {
    return step_.place_against_original(removed, added, quadric, origin);
  }

  /// Whether the place that `place_against_original` has returned is certified.
  /// What would be cut off the original is remembered otherwise, and
  /// `next_place` seeks another place.
  bool is_certified(std::span<const std::uint32_t> removed, const Vec3& to) {
    return step_.is_certified(removed, to);
  }
  std::optional<Vec3> next_place() { return step_.next_place(); }

  /// Flips the edge (a, b) if that is better. @return whether it was flipped.
  bool flip(std::uint32_t a, std::uint32_t b);

  /// To be called when others have changed the star of v.
  void disturb(std::uint32_t v);

  /// Contracts the edge (a, b) and moves the vertices around with it, if the
  /// deviation around stays within `limit` then. [length]
  /// @return 0 if that was done, else the deviation that it would take,
  /// roughly; infinite where no
  ///   place can be certified.
  double collapse_with_neighbours(std::uint32_t a, std::uint32_t b, double limit);

  /// Moves v to a representable place near by that the original bounds, though
  /// the present mesh may not. @return whether it has moved.
  bool snap_to_float(std::uint32_t v);

 private:
  friend class NeighbourCollapse;

  bool move_towards(std::uint32_t v, const Vec3& target, bool alone);

  StarStep step_;
  NeighbourCollapse collapse_;
};

}  // namespace kaboum::bmesh
