#pragma once

#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/predicates.h>

#include <vector>

#include "bucket_queue.h"
#include "change.h"
#include "cost.h"
#include "edge_star.h"
#include "fold.h"
#include "placement.h"
#include "reference_solid.h"
#include "work.h"
#include "working_mesh.h"

namespace kaboum::bmesh {

/// What all contractions of a run have in common.
struct Context {
  /// Keeps a reference to the options, which must outlive this object, and none to the mesh.
  /// @param counter  of what is done, for as long; may be null.
  Context(const geom::Mesh& input, bool is_closed, const DecimateOptions& requested,
          Work* counter = nullptr);

  const DecimateOptions& options;
  CostModel cost;
  double sign;  // of half-spaces that new vertices must be in
  bool constrained;
  bool closed;
  double diagonal;
  /// No vertex goes farther from the origin, whatever it costs: half the box,
  /// and its diagonal more on every side.
  Vec3 clamp_box;
  Work* work;

 private:
  Context(const geom::Box3& box, bool is_closed, const DecimateOptions& requested, Work* counter);
};

/// What contracting an edge would do, and whether it may be done: the place of
/// the new vertex, the exact tests that the certificate rests on, and the tests
/// that serve quality only. Source: [gaschler2016] Alg. 1.
class CollapseEvaluator {
 public:
  struct Candidate {
    std::uint32_t a = 0, b = 0;
    Vec3 position = Vec3::Zero();
    double cost = 0;
    Vec3 enclosing = Vec3::Zero();  // the place that the present mesh bounds
    bool encloses = false;          // there is one
    bool against_original = false;  // the position is one that the original bounds
  };

  enum class Validity {
    None,   // there is no valid position
    Later,  // the cost is known and not due; nothing was tested
    Valid,
  };
  enum class Purpose {
    Any,              // all tests are made
    Due,              // only of what is due
    AgainstOriginal,  // positions that the present mesh does not bound will do
                      // to begin with
  };

  /// References must outlive this object, as the context must. `solid` may be
  /// null: then inner surfaces are not kept from folding.
  CollapseEvaluator(const Context& context, const WorkingMesh& mesh, ReferenceSolid* solid,
                    DecimateStatistics& statistics);

  /// Fills the candidate with the cheapest valid position for the edge (a, b),
  /// with quadric q.
  Validity evaluate(std::uint32_t a, std::uint32_t b, const Quadric& q, Purpose purpose,
                    const BucketQueue& queue);

  /// Finds a place for v alone, near where it is, that keeps `care` times as
  /// far from the planes as rounding asks for, and makes all tests; unless
  /// `may_fold`, that of folds, which no certificate rests on.
  bool evaluate_move(std::uint32_t v, double care, bool may_fold = false);

  /// Moves the candidate to another place, if no triangle folds there.
  bool place_against_original(const Vec3& place, const Quadric& q);

  /// The dearer tests, made only of candidates that are about to be applied: no
  /// fold on the inner side, convexity where it is to be kept. Exact.
  [[nodiscard]] bool keeps_shape();

  /// The triangles that the candidate takes away and puts in their place.
  void describe(std::vector<std::uint32_t>& removed, std::vector<NewTriangle>& added) const {
    star_.describe(candidate_.position, removed, added);
  }

  [[nodiscard]] Candidate& candidate() { return candidate_; }

  /// The vertices that share a triangle with v; valid until the next call of
  /// anything.
  const std::vector<std::uint32_t>& neighbours(std::uint32_t v) { return star_.neighbours(v); }

 private:
  using StarTriangle = EdgeStar::StarTriangle;

  /// Whether the new vertex must stay on or below the triangles across the
  /// star's boundary.
  [[nodiscard]] bool has_rim() const {
    return options_.keep_convex && options_.direction != Direction::Inner;
  }
  [[nodiscard]] double step_bound() const;
  [[nodiscard]] bool place(const Quadric& q, double care);
  void snap_to_axis_planes(double distance);
  [[nodiscard]] bool at_end_point();
  [[nodiscard]] bool can_lie_on(std::uint32_t t) const;
  [[nodiscard]] geom::Sign side(std::uint32_t t);
  [[nodiscard]] bool encloses();
  [[nodiscard]] bool folds() const;
  [[nodiscard]] bool is_too_far_out() const;
  [[nodiscard]] bool stays_inside();
  [[nodiscard]] bool stays_convex();
  void find_cost(const Quadric& q);

  const Context& context_;
  const DecimateOptions& options_;
  const WorkingMesh& m_;
  ReferenceSolid* solid_;
  DecimateStatistics& statistics_;

  Candidate candidate_;
  EdgeStar star_;
  std::vector<HalfSpace> planes_;
  std::vector<Vec3> flat_;  // normals of triangles in whose plane the new vertex is
};

}  // namespace kaboum::bmesh
