// What of a union of bodies lies in a region, and how far that is from a solid.
// docs/algorithms/exact-inclusion.md, "Regions".

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

#include <algorithm>
#include <cmath>

#include "body_bounds.h"
#include "body_excess.h"

namespace kaboum::verify {
namespace {

using geom::BoundedRegion;
using geom::ConvexBody;
using geom::ConvexSet;
using geom::HalfSpace;
using geom::Region;

/// Of the largest coordinate: far above what all cuts of a body may lose by rounding.
constexpr double kRegionRounding = 1e-11;
constexpr int kBallLevel = 2;  ///< of the planes that stand for a region that is a ball

/// What numbers of a set and a region round by. [length]
double rounding_of(const ConvexSet& set, const Region& region) {
  double largest = region.center.cwiseAbs().maxCoeff() + region.radius;
  for (const HalfSpace& side : region.sides) largest = std::max(largest, std::abs(side.offset));
  for (const ConvexBody& body : set.bodies) {
    for (const geom::Vec3& p : body.core.vertices)
      largest = std::max(largest, p.cwiseAbs().maxCoeff() + body.radius);
  }
  return kRegionRounding * largest;
}

/// The bodies that are not certainly apart from a region.
ConvexSet bodies_near(const ConvexSet& set, const Region& region, double rounding) {
  ConvexSet out;
  for (const ConvexBody& body : set.bodies)
    if (!(geom::distance_from(region, body.core.vertices) > body.radius + rounding))
      out.bodies.push_back(body);
  return out;
}

/// Planes round a region, or within one: half-spaces that have as much in common or more, or no
/// more.
std::vector<HalfSpace> sides_of(const Region& region, bool round) {
  if (!region.sides.empty()) return region.sides;
  const geom::SpherePoints sphere = geom::sphere_points(kBallLevel);
  // A polytope whose planes are at the distance r of the centre reaches r / inner.
  const double radius = round ? region.radius : region.radius * sphere.inner;
  std::vector<HalfSpace> out;
  for (const geom::Vec3& q : sphere.points) {
    const geom::Vec3 n = q.normalized();
    out.push_back({n, n.dot(region.center) + radius});
  }
  return out;
}

/// What of a polytope is below a plane; nullopt where that is flat, or nothing.
std::optional<geom::Mesh> cut_off(const geom::Mesh& hull, const HalfSpace& side) {
  std::vector<double> height;
  height.reserve(hull.vertices.size());
  for (const geom::Vec3& p : hull.vertices) height.push_back(side.normal.dot(p) - side.offset);
  if (std::ranges::all_of(height, [](double h) { return h <= 0; })) return hull;
  std::vector<geom::Vec3> points;
  for (std::size_t i = 0; i < height.size(); ++i)
    if (height[i] <= 0) points.push_back(hull.vertices[i]);
  if (points.empty()) return std::nullopt;
  for (const geom::Triangle& t : hull.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (!(height[a] <= 0 && height[b] > 0)) continue;
      const double share = height[a] / (height[a] - height[b]);
      points.emplace_back(hull.vertices[a] + share * (hull.vertices[b] - hull.vertices[a]));
    }
  return geom::convex_hull(points);
}

/// The parts of polytopes in a region whose planes are moved outwards.
/// @param whole_if_flat  what of a polytope is flat counts as all of it, else as nothing
ConvexSet parts_in(const ConvexSet& polytopes, const std::vector<HalfSpace>& sides, double outwards,
                   bool whole_if_flat) {
  ConvexSet out;
  for (const ConvexBody& body : polytopes.bodies) {
    if (body.core.triangles.empty()) {
      if (whole_if_flat) out.bodies.push_back(body);
      continue;
    }
    std::optional<geom::Mesh> part = body.core;
    bool is_beyond = false;
    for (HalfSpace side : sides) {
      side.offset += outwards;
      is_beyond = std::ranges::all_of(
          part->vertices, [&](const geom::Vec3& p) { return side.normal.dot(p) > side.offset; });
      if (is_beyond) break;
      part = cut_off(*part, side);
      if (!part) break;
    }
    if (is_beyond) continue;
    if (part)
      out.bodies.push_back({body.name, *std::move(part), 0});
    else if (whole_if_flat)
      out.bodies.push_back({body.name, body.core, 0});
  }
  return out;
}

DistanceClaim answered(Answer answer, const char* reason) {
  DistanceClaim out;
  out.answer = answer;
  out.reason = reason;
  return out;
}

}  // namespace

DistanceClaim verify_region_excess(const ConvexSet& set, const geom::Mesh& original,
                                   const BoundedRegion& region, bool to_solid,
                                   const InclusionOptions& limits) {
  const double rounding = rounding_of(set, region.region);
  const ConvexSet bodies = bodies_near(set, region.region, rounding);
  if (bodies.bodies.empty()) return answered(Answer::Verified, "");
  const bool by_cells = to_solid && have_cells(bodies);
  if (by_cells) {
    DistanceClaim claim =
        verify_body_excess(bodies, original, region.epsilon, &region.region, rounding);
    if (claim.answer != Answer::Undecided) return claim;
  }
  if (!by_cells || geom::margin_of(bodies)) {
    DistanceClaim all = verify_excess(bodies, original, region.epsilon, to_solid, limits);
    if (all.answer == Answer::Verified) return all;
  }
  if (!to_solid) {
    // Planes that cut bodies off are no surface of theirs.
    return answered(Answer::Undecided,
                    "the original bounds no solid, and some body in the region is farther "
                    "somewhere");
  }
  const auto of = [&](const ConvexSet& polytopes, bool round) {
    const double moved = round ? rounding : -2 * rounding;
    const ConvexSet parts =
        parts_in(polytopes, sides_of(region.region, round), moved, /*whole_if_flat=*/round);
    if (parts.bodies.empty()) return answered(Answer::Verified, "");
    const double bound = round ? region.epsilon - 2 * rounding : region.epsilon + 2 * rounding;
    if (!(bound > 0))
      return answered(Answer::Undecided, "the region's epsilon is too small for its coordinates");
    return verify_excess(parts, original, bound, to_solid, limits);
  };
  return decide_between(
      bodies, answered(Answer::Undecided, "the bodies could not be bounded by polytopes"),
      [&](const BodyBounds& bounds) { return of(bounds.outside, true); },
      [&](const BodyBounds& bounds) { return of(bounds.inside, false); });
}

bool may_reach(const ConvexSet& set, const Region& region) {
  return !bodies_near(set, region, rounding_of(set, region)).bodies.empty();
}

}  // namespace kaboum::verify
