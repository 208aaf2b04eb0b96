// Which depths of a solid a set of bodies inside it leaves out, and how far a union reaches.
#include <kaboum/base/error.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/inner_balls.h>

#include <algorithm>

#include "body_bounds.h"
#include "nearest.h"
#include "uncovered_region.h"

namespace kaboum::verify {

namespace {

/// Enough for most bodies; which of their triangles bound what is left out takes longer to tell.
constexpr std::size_t kFewWork = kMostWork / 4;

/// The triangles of both chains nearest to the witness.
void name_nearest(const MeshPair& meshes, Claim& claim) {
  const Vec3 at = claim.witness->point * meshes.scale();
  for (const int chain : {kInside, kOutside}) {
    const std::uint32_t f = NearestTriangle(meshes, chain).nearest(at).face;
    if (f != NearestTriangle::kNone)
      (chain == kInside ? claim.inner_triangles : claim.outer_triangles)
          .push_back(meshes.face(f).source);
  }
}

}  // namespace

Claim verify_depth(const geom::Mesh& original, const geom::ConvexSet& set, double epsilon,
                   const InclusionOptions& options) {
  if (is_set_of_balls(set)) return verify_ball_depth(original, set, epsilon, options);
  if (geom::margin_of(set) != 0.0) {
    const auto of = [&](const geom::ConvexSet& polytopes) {
      return verify_depth(original, polytopes, epsilon, options);
    };
    Claim open;
    open.answer = Answer::Undecided;
    open.reason = "the bodies are too many to be bounded by polytopes";
    return decide_between(
        set, open, [&](const BodyBounds& bounds) { return of(bounds.inside); },
        [&](const BodyBounds& bounds) { return of(bounds.outside); });
  }
  const geom::Mesh sum = sum_of(set);
  const MeshPair meshes(original, sum);
  Pieces bounding;
  if (meshes.scaled() && meshes.closed(kInside) && meshes.closed(kOutside)) {
    try {
      bounding = pieces_with(meshes, kInside, options,
                             [](int inner, int outer) { return std::min(inner, outer) <= 0; });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::LimitReached) throw;
    }
  }
  const ComplementOfUnion bodies(meshes, set);
  const auto search = [&](const std::vector<std::uint32_t>& faces, std::size_t work) {
    Claim claim =
        search_uncovered(meshes, faces,
                         {Triangles(meshes, bounding.parts), bounding.surely, bounding.perhaps,
                          epsilon * meshes.scale(), options.max_cells, false, true, &bodies, work});
    if (claim.answer == Answer::Refuted)
      claim.reason = "a point that is deeper than that inside the original is in no body";
    return claim;
  };
  if (!bounding.surely.empty()) {
    std::vector<std::uint32_t> all;  // hold the boundary of Z, whatever it is
    for (std::uint32_t f = 0; f < meshes.faces().size(); ++f)
      if (meshes.face(f).axis >= 0) all.push_back(f);
    Claim claim = search(all, kFewWork);
    if (claim.answer == Answer::Refuted) name_nearest(meshes, claim);
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
  if (!meshes.scaled()) {
    claim.reason = "coordinates span too many orders of magnitude to measure distances";
    return claim;
  }
  if (bounding.surely.empty()) {
    claim.reason = "no triangle of the original is known to bound its solid";
    return claim;
  }
  claim = search(offending_faces(meshes, without.solid), kMostWork - kFewWork);
  if (claim.answer != Answer::Refuted) return claim;
  claim.inner_triangles = without.solid.inner_triangles;
  claim.outer_triangles = without.solid.outer_triangles;
  return claim;
}

Claim excess_inside(const geom::Mesh& sum, const geom::Mesh& original, const Inclusion& inclusion,
                    double epsilon, const InclusionOptions& options) {
  Claim claim = inclusion.solid;
  if (claim.answer != Answer::Refuted) return claim;
  claim = {};
  claim.answer = Answer::Undecided;
  const MeshPair meshes(sum, original);
  if (inclusion.limited) {
    claim.reason = "not all that the bodies hold besides was found within the limits";
    return claim;
  }
  const BoxTree& faces = meshes.tree(kOutside);
  return search_uncovered(
      meshes, offending_faces(meshes, inclusion.solid),
      {meshes, faces, faces, epsilon * meshes.scale(), options.max_cells, true});
}

}  // namespace kaboum::verify
