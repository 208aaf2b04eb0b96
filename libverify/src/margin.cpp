// Enclosure by bodies enlarged by a margin: distances of the offending triangles and of the
// uncovered region. docs/algorithms/exact-inclusion.md.
#include "margin.h"

#include <kaboum/verify/distance.h>

#include "uncovered_region.h"

namespace kaboum::verify {
namespace {

Claim solid_claim(const MeshPair& meshes, const geom::ConvexSet& set, double margin, bool convex,
                  std::size_t max_cells, bool inside_only, const Claim& without) {
  const BoxTree& faces = meshes.tree(kOutside);
  const ComplementOfUnion bodies(meshes, set);
  Claim claim = search_uncovered(meshes, offending_faces(meshes, without),
                                 {meshes, faces, faces, margin * meshes.scale(), max_cells,
                                  inside_only, false, convex ? &bodies : nullptr});
  if (claim.answer == Answer::Refuted) {
    claim.reason = "a part of the inner solid is farther from the outer one than the margin";
  }
  return claim;
}

Claim surface_claim(const geom::Mesh& inner, const geom::Mesh& outer, double margin,
                    const Claim& without) {
  geom::Mesh part{inner.vertices, {}};
  for (const std::uint32_t t : without.inner_triangles) {
    part.triangles.push_back(inner.triangles[t]);
  }
  DistanceClaimOptions options;
  options.to_solid = true;
  const DistanceClaim distance = verify_distance(part, outer, margin, options);
  Claim claim;
  claim.answer = distance.answer;
  claim.reason = distance.reason;
  if (distance.answer == Answer::Refuted) {
    claim.reason = "a triangle is farther from the outer solid than the margin";
    claim.witness = Witness{distance.at, distance.largest - margin, false};
  }
  return claim;
}

}  // namespace

void allow_margin(const geom::Mesh& inner, const geom::Mesh& sum, const geom::ConvexSet& set,
                  bool convex, std::size_t max_cells, Inclusion& inclusion) {
  const double margin = geom::margin_of(set).value();
  const MeshPair meshes(inner, sum);
  if (meshes.tree(kOutside).empty()) return;  // nothing to be near
  const auto decide = [&](Claim& claim, const auto& anew) {
    if (claim.answer != Answer::Refuted) return;
    Claim with;
    with.answer = Answer::Undecided;
    if (inclusion.limited) {
      with.reason = "not all that is left out was found within the limits";
    } else if (!meshes.scaled()) {
      with.reason = "coordinates span too many orders of magnitude to measure distances";
    } else {
      with = anew(claim);
    }
    if (with.answer == Answer::Refuted) {
      with.inner_triangles = std::move(claim.inner_triangles);
      with.outer_triangles = std::move(claim.outer_triangles);
    }
    claim = std::move(with);
  };
  decide(inclusion.surface, [&](const Claim& c) { return surface_claim(inner, sum, margin, c); });
  if (inclusion.relative) return;
  // The boundary of what is left out lies on the bodies and on triangles of the surface claim.
  const bool inside_only = inclusion.surface.answer == Answer::Verified;
  decide(inclusion.solid, [&](const Claim& c) {
    return solid_claim(meshes, set, margin, convex, max_cells, inside_only, c);
  });
}

}  // namespace kaboum::verify
