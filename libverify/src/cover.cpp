#include <kaboum/verify/cover.h>

#include "scene.h"

namespace kaboum::verify {
namespace {

/// Why a body is not convex; empty when it is.
std::string fault_of(const geom::Mesh& body) {
  if (body.triangles.empty()) return "it has no triangles";
  const Scene scene(geom::Mesh{}, body);
  if (!scene.closed(kOutside)) return "it is not closed";
  if (scene.tree(kOutside).empty()) return "it has no triangle with area";
  std::vector<char> used(scene.vertex_count(), 0);
  for (const Face& face : scene.faces()) {
    for (const std::uint32_t v : face.v) used[v] = 1;
  }
  bool deep = false;
  for (std::uint32_t f = 0; f < scene.faces().size(); ++f) {
    if (scene.face(f).axis < 0) continue;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) continue;
      const Sign side = scene.side(f, scene.point(v));
      if (side == Sign::Positive) {
        return "a vertex is above the plane of triangle " + std::to_string(scene.face(f).source);
      }
      deep = deep || side == Sign::Negative;
    }
  }
  return deep ? "" : "it has no volume";
}

}  // namespace

geom::Mesh sum_of(const geom::ConvexSet& set) {
  geom::Mesh sum;
  for (const geom::ConvexBody& body : set.bodies) {
    const auto offset = static_cast<std::uint32_t>(sum.vertices.size());
    sum.vertices.insert(sum.vertices.end(), body.hull.vertices.begin(), body.hull.vertices.end());
    for (const geom::Triangle& t : body.hull.triangles) {
      sum.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
  }
  return sum;
}

Cover verify_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                   const InclusionOptions& options) {
  Cover cover;
  cover.convex.answer = Answer::Verified;
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    geom::require_valid(set.bodies[i].hull);
    std::string fault = fault_of(set.bodies[i].hull);
    if (!fault.empty()) cover.not_convex.emplace_back(i, std::move(fault));
  }
  if (!cover.not_convex.empty()) {
    const auto& [index, why] = cover.not_convex.front();
    cover.convex.answer = Answer::Refuted;
    cover.convex.reason =
        "body " + std::to_string(index) + " (" + set.bodies[index].name + "): " + why;
  }
  cover.inclusion = verify_inclusion(original, sum_of(set), options);
  if (set.margin > 0) {
    for (Claim* claim : {&cover.inclusion.solid, &cover.inclusion.surface}) {
      if (claim->answer != Answer::Refuted) continue;
      // The depth is rounded to a few units in the last place of the coordinates.
      const bool beyond = claim->witness && claim->witness->exact &&
                          claim->witness->depth * (1 - 1e-12) >
                              set.margin + 1e-12 * claim->witness->point.cwiseAbs().maxCoeff();
      if (beyond) continue;
      claim->answer = Answer::Undecided;
      claim->reason =
          "not covered without the margin; whether the margin covers the rest is not decided";
    }
  }
  return cover;
}

}  // namespace kaboum::verify
