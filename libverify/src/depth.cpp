// Which depths of a solid a set of bodies inside it leaves out, and how far a union reaches.
#include <kaboum/geom/error.h>
#include <kaboum/verify/cover.h>

#include "pockets.h"
#include "whole.h"

namespace kaboum::verify {

Claim verify_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                   const InclusionOptions& options) {
  const geom::Mesh sum = sum_of(set);
  const Inclusion without = verify_inclusion(original, sum, options);
  Claim claim = without.solid;
  if (claim.answer != Answer::Refuted) return claim;
  claim = {};
  claim.answer = Answer::Undecided;
  const Scene scene(original, sum);
  if (without.limited) {
    claim.reason = "not all that is left out was found within the limits";
    return claim;
  }
  if (!scene.scaled()) {
    claim.reason = "coordinates span too many orders of magnitude to measure distances";
    return claim;
  }
  std::vector<std::uint32_t> bounding;
  try {
    bounding = faces_with(scene, kInside, options,
                          [](int inner, int outer) { return inner >= 1 && outer <= 0; });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitReached) throw;
  }
  if (bounding.empty()) {
    claim.reason = "no triangle of the original is known to bound its solid";
    return claim;
  }
  const BoxTree target = tree_of(scene, bounding);
  const Uncovered bodies(scene, set);
  claim = search_pockets(
      scene, offending_faces(scene, without.solid),
      {target, scene.tree(kInside), epsilon * scene.scale(), options.max_cells, false, &bodies});
  if (claim.answer != Answer::Refuted) return claim;
  claim.reason = "a point that is deeper than that inside the original is in no body";
  claim.inner_triangles = without.solid.inner_triangles;
  claim.outer_triangles = without.solid.outer_triangles;
  return claim;
}

Claim reach_inside(const geom::Mesh& sum, const geom::Mesh& original, const Inclusion& inclusion,
                   double epsilon, const InclusionOptions& options) {
  Claim claim = inclusion.solid;
  if (claim.answer != Answer::Refuted) return claim;
  claim = {};
  claim.answer = Answer::Undecided;
  const Scene scene(sum, original);
  if (inclusion.limited) {
    claim.reason = "not all that the bodies hold besides was found within the limits";
    return claim;
  }
  const BoxTree& faces = scene.tree(kOutside);
  return search_pockets(scene, offending_faces(scene, inclusion.solid),
                        {faces, faces, epsilon * scene.scale(), options.max_cells, true});
}

}  // namespace kaboum::verify
