#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/region.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/points.h>
#include <kaboum/verify/subject.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Relation of an approximation to its original: it encloses it, is enclosed by it or, as a set of
/// convex bodies, covers it.
enum class Relation { Outer, Inner, Cover };

/// Question about an original and its approximation.
struct MeshQuestion {
  const geom::Mesh& original;
  const geom::Mesh& approximation;       ///< or the sum of the bodies of `set`
  const geom::ConvexSet* set = nullptr;  ///< the approximation, where it is one
  Relation relation = Relation::Outer;
  Claims claims = Claims::All;    ///< those that decide
  std::optional<double> bound{};  ///< of the distances, above 0 and the set's margin [length]
  std::size_t max_contacts = InclusionOptions{}.max_contacts;
  std::optional<double> max_work{};  ///< of each inclusion, as InclusionOptions [s]
  std::function<void(const std::string&)> progress{};  ///< called with what is being done
  /// Points of the exact faces that the original's triangles stand for, which are to be enclosed or
  /// covered as well. Not looked at of Inner.
  std::optional<PointQuestion> exact_points{};
  /// The original as a Subject: whether it is to be held whichever way it is oriented, and
  /// which triangles are besides. Not looked at of Inner; null: the original is all.
  const Subject* subject = nullptr;
  /// Mesh that a cover's distances are measured to, closed; null: the original.
  const MeasuredMesh* measured = nullptr;
  /// Of a cover: bounds of the distances of what lies in regions. [length]
  std::vector<geom::BoundedRegion> regions{};

  [[nodiscard]] const geom::Mesh& inner() const {
    return relation == Relation::Inner ? approximation : original;
  }
  [[nodiscard]] const geom::Mesh& outer() const {
    return relation == Relation::Inner ? original : approximation;
  }
};

/// Distance of which a bound is claimed.
enum class Between {
  ApproximationToOriginal,
  OriginalToApproximation,
  UnionToSolid,     ///< from the union of the bodies, margin included
  FacetsToSurface,  ///< from the bodies' facets, as the original is open
};

/// "distance from the union to the solid".
const char* name_of(Between between);

/// What was decided of the bodies' points in a region.
struct RegionVerdict {
  geom::BoundedRegion region;
  DistanceClaim claim;
};

struct DistanceVerdict {
  Between between = Between::ApproximationToOriginal;
  DistanceClaim claim;
  Bracket bracket;  ///< of the largest distance
};

/// All that was decided of an original and its approximation.
struct MeshVerdict {
  std::optional<Claim> convex;  ///< of the bodies of a set
  Inclusion inclusion;
  /// Depth by which what refutes the claims sticks out, the margin of a cover taken off.
  std::optional<Bracket> solid_depth, surface_depth;
  std::vector<DistanceVerdict> distances;
  std::vector<RegionVerdict> regions;  ///< as asked for
  std::optional<Claim>
      depth;  ///< of an inner set: that it leaves out nothing deeper than the bound
  /// Claim of the points of exact faces, where they were asked for: they refute, and prove nothing.
  std::optional<PointClaim> exact_points;
  std::optional<geom::Mesh> solid_part;  ///< the solid claim is that of this part of the original
  bool surface_of_all = false;           ///< the surface claim is that of Subject::triangles
  /// The solid claim alone decides, and the enclosed mesh is inside out: its solid is empty, or
  /// nearly so, and within any other.
  bool vacuous = false;
  Answer answer = Answer::Undefined;  ///< of all claims that decide
};

/// The worst answer of the claims of enclosure that decide and of convexity, distances, depth and
/// the points of exact faces.
/// One claim of enclosure may be undefined, as a solid is of an open mesh; not both.
Answer answer_of(const MeshVerdict& verdict, Claims claims);

/// Decides all that is asked.
/// @param enclosure  called when all but distances and depth is known, which may take long; the
///   verdict's answer is not known then
/// @throws as verify_inclusion, verify_distance
MeshVerdict decide(const MeshQuestion& question,
                   const std::function<void(const MeshVerdict&)>& enclosure = {});

/// The triangles that the surface claim is about, which its numbers are of.
const geom::Mesh& surface_of(const MeshQuestion& question, const MeshVerdict& verdict);

/// The triangles, of both meshes, that bound what refutes the claims; those of the claims of
/// enclosure once. Empty if only the bodies' convexity is refuted.
geom::Mesh offending_triangles(const MeshQuestion& question, const MeshVerdict& verdict);

}  // namespace kaboum::verify
