#pragma once

#include <kaboum/bmesh/decimate.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "fold.h"
#include "placement.h"
#include "reference_solid.h"
#include "sampled_error.h"
#include "support_planes.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

double area(const std::array<Vec3, 3>& triangle);

/// The step at hand of an optimiser: the triangles that it takes away and puts
/// in their place, the points at which these are measured, places that only the
/// original bounds, not the present mesh, and the exact certificate against the
/// original's solid. docs/algorithms/bounding-mesh.md, "Steps against the
/// original".
class StarStep {
 public:
  struct Ring {  // one triangle of the star: (v, p, q)
    std::uint32_t triangle;
    std::uint32_t p, q;
  };

  /// All references must outlive this object. `solid` may be null for
  /// Direction::Any only, `steps` when nobody asks for them.
  StarStep(WorkingMesh& mesh, SampledError& sampled, ReferenceSolid* solid,
           const geom::Mesh& original, const DecimateOptions& options,
           DecimateStatistics& statistics, std::vector<Step>* steps);

  /// Whether new triangles are measured at more points.
  void set_dense(bool dense) { dense_ = dense; }

  /// Fills ring and removed with the star of v. @return whether v may move.
  bool gather(std::uint32_t v);

  /// Fills added and points: the star of the vertex at `apex`, and the points
  /// at which it is measured, which remember where the original was near
  /// before.
  void place_star(const Vec3& apex);

  /// Makes vicinity hold the original near the star, of which the last point, at the apex, is
  /// located.
  void look_around_star(const Vec3& apex, std::uint32_t& hint);

  /// Fills support: the planes of the star, and the original near its triangles
  /// beyond them.
  void bound_by_star();

  /// Fills objective: squared distances of the samples and of the points, which
  /// are located, linear in the displacement of the vertex at the apex,
  /// weighted by how far they are: (d / scale)².
  void linearise(const Vec3& apex, double scale, double penalty = 1);

  /// Whether a triangle of the star turns over when its vertex goes to `to`.
  [[nodiscard]] bool folds(const Vec3& to) const;

  /// Exact, for inner meshes: triangles of `added`, whose apex is `to`, in the
  /// planes of those whose indices they take keep their orientation, and cannot
  /// cancel.
  [[nodiscard]] bool stays_flat(const Vec3& to);

  /// Exact: the tetrahedron between triangle t and the point leaves the
  /// original's solid alone; inwards, it also lies in it.
  [[nodiscard]] bool certified(std::uint32_t t, const Vec3& to);

  /// Exact: no tetrahedron between a triangle that goes and `to` cuts into the
  /// original. Where one does, the parts cut off become constraints in support,
  /// whose triangle i belongs to gone[i] if `own`.
  bool does_not_cut_original(std::span<const std::uint32_t> gone, bool own, const Vec3& to);

  /// As of Optimiser.
  std::optional<Vec3> place_against_original(std::span<const std::uint32_t> gone,
                                             std::span<const NewTriangle> come,
                                             const Quadric& quadric, const Vec3& origin);
  bool is_certified(std::span<const std::uint32_t> gone, const Vec3& to);
  std::optional<Vec3> next_place();

  /// Carries out the move of v that removed and added describe.
  void move(std::uint32_t v, const Vec3& to);

  /// How far rounding moves coordinates near p, at least.
  [[nodiscard]] Vec3 rounding(const Vec3& p) const;

  std::vector<Ring> ring;
  std::vector<std::uint32_t> removed;
  std::vector<NewTriangle> added;
  std::vector<SampledError::Point> points;
  ClosestTriangle::Vicinity vicinity;  ///< of a star
  SupportPlanes support;
  std::vector<HalfSpace> planes;
  Quadric objective;  ///< of the displacement

 private:
  [[nodiscard]] bool may_cut_original(std::uint32_t t, const Vec3& to);
  [[nodiscard]] Tetrahedron between(std::uint32_t t, const Vec3& to) const;
  void look_around(std::span<const std::uint32_t> gone, const Vec3& to);

  WorkingMesh& m_;
  SampledError& sampled_;
  ReferenceSolid* solid_;
  const geom::Mesh& original_;
  const DecimateOptions& options_;
  DecimateStatistics& statistics_;
  std::vector<Step>* steps_;
  bool dense_ = false;
  std::vector<std::uint32_t> met_;
  ReferenceSolid::Surroundings around_;  // of a star that was tested
  std::vector<Vec3> flat_;
  Vec3 apex_ = Vec3::Zero();  // of support, when it settles a contraction
};

}  // namespace kaboum::bmesh
