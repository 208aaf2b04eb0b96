#pragma once

#include <kaboum/bmesh/decimate.h>

#include <atomic>

#include "error_bound_certificate.h"
#include "placement.h"
#include "reference_solid.h"
#include "sampled_error.h"
#include "support_planes.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// What the optimisers of one mesh know of its vertices.
struct VertexNotes {
  explicit VertexNotes(std::size_t vertices)
      : hint(vertices, 0), version(vertices, 0), movable(vertices, 1), flippable(vertices, 1) {}

  /// The star of v has changed. Safe to call from several threads.
  void disturb(std::uint32_t v) {
    std::atomic_ref(movable[v]).store(1, std::memory_order_relaxed);
    std::atomic_ref(flippable[v]).store(1, std::memory_order_relaxed);
    std::atomic_ref(version[v]).fetch_add(1, std::memory_order_relaxed);
  }

  std::vector<std::uint32_t> hint;     // where the original is near
  std::vector<std::uint32_t> version;  // raised when its star changes
  // Its star has changed since it was last tried in vain to move it, and since the last round of
  // flips.
  std::vector<char> movable, flippable;
};

/// Gives back what decimation has added beyond need: moves vertices towards the original and flips
/// edges, so that the deviation falls. Source: [gaschler2016] §7.2 names it as future work; how the
/// steps are certified: docs/algorithms/bounding-mesh.md, "Steps against the original".
///
/// Every step keeps: the exact certificate against the original's solid (unless direction is Any),
/// the carried error bound, border vertices, and float32 coordinates where they are asked for.
///
/// Several optimisers of one mesh, with the same notes and no error bound, may pull back and
/// collapse at once where none moves a vertex that another one moves, or a neighbour of such a
/// vertex.
class Optimiser {
 public:
  /// All references must outlive this object. `solid` may be null for Direction::Any only,
  /// `certificate` when there is no error bound, `steps` when nobody asks for them.
  Optimiser(WorkingMesh& mesh, VertexNotes& notes, SampledError& sampled, ReferenceSolid* solid,
            const geom::Mesh& original, ErrorBoundCertificate* certificate,
            const DecimateOptions& options, DecimateStatistics& statistics,
            std::vector<Step>* steps);

  /// Whether new triangles are measured at more points.
  void set_dense(bool dense) { dense_ = dense; }

  /// Moves v to a better place, if there is one. @return whether it has moved.
  bool pull_back(std::uint32_t v, bool alone = true);

  /// Seeks for a vertex that is to replace the star `removed` by the triangles `added`, whose first
  /// corners are where it is now, a place that only the original bounds, not the present mesh.
  ///
  /// @param quadric  to be minimised, relative to `origin`.
  /// @return the place, where float32 is asked for rounded; nullopt when there is none.
  std::optional<Vec3> place_against_original(std::span<const std::uint32_t> removed,
                                             std::span<const NewTriangle> added,
                                             const Quadric& quadric, const Vec3& origin);

  /// Whether the place that `place_against_original` has returned is certified. What would be cut
  /// off the original is remembered otherwise, and `next_place` seeks another place.
  bool is_certified(std::span<const std::uint32_t> removed, const Vec3& to);
  std::optional<Vec3> next_place();

  /// Flips the edge (a, b) if that is better. @return whether it was flipped.
  bool flip(std::uint32_t a, std::uint32_t b);

  /// To be called when others have changed the star of v.
  void disturb(std::uint32_t v);

  /// Contracts the edge (a, b) and moves the vertices around with it, if the deviation around stays
  /// within `limit` then. [length]
  /// @return 0 if that was done, else the deviation that it would take, roughly; infinite where no
  ///   place can be certified.
  double collapse_with_neighbours(std::uint32_t a, std::uint32_t b, double limit);

  /// Moves v to a representable place near by that the original bounds, though the present mesh may
  /// not. @return whether it has moved.
  bool snap_to_float(std::uint32_t v);

 private:
  struct Ring {  // one triangle of the star: (v, p, q)
    std::uint32_t triangle;
    std::uint32_t p, q;
  };

  /// A part of the mesh as it was: the triangles around some vertices, and these.
  struct Snapshot {
    std::vector<std::uint32_t> triangles, vertices;
    std::vector<geom::Triangle> corners;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> samples;
    std::size_t steps = 0, pull_backs = 0;
  };
  /// Where a point was when the original was last sought from it, how far, and where.
  struct Trail {
    Vec3 position;
    double distance;
    std::uint32_t nearest = SampledError::kNone;
  };

  void neighbours(std::uint32_t v, std::vector<std::uint32_t>& out);
  void take_snapshot(std::span<const std::uint32_t> vertices);
  void rollback();
  void relax_vertex(std::size_t i, double scale, double penalty, double share, bool hand_over);
  void follow(SampledError::Point& point, Trail& trail, double close, std::uint32_t& hint);
  double star_largest(std::uint32_t v, double limit);
  double region_largest(double limit);
  std::optional<Vec3> find_position(std::uint32_t a, std::uint32_t b, const Vec3& wish);
  double trial_collapse(std::uint32_t a, std::uint32_t b, double limit);
  bool satisfies_link_condition(std::uint32_t a, std::uint32_t b);
  bool gather_edge(std::uint32_t a, std::uint32_t b, const Vec3& to);
  void contract(std::uint32_t a, std::uint32_t b, const Vec3& to);
  void move(std::uint32_t v, const Vec3& to);

  /// How far rounding moves coordinates near p, at least.
  [[nodiscard]] Vec3 rounding(const Vec3& p) const;
  bool gather(std::uint32_t v);
  void place_star(const Vec3& apex);
  bool does_not_cut_original(std::span<const std::uint32_t> removed, bool own, const Vec3& to);
  void linearise(const Vec3& apex, double scale, double penalty = 1);
  bool move_towards(std::uint32_t v, const Vec3& target, bool alone);
  [[nodiscard]] bool folds(const Vec3& to) const;
  [[nodiscard]] bool stays_flat(const Vec3& to);
  [[nodiscard]] bool certified(std::uint32_t t, const Vec3& to,
                               std::vector<std::uint32_t>* met = nullptr);

  WorkingMesh& m_;
  VertexNotes& notes_;
  SampledError& sampled_;
  ReferenceSolid* solid_;
  const geom::Mesh& original_;
  ErrorBoundCertificate* certificate_;
  const DecimateOptions& options_;
  DecimateStatistics& statistics_;
  std::vector<Step>* steps_;

  bool dense_ = false;
  Snapshot snapshot_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t mark_value_ = 0;
  std::vector<std::uint32_t> around_;       // vertices that move with a contraction, it first
  std::vector<Vec3> target_;                // of these
  std::vector<std::vector<Trail>> trails_;  // of the points at which their stars are measured
  std::vector<std::uint32_t> alive_;

  // Of the step at hand.
  std::vector<Ring> ring_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
  std::vector<SampledError::Point> points_;
  SupportPlanes support_;
  std::vector<HalfSpace> planes_;
  std::vector<std::uint32_t> met_;
  std::vector<Vec3> flat_;
  Quadric objective_;         // of the displacement
  Vec3 apex_ = Vec3::Zero();  // of support_, when it settles a contraction
};

}  // namespace kaboum::bmesh
