// Claims about sets of convex bodies: convexity, cover, and the distance of the bodies from the
// original. docs/algorithms/exact-inclusion.md.
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/body_cover.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/inner_balls.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <optional>
#include <sstream>

#include "body_bounds.h"
#include "body_excess.h"
#include "cell_sample.h"
#include "margin.h"
#include "mesh_pair.h"
#include "nearest.h"
#include "uncovered_region.h"

namespace kaboum::verify {
namespace {

/// A bound of the distance of a point of the meshes to the outer chain, or to its solid.
double distance_from_below(const MeshPair& meshes, const Vec3& p, bool to_solid) {
  if (to_solid && winding_at(meshes, kOutside, p).value_or(1) >= 1) return 0;
  const NearestTriangle nearest(meshes, kOutside);
  return nearest.lower_bound(p, nearest.distance(p)) -
         rounding_of_distances(meshes.largest_coordinate());
}

/// The vertex that is highest above the plane of some face, rounded.
struct Highest {
  std::optional<std::uint32_t> face;
  double height = 0;

  void take(const MeshPair& meshes, std::uint32_t f, std::uint32_t vertex) {
    const Vec3 normal = (meshes.corner(f, 1) - meshes.corner(f, 0))
                            .cross(meshes.corner(f, 2) - meshes.corner(f, 0));
    const double above =
        std::max(normal.normalized().dot(meshes.point(vertex) - meshes.corner(f, 0)), 0.0);
    if (face && above <= height) return;
    face = f;
    height = above;
  }

  [[nodiscard]] std::string text(const MeshPair& meshes) const {
    std::ostringstream line;
    line << "a vertex is above the plane of triangle " << meshes.face(*face).source << ", by about "
         << std::setprecision(2) << meshes.length_outside(height);
    return line.str();
  }
};

/// Why a polytope is not convex; empty when it is.
std::string fault_of(const geom::Mesh& body) {
  const MeshPair meshes(geom::Mesh{}, body);
  if (!meshes.closed(kOutside)) return "it is not closed";
  if (meshes.tree(kOutside).empty()) return "it has no triangle with area";
  std::vector<char> used(meshes.vertex_count(), 0);
  for (const Face& face : meshes.faces()) {
    for (const std::uint32_t v : face.v) used[v] = 1;
  }
  bool deep = false;
  Highest highest;
  for (std::uint32_t f = 0; f < meshes.faces().size(); ++f) {
    if (meshes.face(f).axis < 0) continue;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) continue;
      const Sign side = meshes.side(f, meshes.point(v));
      if (side == Sign::Positive) highest.take(meshes, f, v);
      deep = deep || side == Sign::Negative;
    }
  }
  if (highest.face) return highest.text(meshes);
  return deep ? "" : "it has no volume";
}

/// Why a body is not convex; empty when it is.
std::string fault_of(const geom::ConvexBody& body) {
  if (!(body.radius >= 0) || !std::isfinite(body.radius))
    return "its radius is negative or not finite";
  const std::vector<Vec3>& points = body.core.vertices;
  if (!body.core.triangles.empty()) return fault_of(body.core);
  if (points.empty() || points.size() > 2) return "it has no triangles";
  if (body.radius == 0) return "it is a segment or a point without a radius";
  if (points.size() == 2 && points[0] == points[1]) return "its segment is a point";
  return "";
}

std::vector<std::uint32_t> all_of(const geom::Mesh& mesh) {
  std::vector<std::uint32_t> out(mesh.triangles.size());
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

/// Triangles that are not known to lie in the outer solid as wholes. @param inclusion  of the mesh
/// in it; what it does not name, and has an area, does.
std::vector<std::uint32_t> not_within(const geom::Mesh& mesh, const Inclusion& inclusion) {
  const Answer answer = inclusion.surface.answer;
  if (inclusion.limited || (answer != Answer::Verified && answer != Answer::Refuted))
    return all_of(mesh);
  std::vector<std::uint32_t> out = inclusion.surface.inner_triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const geom::Triangle& v = mesh.triangles[t];
    if (geom::is_degenerate(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]))
      out.push_back(t);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// The triangle of a mesh that is nearest to a point, or 0.
std::uint32_t triangle_near(const geom::Mesh& mesh, const Vec3& p) {
  const MeshPair meshes(geom::Mesh{}, mesh);
  const std::uint32_t face = NearestTriangle(meshes, kOutside).nearest(p * meshes.scale()).face;
  return face == NearestTriangle::kNone ? 0 : meshes.face(face).source;
}

constexpr const char* kNoBounds =
    "the bodies are not convex, or too many, to be bounded by polytopes";

/// Where there are no polytopes to decide by.
Inclusion open_inclusion(const Claim& convex) {
  Inclusion out;
  for (Claim* claim : {&out.solid, &out.surface}) {
    claim->answer = Answer::Undecided;
    claim->reason = convex.answer == Answer::Verified ? kNoBounds : "not all bodies are convex";
  }
  return out;
}

/// Where many bodies meet there may be too many pieces; body by body, room between them decides.
void decide_open_claims(const geom::Mesh& original, const geom::ConvexSet& set,
                        const InclusionOptions& options, Inclusion& inclusion) {
  const auto is_open = [](const Claim& claim) { return claim.answer == Answer::Undecided; };
  if (set.bodies.size() < 2 || (!is_open(inclusion.solid) && !is_open(inclusion.surface))) return;
  Inclusion other = verify_body_cover(original, set, options);
  if (is_open(inclusion.solid) && !is_open(other.solid)) inclusion.solid = std::move(other.solid);
  if (is_open(inclusion.surface) && !is_open(other.surface))
    inclusion.surface = std::move(other.surface);
}

}  // namespace

