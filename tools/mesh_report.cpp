// What was found of two meshes, as a report.
#include <cmath>

#include "mesh_case.h"

namespace kaboum::tools {

using verify::Between;
using verify::Relation;

namespace {

Json to_json(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const verify::Bracket& bracket) {
  return {{"lower", bracket.lower},
          {"upper", std::isfinite(bracket.upper) ? Json(bracket.upper) : Json()},
          {"at", to_json(bracket.at)},
          {"triangle", bracket.triangle}};
}

Json to_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness) {
    json["witness"] = {{"point", to_json(claim.witness->point)},
                       {"depth", claim.witness->depth},
                       {"exact", claim.witness->exact}};
    json["inner_triangles"] = claim.inner_triangles.size();
    json["outer_triangles"] = claim.outer_triangles.size();
  }
  return json;
}

Json to_json(const verify::DistanceClaim& claim) {
  return {{"answer", name_of(claim.answer)},
          {"reason", claim.reason},
          {"largest_found", claim.largest},
          {"at", to_json(claim.at)},
          {"pieces", claim.pieces}};
}

const char* key_of(Between between) {
  switch (between) {
    case Between::ApproximationToOriginal:
      return "approximation_to_original";
    case Between::OriginalToApproximation:
      return "original_to_approximation";
    case Between::UnionToSolid:
    case Between::FacetsToSurface:
      break;
  }
  return "distance";
}

Json claims_of(const MeshCase& run) {
  const verify::MeshVerdict& v = run.verdict;
  Json claims;
  if (v.convex) claims["convex"] = to_json(*v.convex);
  claims["solid"] = to_json(v.inclusion.solid);
  claims["solid"]["relative"] = v.inclusion.relative;
  claims["surface"] = to_json(v.inclusion.surface);
  if (v.solid_depth) claims["solid"]["depth"] = to_json(*v.solid_depth);
  if (v.surface_depth) {
    verify::Bracket depth = *v.surface_depth;
    depth.triangle = triangle_in_file(run, depth.triangle).value_or(depth.triangle);
    claims["surface"]["depth"] = to_json(depth);
  }
  for (const verify::DistanceVerdict& distance : v.distances) {
    Json& json = claims[key_of(distance.between)];
    json = to_json(distance.claim);
    json["bound"] = *run.bound;
    if (run.asked.relation != Relation::Cover) continue;
    json["margin"] = run.approximation.set.margin;
    json["to_solid"] = distance.between == Between::UnionToSolid;
  }
  if (v.exact_points) {
    const verify::PointClaim& points = *v.exact_points;
    Json& json = claims["exact_points"];
    json = {{"answer", name_of(points.answer)}, {"reason", points.reason},
            {"points", points.points},          {"outside", points.outside},
            {"faces_outside", points.faces},    {"rounding", points.rounding}};
    if (points.outside > 0) {
      json["farthest"] = points.farthest;
      json["at"] = to_json(points.at);
      json["face"] = points.face + 1;
    }
  }
  if (const std::string why = why_no_points(run); !why.empty())
    claims["exact_points"] = {{"answer", name_of(verify::Answer::Undefined)}, {"reason", why}};
  if (v.depth) {
    claims["depth"] = to_json(*v.depth);
    claims["depth"]["bound"] = *run.bound;
  }
  return claims;
}

Json file(const std::string& path, const MeshInput& input, bool closed, std::size_t open) {
  return {{"file", path},        {"sha256", input.sha256},
          {"unit", input.unit},  {"triangles", input.mesh.triangles.size()},
          {"closed", closed},    {"unbalanced_edges", open},
          {"notes", input.notes}};
}

/// What preparing did to the original, or would have to do.
void add_preparation(const MeshCase& run, Json& original) {
  if (run.asked.prepare) {
    original["filled_triangles"] = run.original.filled_triangles;
    original["dropped_sheet_triangles"] = run.original.dropped_sheets;
    if (!run.original.subject->refusal.empty())
      original["cannot_be_prepared"] = run.original.subject->refusal;
    return;
  }
  const auto& found = run.inside_out;
  original["inside_out_parts"] = found ? found->parts : 0;
  if (!found) return;
  if (!found->refusal.empty())
    original["cannot_be_prepared"] = found->refusal;
  else if (found->parts != 0)
    original["inside_out"] = {
        {"triangle", found->triangle}, {"at", to_json(found->at)}, {"remedy", "--prepare"}};
  if (found->hollow) original["hollow_at"] = to_json(*found->hollow);
}

const char* name_of_relation(Relation relation) {
  switch (relation) {
    case Relation::Outer:
      return "outer";
    case Relation::Inner:
      return "inner";
    case Relation::Cover:
      break;
  }
  return "cover";
}

}  // namespace

Json report_of(const MeshCase& run) {
  const verify::Inclusion& in = run.verdict.inclusion;
  const bool swap = run.inner();
  Json json{
      {"relation", name_of_relation(run.asked.relation)},
      {"verdict", name_of(run.verdict.answer)},
      {"deciding_claims", run.asked.claims},
      {"original", file(run.asked.original, run.original, swap ? in.outer_closed : in.inner_closed,
                        swap ? in.outer_open_edges : in.inner_open_edges)},
      {"approximation",
       file(run.asked.approximation, run.approximation, swap ? in.inner_closed : in.outer_closed,
            swap ? in.inner_open_edges : in.outer_open_edges)},
      {"bbox_diagonal", run.diagonal}};
  if (run.approximation.is_set) {
    json["approximation"]["bodies"] = run.approximation.set.bodies.size();
    json["approximation"]["margin"] = run.approximation.set.margin;
  }
  json["original"]["scale"] = run.asked.unit.scale;
  if (!run.original.about_exact.empty()) json["original"]["deviation"] = run.original.deviation;
  if (const auto& exact = run.original.exact) {
    json["original"]["exact_faces"] = exact->faces;
    json["original"]["exact_edges"] = exact->edges;
  }
  add_preparation(run, json["original"]);
  json["claims"] = claims_of(run);
  json["triangles_without_area"] = in.triangles_without_area;
  json["limited"] = in.limited;
  json["triangles_left_out"] = in.left_out;
  json["contacts"] = in.contacts;
  json["samples"] = in.samples;
  return json;
}

}  // namespace kaboum::tools
