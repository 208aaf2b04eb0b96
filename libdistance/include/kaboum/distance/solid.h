#pragma once

#include <kaboum/distance/boundary.h>
#include <kaboum/distance/minimum.h>
#include <kaboum/geom/directed_distance.h>

#include <memory>

namespace kaboum::distance {

/// A solid: the closure of the points with a winding number of at least 1 of a closed chain, or
/// the union of convex bodies; membership is decided exactly, the boundary is at hand. A set's
/// margin (geom::margin_of) is kept apart: `boundary` and `contains` are those of the bodies
/// without it. For sets that have none, since radii differ or cores are segments and points,
/// polytopes within the bodies stand, and results are widened by what these lack.
class Solid final : public geom::Interior {
 public:
  /// @throws Error{InvalidInput} if the triangles form no closed chain, or the solid is empty.
  explicit Solid(const geom::Mesh& mesh);
  /// @throws Error{InvalidInput} naming a body that is not convex; if there is none.
  explicit Solid(const geom::ConvexSet& set);
  ~Solid() override;

  [[nodiscard]] const Boundary& boundary() const { return boundary_; }
  [[nodiscard]] double margin() const { return margin_; }
  /// No point of the solid is farther from the polytopes that stand for bodies; 0 where none do.
  [[nodiscard]] double defect() const { return defect_; }
  /// The bodies, or the polytopes that stand for them; none if it is a mesh's.
  [[nodiscard]] const geom::ConvexSet& set() const { return set_; }

  /// Distance of a point from the solid, margin included, given its distance from the boundary
  /// without it.
  [[nodiscard]] double distance(const geom::Vec3& p, double to_boundary) const;

  [[nodiscard]] std::optional<bool> contains(const geom::Vec3& p, double free = 0) const override;
  [[nodiscard]] bool covers_ball(const geom::Vec3& center, double radius,
                                 double distance) const override;
  [[nodiscard]] bool covers(std::span<const geom::Vec3> corners, double slack) const override;

  /// Sides and corners of a triangle of the boundary at which points outside may have their nearest
  /// point of the solid other than above the triangle: bit k for the side from corner k, 3 + k for
  /// corner k. Sides that are flat, or sunk between their triangles, are not among them.
  [[nodiscard]] unsigned exposed(std::uint32_t triangle) const { return exposed_[triangle]; }

  /// Triangles of the boundary whose boxes reach within `radius` of p; their number stops at
  /// `most`.
  /// @return false if there are more.
  bool near(const geom::Vec3& p, double radius, std::size_t most,
            std::vector<std::uint32_t>& triangles) const;

 private:
  void prepare();
  void find_exposed();

  struct Members;
  std::unique_ptr<Members> members_;
  geom::ConvexSet set_;
  double margin_ = 0, defect_ = 0;
  Boundary boundary_;
  geom::Bvh bvh_;  // of the boundary
  std::vector<std::uint8_t> exposed_;
  double magnitude_ = 0;
};

/// Result of the search inside A's solid.
struct SolidDistance : geom::DirectedDistance {
  bool inside = false;      ///< `at` lies inside A's solid rather than on its boundary
  std::uint64_t cells = 0;  ///< of space that were looked at
};

/// sup over x ∈ S(A) of d(x, S(B)), margins included; 0 where S(A) lies in S(B).
///
/// The supremum is attained on the boundary of S(A), or at a local maximum of the distance to the
/// boundary of S(B) inside S(A). The boundary is searched as surfaces are
/// (geom::directed_distance); space is searched by branch and bound over tetrahedra, which are
/// dropped where they lie in S(B), outside S(A), or hold no local maximum:
/// docs/algorithms/distances.md, "Solids". Deterministic on any number of threads.
///
/// B's margin is exact; A's is approached by inscribed polytopes, the rest of which is added to the
/// upper bound.
///
/// @param boundary_a, boundary_b  search structures over a.boundary().mesh and b.boundary().mesh.
SolidDistance solid_distance(const Solid& a, const Solid& b, const geom::TriangleSearch& boundary_a,
                             const geom::TriangleSearch& boundary_b,
                             const geom::DistanceOptions& options = {});

/// min over x ∈ S(A), y ∈ S(B) of |x − y|, margins included; [0, 0] where the solids certainly have
/// a point in common.
Minimum solid_minimum(const Solid& a, const Solid& b);

}  // namespace kaboum::distance