geom::Mesh sum_of(const geom::ConvexSet& set) {
  geom::Mesh sum;
  const auto add = [&](const geom::Mesh& polytope) {
    const auto offset = static_cast<std::uint32_t>(sum.vertices.size());
    sum.vertices.insert(sum.vertices.end(), polytope.vertices.begin(), polytope.vertices.end());
    for (const geom::Triangle& t : polytope.triangles) {
      sum.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
  };
  const bool cores = geom::margin_of(set).has_value();
  const geom::SpherePoints sphere = geom::sphere_points(cores ? 0 : kFirstBoundsLevel);
  for (const geom::ConvexBody& body : set.bodies)
    add(cores ? body.core : geom::inscribed_polytope(body, sphere));
  return sum;
}

Convexity verify_convexity(const geom::ConvexSet& set) {
  Convexity result;
  result.convex.answer = Answer::Verified;
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    geom::require_valid(set.bodies[i].core);
    for (const Vec3& v : set.bodies[i].core.vertices)
      if (!v.allFinite())
        throw Error(ErrorCode::InvalidInput, "body " + std::to_string(i) + " (" +
                                                 set.bodies[i].name +
                                                 ") has a coordinate that is not a finite number");
    std::string fault = fault_of(set.bodies[i]);
    if (!fault.empty()) result.not_convex.emplace_back(i, std::move(fault));
  }
  if (!result.not_convex.empty()) {
    const auto& [index, why] = result.not_convex.front();
    result.convex.answer = Answer::Refuted;
    result.convex.reason = std::to_string(result.not_convex.size()) + " of " +
                           std::to_string(set.bodies.size()) + " bodies are not; body " +
                           std::to_string(index) + " (" + set.bodies[index].name + "): " + why;
  }
  return result;
}

Cover verify_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                   const InclusionOptions& options) {
  Cover cover{verify_convexity(set), {}};
  if (is_set_of_balls(set)) {
    cover.inclusion = verify_ball_cover(original, set, options);
    return cover;
  }
  const std::optional<double> margin = geom::margin_of(set);
  if (!margin) {
    cover.inclusion = cover.convexity.convex.answer == Answer::Verified
                          ? verify_body_cover(original, set, options)
                          : open_inclusion(cover.convexity.convex);
    return cover;
  }
  const geom::Mesh sum = sum_of(set);
  cover.inclusion = verify_inclusion(original, sum, options);
  if (*margin == 0 && cover.convexity.convex.answer == Answer::Verified)
    decide_open_claims(original, set, options, cover.inclusion);
  if (*margin > 0)
    allow_margin(original, sum, set, cover.convexity.convex.answer == Answer::Verified,
                 options.max_cells, cover.inclusion);
  return cover;
}

Inclusion verify_within(const geom::ConvexSet& set, const geom::Mesh& original,
                        const InclusionOptions& options) {
  if (is_set_of_balls(set)) return verify_balls_within(set, original, options);
  const auto of = [&](const geom::ConvexSet& polytopes) {
    return verify_inclusion(sum_of(polytopes), original, options);
  };
  if (geom::margin_of(set) == 0.0) return of(set);
  Inclusion out = decide_between(
      set, open_inclusion(verify_convexity(set).convex),
      [&](const BodyBounds& bounds) { return of(bounds.outside); },
      [&](const BodyBounds& bounds) { return of(bounds.inside); });
  for (Claim* claim : {&out.solid, &out.surface}) claim->inner_triangles.clear();  // polytopes'
  return out;
}

namespace {

/// verify_excess of bodies that parts of them do not decide.
DistanceClaim verify_open_excess(const geom::ConvexSet& set, const geom::Mesh& original,
                                 double epsilon, bool to_solid, const InclusionOptions& limits);

}  // namespace

