#pragma once

#include <kaboum/bmesh/decimate.h>

#include <vector>

#include "quadric.h"

namespace kaboum::bmesh {

/// What contractions cost before anything is measured: the quadrics that vertices carry and the
/// keys by which edges are ordered.
class CostModel {
 public:
  /// Keeps a reference to the options, which must outlive this object.
  CostModel(const DecimateOptions& options, const geom::Box3& box);

  /// The quadric of every vertex of the input.
  [[nodiscard]] std::vector<Quadric> initial(const geom::Mesh& mesh) const;

  /// The quadric of the vertex that replaces two at pa and pb.
  [[nodiscard]] Quadric merged(const Quadric& a, const Quadric& b, const Vec3& pa,
                               const Vec3& pb) const {
    return adapted_ ? adapted(a, b, pa, pb) : a + b;
  }

  /// Key of a contraction of an edge of that squared length to the place given.
  [[nodiscard]] double key(const Quadric& q, const Vec3& place, double squared_length) const;

  /// What the key of an edge from pa to pb is expected to be: found without the half-spaces. The
  /// constrained minimum is several times this one; edges that enter the queue with less than they
  /// cost are evaluated long before they are due, mostly in vain.
  [[nodiscard]] double expected_key(const Quadric& q, const Vec3& pa, const Vec3& pb) const;

  /// The key without half-spaces and preference of short edges.
  [[nodiscard]] double least_key(const Quadric& q, const Vec3& pa, const Vec3& pb) const;

  /// Whether planes count by the area of their triangles.
  [[nodiscard]] bool by_area() const {
    return options_.cost == Cost::Distance || options_.cost == Cost::Mean;
  }
  [[nodiscard]] double regularisation() const { return regularisation_; }

  /// Quadrics are relative to it, lest they cancel far from the coordinates' origin.
  [[nodiscard]] const Vec3& origin() const { return origin_; }

 private:
  [[nodiscard]] Quadric adapted(const Quadric& a, const Quadric& b, const Vec3& pa,
                                const Vec3& pb) const;
  [[nodiscard]] double to_key(const Quadric& q, double value) const;
  [[nodiscard]] double free_minimum(const Quadric& q, const Vec3& pa, const Vec3& pb) const;

  const DecimateOptions& options_;
  bool adapted_;         // quadrics are not simply added
  double anticipation_;  // of the constrained minimum, as a multiple of the unconstrained one
  double regularisation_;
  Vec3 origin_;
};

}  // namespace kaboum::bmesh
