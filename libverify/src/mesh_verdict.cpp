// All claims about an original and its approximation, decided one after the other.
#include <kaboum/geom/topology.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/mesh_verdict.h>
#include <kaboum/verify/region_excess.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "body_bounds.h"
#include "inside_out.h"

namespace kaboum::verify {
namespace {

/// The mesh that the solid claim is about.
const geom::Mesh& solid_of(const MeshQuestion& q, const MeshVerdict& verdict) {
  return verdict.solid_part ? *verdict.solid_part : q.inner();
}

/// What encloses: a mesh whose solid, enlarged by the margin, is no smaller than the true one, and
/// no larger than that enlarged by `gap`.
struct Enclosing {
  geom::Mesh mesh;
  double margin = 0, gap = 0;
};

/// Of bodies with radii of their own the polytopes round them; nullopt where there are none.
std::optional<Enclosing> enclosing_of(const MeshQuestion& q) {
  // Triangles of the bodies' polytopes are not those of the approximation.
  if (q.relation == Relation::Inner && q.set != nullptr && geom::margin_of(*q.set) != 0.0)
    return std::nullopt;
  if (q.relation != Relation::Cover) return Enclosing{q.outer()};
  if (const auto margin = geom::margin_of(*q.set)) return Enclosing{q.outer(), *margin};
  std::optional<BodyBounds> bounds = bounds_of(*q.set, kFirstBoundsLevel + 1);
  if (!bounds) return std::nullopt;
  return Enclosing{sum_of(bounds->outside), 0, bounds->gap};
}

void measure_depths(const MeshQuestion& q, const Enclosing& outer, MeshVerdict& out) {
  const double margin = outer.margin;
  const auto beyond_margin = [&](Bracket b) {
    b.lower = std::max(0.0, b.lower - margin * (1 + 0x1p-50));
    b.upper -= margin * (1 - 0x1p-50);
    if (outer.gap > 0) b.upper = (b.upper + outer.gap) * (1 + 0x1p-50);
    return b;
  };
  const Inclusion& in = out.inclusion;
  if (in.solid.answer == Answer::Refuted && !in.relative && !in.limited)
    out.solid_depth = beyond_margin(bracket_solid(solid_of(q, out), outer.mesh, in.solid));
  if (in.surface.answer != Answer::Refuted) return;
  BracketEffort effort;
  if (in.limited)  // its target is as hard to find
    effort.max_work = q.max_work.value_or(
        usual_work(q.original.triangles.size() + q.approximation.triangles.size()));
  out.surface_depth = beyond_margin(
      bracket_distance(surface_of(q, out), in.surface.inner_triangles, outer.mesh, true, effort));
  // What was left out may stick out farther.
  if (in.limited) out.surface_depth->upper = std::numeric_limits<double>::infinity();
}

Bracket bracket_all(const geom::Mesh& from, const geom::Mesh& to, bool to_solid) {
  std::vector<std::uint32_t> all(from.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return bracket_distance(from, all, to, to_solid);
}

/// As far as the claim tells.
Bracket bracket_of(const DistanceClaim& claim) {
  return {claim.largest, std::numeric_limits<double>::infinity(), claim.at, claim.triangle};
}

DistanceVerdict decide_distance(Between between, const geom::Mesh& from, const geom::Mesh& to,
                                double bound) {
  DistanceVerdict out{between, verify_distance(from, to, bound), {}};
  out.bracket = bracket_of(out.claim);
  if (out.claim.answer == Answer::Verified) return out;
  const Bracket found = bracket_all(from, to, false);
  out.bracket.upper = found.upper;
  if (found.lower > out.bracket.lower) out.bracket = found;
  return out;
}

DistanceVerdict decide_excess(const MeshQuestion& q, bool is_closed,
                              const InclusionOptions& options) {
  const geom::Mesh& to = q.measured != nullptr ? q.measured->mesh : q.original;
  const bool has_solid = q.measured == nullptr || q.measured->has_solid;
  const bool to_solid = q.measured != nullptr || is_closed;
  DistanceVerdict out{to_solid ? Between::UnionToSolid : Between::FacetsToSurface,
                      verify_excess(*q.set, to, *q.bound, to_solid, options),
                      {}};
  if (out.claim.answer == Answer::Refuted && !has_solid) {
    out.claim.answer = Answer::Undecided;
    out.claim.reason = "which solid the triangles bound is not known";
  }
  out.bracket = bracket_of(out.claim);
  if (out.claim.answer == Answer::Verified) return out;
  // Inside the bodies it may be farther: only the lower bound counts.
  const Bracket found = bracket_all(q.approximation, to, to_solid);
  if (found.lower > out.bracket.lower) {
    out.bracket.lower = found.lower;
    out.bracket.at = found.at;
  }
  return out;
}

void decide_distances(const MeshQuestion& q, const InclusionOptions& options, MeshVerdict& out) {
  if (q.relation == Relation::Cover) {
    options.progress("distance");
    out.distances.push_back(decide_excess(q, out.inclusion.inner_closed, options));
  } else if (q.set != nullptr) {
    options.progress("depth");
    out.depth = verify_depth(q.original, *q.set, *q.bound, options);
  } else {
    for (const Between between :
         {Between::ApproximationToOriginal, Between::OriginalToApproximation}) {
      options.progress(name_of(between));
      const bool there = between == Between::ApproximationToOriginal;
      out.distances.push_back(decide_distance(between, there ? q.approximation : q.original,
                                              there ? q.original : q.approximation, *q.bound));
    }
  }
}

void decide_regions(const MeshQuestion& q, const InclusionOptions& options, MeshVerdict& out) {
  const geom::Mesh& to = q.measured != nullptr ? q.measured->mesh : q.original;
  const bool to_solid = q.measured != nullptr || out.inclusion.inner_closed;
  for (const geom::BoundedRegion& region : q.regions) {
    options.progress("distance in the region " + region.name);
    DistanceClaim claim = verify_region_excess(*q.set, to, region, to_solid, options);
    if (claim.answer == Answer::Refuted && q.measured != nullptr && !q.measured->has_solid) {
      claim.answer = Answer::Undecided;
      claim.reason = "which solid the triangles bound is not known";
    }
    out.regions.push_back({region, std::move(claim)});
  }
}

Inclusion inclusion_of(const MeshQuestion& q, const geom::Mesh& inner,
                       const InclusionOptions& options) {
  if (q.relation == Relation::Cover) return verify_cover(inner, *q.set, options).inclusion;
  if (q.set != nullptr && geom::margin_of(*q.set) != 0.0)
    return verify_within(*q.set, q.original, options);
  return verify_inclusion(inner, q.outer(), options);
}

/// What is to be said of a subject beside its mesh as it is oriented.
void decide_subject(const MeshQuestion& q, InclusionOptions options, MeshVerdict& out) {
  options.max_work = options.max_work.value_or(
      usual_work(q.original.triangles.size() + q.approximation.triangles.size()));
  SubjectClaims claims = decide_rest(*q.subject, q.original, q.claims, std::move(out.inclusion),
                                     [&](const geom::Mesh& mesh, bool surface_only) {
                                       options.surface_only = surface_only;
                                       return inclusion_of(q, mesh, options);
                                     });
  out.inclusion = std::move(claims.inclusion);
  out.solid_part = std::move(claims.solid_part);
  out.surface_of_all = claims.surface_of_all;
}

}  // namespace

const geom::Mesh& surface_of(const MeshQuestion& q, const MeshVerdict& verdict) {
  return verdict.surface_of_all ? q.subject->triangles : q.inner();
}

const char* name_of(Between between) {
  switch (between) {
    case Between::ApproximationToOriginal:
      return "distance from approximation to original";
    case Between::OriginalToApproximation:
      return "distance from original to approximation";
    case Between::UnionToSolid:
      return "distance from the union to the solid";
    case Between::FacetsToSurface:
      break;
  }
  return "distance from the bodies' facets to the surface";
}

Answer answer_of(const MeshVerdict& verdict, Claims claims) {
  std::vector<Answer> enclosure, besides;
  if (claims != Claims::Surface) enclosure.push_back(verdict.inclusion.solid.answer);
  if (claims != Claims::Solid) enclosure.push_back(verdict.inclusion.surface.answer);
  if (verdict.convex) besides.push_back(verdict.convex->answer);
  for (const DistanceVerdict& d : verdict.distances) besides.push_back(d.claim.answer);
  for (const RegionVerdict& r : verdict.regions) besides.push_back(r.claim.answer);
  if (verdict.depth) besides.push_back(verdict.depth->answer);
  if (verdict.exact_points) besides.push_back(verdict.exact_points->answer);
  const auto any = [](const std::vector<Answer>& answers, Answer a) {
    return std::find(answers.begin(), answers.end(), a) != answers.end();
  };
  for (const Answer a : {Answer::Refuted, Answer::Undecided})
    if (any(enclosure, a) || any(besides, a)) return a;
  const bool defined = any(enclosure, Answer::Verified) && !any(besides, Answer::Undefined);
  return defined && !verdict.vacuous ? Answer::Verified : Answer::Undefined;
}

MeshVerdict decide(const MeshQuestion& q,
                   const std::function<void(const MeshVerdict&)>& enclosure) {
  const auto show = [&](const std::string& what) {
    if (q.progress) q.progress(what);
  };
  InclusionOptions options;
  options.max_contacts = q.max_contacts;
  options.max_work = q.max_work;
  options.progress = [&](const std::string& what) { show("deciding: " + what); };
  MeshVerdict out;
  if (q.set != nullptr) out.convex = verify_convexity(*q.set).convex;
  out.inclusion = inclusion_of(q, q.inner(), options);
  const bool has_subject = q.subject != nullptr && q.relation != Relation::Inner;
  if (has_subject) decide_subject(q, options, out);
  const bool both_ways = has_subject && q.subject->both_ways;
  out.vacuous = q.claims == Claims::Solid && !both_ways && is_inside_out(q.inner());
  show("measuring what sticks out");
  const std::optional<Enclosing> outer = enclosing_of(q);
  if (outer) measure_depths(q, *outer, out);
  if (q.exact_points && q.relation != Relation::Inner) {
    show("deciding: points of exact faces");
    if (outer) {
      out.exact_points = verify_points(*q.exact_points, outer->mesh, outer->margin);
    } else {
      out.exact_points.emplace();
      out.exact_points->reason = "the bodies are too many to be bounded by polytopes";
    }
  }
  if (enclosure) enclosure(out);
  if (q.bound) decide_distances(q, options, out);
  if (q.relation == Relation::Cover) decide_regions(q, options, out);
  out.answer = answer_of(out, q.claims);
  return out;
}

geom::Mesh offending_triangles(const MeshQuestion& q, const MeshVerdict& verdict) {
  geom::Mesh mesh;
  const auto take = [&](const geom::Mesh& from, std::vector<std::uint32_t> triangles) {
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    for (const std::uint32_t t : triangles) {
      if (t >= from.triangles.size()) continue;
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const std::uint32_t v : from.triangles[t]) mesh.vertices.push_back(from.vertices[v]);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  };
  std::vector<std::uint32_t> of_inner, of_outer;
  for (const Claim* claim : {&verdict.inclusion.solid, &verdict.inclusion.surface}) {
    of_outer.insert(of_outer.end(), claim->outer_triangles.begin(), claim->outer_triangles.end());
    if (verdict.solid_part && claim == &verdict.inclusion.solid)
      take(*verdict.solid_part, claim->inner_triangles);
    else if (verdict.surface_of_all && claim == &verdict.inclusion.surface)
      take(q.subject->triangles, claim->inner_triangles);
    else
      of_inner.insert(of_inner.end(), claim->inner_triangles.begin(), claim->inner_triangles.end());
  }
  take(q.inner(), std::move(of_inner));
  take(q.outer(), std::move(of_outer));
  for (const DistanceVerdict& d : verdict.distances)
    if (d.claim.answer == Answer::Refuted)
      take(d.between == Between::OriginalToApproximation ? q.original : q.approximation,
           {d.claim.triangle});
  if (!verdict.depth) return mesh;
  for (const std::uint32_t t : verdict.depth->inner_triangles) take(q.original, {t});
  for (const std::uint32_t t : verdict.depth->outer_triangles) take(q.approximation, {t});
  return mesh;
}

}  // namespace kaboum::verify