DistanceClaim verify_excess(const geom::ConvexSet& set, const geom::Mesh& original, double epsilon,
                            bool to_solid, const InclusionOptions& limits) {
  const std::optional<double> one_radius = geom::margin_of(set);
  if (to_solid && have_cells(set)) {
    std::vector<std::size_t> open;
    DistanceClaim claim = verify_body_excess(set, original, epsilon, nullptr, 0, &open);
    if (claim.answer == Answer::Refuted) claim.triangle = triangle_near(sum_of(set), claim.at);
    // Of bodies with one radius more can be said where there is no slack.
    if (claim.answer != Answer::Undecided || !(one_radius && epsilon > *one_radius)) return claim;
    if (!open.empty()) {
      geom::ConvexSet rest;
      for (const std::size_t i : open) rest.bodies.push_back(set.bodies[i]);
      DistanceClaim of_rest = verify_open_excess(rest, original, epsilon, to_solid, limits);
      if (of_rest.answer == Answer::Refuted)
        of_rest.triangle = triangle_near(sum_of(set), of_rest.at);
      if (of_rest.largest < claim.largest) {
        of_rest.largest = claim.largest;
        of_rest.at = claim.at;
      }
      return of_rest;
    }
  }
  return verify_open_excess(set, original, epsilon, to_solid, limits);
}

namespace {

DistanceClaim verify_open_excess(const geom::ConvexSet& set, const geom::Mesh& original,
                                 double epsilon, bool to_solid, const InclusionOptions& limits) {
  const std::optional<double> one_radius = geom::margin_of(set);
  if (!one_radius) {
    // To the triangles alone it is the bodies' surfaces that count, which are within the gap of
    // those of both polytopes; to the solid, all points do, and what is inside is no farther.
    const auto of = [&](const geom::ConvexSet& polytopes, double shift) {
      const double bound = epsilon + (to_solid ? 0 : shift);
      if (bound > 0) return verify_excess(polytopes, original, bound, to_solid, limits);
      DistanceClaim nothing;
      nothing.answer = Answer::Undecided;
      return nothing;
    };
    DistanceClaim open;
    open.answer = Answer::Undecided;
    open.reason = kNoBounds;
    return decide_between(
        set, open, [&](const BodyBounds& bounds) { return of(bounds.outside, -bounds.gap); },
        [&](const BodyBounds& bounds) { return of(bounds.inside, bounds.gap); });
  }
  const double margin = *one_radius;
  if (!(epsilon > margin)) {
    DistanceClaim open;
    open.answer = Answer::Undecided;
    open.reason = "epsilon is no larger than the margin";
    return open;
  }
  DistanceClaimOptions options;
  options.to_solid = to_solid;
  const geom::Mesh sum = sum_of(set);
  const Inclusion inclusion = to_solid ? verify_inclusion(sum, original, limits) : Inclusion{};
  const std::vector<std::uint32_t> open = to_solid ? not_within(sum, inclusion) : all_of(sum);
  DistanceClaim claim;
  claim.answer = Answer::Verified;
  if (!open.empty()) {
    geom::Mesh part{sum.vertices, {}};
    for (const std::uint32_t t : open) part.triangles.push_back(sum.triangles[t]);
    claim = verify_distance(part, original, epsilon - margin, options);
    claim.triangle = open[claim.triangle];
  }
  if (to_solid && claim.answer == Answer::Verified) {
    // Cavities that the bodies fill are farther away inside the bodies than on their surfaces.
    const Claim inside = excess_inside(sum, original, inclusion, epsilon - margin, limits);
    if (inside.answer == Answer::Verified) return claim;
    claim.answer = inside.answer;
    claim.reason = inside.reason;
    if (inside.answer != Answer::Refuted) return claim;
    claim.at = inside.witness->point;
    claim.largest = inside.witness->depth + (epsilon - margin);
    claim.reason = "a point inside the bodies is farther away";
    if (claim.largest > epsilon || !(margin > 0)) return claim;
  }
  if (claim.answer != Answer::Refuted || !(margin > 0)) return claim;

  // Pushed away from the original by the margin less what `at` errs by, it is a point of the union.
  const MeshPair meshes(sum, original);
  const double push = margin * (1 - 0x1p-40) -
                      meshes.length_outside(rounding_of_distances(meshes.largest_coordinate()));
  const Vec3 at = claim.at * meshes.scale();
  const std::uint32_t f = NearestTriangle(meshes, kOutside).nearest(at).face;
  const Vec3 near =
      closest_point(at, meshes.corner(f, 0), meshes.corner(f, 1), meshes.corner(f, 2));
  const Vec3 pushed = claim.at + std::max(push, 0.0) * (at - near).normalized();
  const double reached = distance_from_below(meshes, pushed * meshes.scale(), to_solid);
  if (reached > epsilon * meshes.scale()) {
    claim.largest = meshes.length_outside(reached);
    claim.at = pushed;
    return claim;
  }
  DistanceClaim beyond = verify_distance(sum, original, epsilon, options);
  if (beyond.answer == Answer::Refuted) return beyond;
  claim.answer = Answer::Undecided;
  claim.reason =
      "the bodies are farther away than the margin leaves room for; whether the margin's "
      "outside is, too, is not decided";
  return claim;
}

}  // namespace

}  // namespace kaboum::verify
