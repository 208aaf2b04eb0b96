// Which depths of a solid a set of bodies inside it leaves out.
#include <kaboum/geom/error.h>
#include <kaboum/verify/cover.h>

#include "pockets.h"
#include "whole.h"

namespace kaboum::verify {
namespace {

/// The faces of the inside chain that bound {w ≥ 1} as wholes: no other face of the chain cuts
/// them, and they have w ≥ 1 on the inner side, w ≤ 0 on the outer one.
std::vector<std::uint32_t> boundary_faces(const Scene& scene, const InclusionOptions& options) {
  Arrangement arrangement(scene, {options.max_contacts, options.max_pairs});
  arrangement.need_own(kInside);
  std::atomic<std::size_t> samples = 0;
  const auto values = [&](Side side) {
    const auto own = [&](const Spot& spot) { return winding(scene, spot, side, kInside); };
    return whole_values(arrangement, kInside, mask_of(kInside), side, own, samples);
  };
  const std::vector<int> inner = values(kInner), outer = values(kOuter);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = scene.begin(kInside); f < scene.end(kInside); ++f) {
    const std::uint32_t i = f - scene.begin(kInside);
    if (inner[i] == kCut || outer[i] == kCut) continue;
    if (inner[i] >= 1 && outer[i] <= 0) faces.push_back(f);
  }
  return faces;
}

}  // namespace

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
    bounding = boundary_faces(scene, options);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitReached) throw;
  }
  if (bounding.empty()) {
    claim.reason = "no triangle of the original is known to bound its solid";
    return claim;
  }
  const BoxTree target = tree_of(scene, bounding);
  claim = search_pockets(scene, offending_faces(scene, without.solid),
                         {target, scene.tree(kInside), epsilon * scene.scale(), options.max_cells});
  if (claim.answer != Answer::Refuted) return claim;
  claim.reason = "a point that is deeper than that inside the original is in no body";
  claim.inner_triangles = without.solid.inner_triangles;
  claim.outer_triangles = without.solid.outer_triangles;
  return claim;
}

}  // namespace kaboum::verify
