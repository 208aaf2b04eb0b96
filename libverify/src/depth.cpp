// Which depths of a solid a set of bodies inside it leaves out, and how far a union reaches.
#include <kaboum/base/error.h>
#include <kaboum/verify/cover.h>

#include <algorithm>

#include "nearest.h"
#include "pockets.h"

namespace kaboum::verify {

namespace {

/// Enough for most bodies; which of their triangles bound what is left out takes longer to tell.
constexpr std::size_t kFewWork = kMostWork / 4;

/// The triangles of both chains nearest to the witness.
void name_nearest(const Scene& scene, Claim& claim) {
  const Vec3 at = claim.witness->point * scene.scale();
  for (const int chain : {kInside, kOutside}) {
    const std::uint32_t f = NearestTriangle(scene, chain).nearest(at).face;
    if (f != NearestTriangle::kNone)
      (chain == kInside ? claim.inner_triangles : claim.outer_triangles)
          .push_back(scene.face(f).source);
  }
}

}  // namespace

Claim verify_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                   const InclusionOptions& options) {
  const geom::Mesh sum = sum_of(set);
  const Scene scene(original, sum);
  Pieces bounding;
  if (scene.scaled() && scene.closed(kInside) && scene.closed(kOutside)) {
    try {
      bounding = pieces_with(scene, kInside, options,
                             [](int inner, int outer) { return std::min(inner, outer) <= 0; });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
    }
  }
  const Uncovered bodies(scene, set);
  const auto search = [&](const std::vector<std::uint32_t>& faces, std::size_t work) {
    Claim claim =
        search_pockets(scene, faces,
                       {Triangles(scene, bounding.parts), bounding.surely, bounding.perhaps,
                        epsilon * scene.scale(), options.max_cells, false, true, &bodies, work});
    if (claim.answer == Answer::Refuted)
      claim.reason = "a point that is deeper than that inside the original is in no body";
    return claim;
  };
  if (!bounding.surely.empty()) {
    std::vector<std::uint32_t> all;  // hold the boundary of Z, whatever it is
    for (std::uint32_t f = 0; f < scene.faces().size(); ++f)
      if (scene.face(f).axis >= 0) all.push_back(f);
    Claim claim = search(all, kFewWork);
    if (claim.answer == Answer::Refuted) name_nearest(scene, claim);
    if (claim.answer != Answer::Undecided) return claim;
  }

  const Inclusion without = verify_inclusion(original, sum, options);
  Claim claim = without.solid;
  if (claim.answer != Answer::Refuted) return claim;
  claim = {};
  claim.answer = Answer::Undecided;
  if (without.limited) {
    claim.reason = "not all that is left out was found within the limits";
    return claim;
  }
  if (!scene.scaled()) {
    claim.reason = "coordinates span too many orders of magnitude to measure distances";
    return claim;
  }
  if (bounding.surely.empty()) {
    claim.reason = "no triangle of the original is known to bound its solid";
    return claim;
  }
  claim = search(offending_faces(scene, without.solid), kMostWork - kFewWork);
  if (claim.answer != Answer::Refuted) return claim;
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
                        {scene, faces, faces, epsilon * scene.scale(), options.max_cells, true});
}

}  // namespace kaboum::verify
