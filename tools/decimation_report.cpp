// The report of bmesh-decimate.

#include <cmath>

#include "decimation_case.h"

namespace kaboum::tools {
namespace {

using certify::MeshCertificate;
using verify::Answer;

const char* name_of_stop(bmesh::Stop stop) {
  switch (stop) {
    case bmesh::Stop::VertexTarget:
      return "vertices";
    case bmesh::Stop::ErrorBound:
      return "epsilon";
    case bmesh::Stop::OutOfWork:
      return "out of work";
    case bmesh::Stop::Exhausted:
      break;
  }
  return "exhausted";
}

Json input_of(const DecimationCase& run) {
  Json json{{"file", run.asked.input},
            {"sha256", run.log.input_sha256},
            {"unit", run.input.unit},
            {"scale", run.asked.unit.scale},
            {"reader_delivers_float32", run.input.single_precision},
            {"file_vertices", run.input.file_vertices},
            {"file_triangles", run.input.file_triangles},
            {"split_polygons", run.input.split_polygons}};
  json.update(to_json(geom::analyse(run.original().solid.mesh())));
  return json;
}

Json preparation_of(const DecimationCase& run) {
  const geom::PreparationReport& p = run.original().report;
  return {{"prepare", run.asked.value("prepare")},
          {"why_wrapped", run.made.why_wrapped.empty() ? Json() : Json(run.made.why_wrapped)},
          {"why_not_wrapped",
           run.made.why_not_wrapped.empty() ? Json() : Json(run.made.why_not_wrapped)},
          {"wrap", run.wrap() ? Json::parse(certify::to_json(*run.wrap())) : Json()},
          {"collapsed_triangles", run.input.collapsed_triangles + p.collapsed_triangles},
          {"dropped_copies", p.dropped_copies},
          {"cancelled_walls", p.cancelled_walls},
          {"dropped_sheets", p.dropped_sheets},
          {"turned_components", p.reversed_components},
          {"turned_triangles", p.reversed_triangles},
          {"holes", p.holes},
          {"filled_triangles", run.original().solid.filled_triangles()},
          {"largest_hole", p.largest_hole},
          {"notes", run.notes}};
}

Json options_of(const DecimationCase& run) {
  const DecimationOptions& o = run.asked;
  const certify::MeshPlan& plan = run.series().plan;
  const certify::MeshRequest& r = o.mesh.request;
  certify::MeshOptions planned;
  planned.request.effort = plan.effort;
  return {{"direction", o.value("direction")},
          {"cost", o.value("cost")},
          {"effort", value_of(certify::mesh_options(), "effort", planned)},
          {"as_printed", r.as_printed},
          {"precision", plan.precision == bmesh::Precision::Double ? "double" : "float"},
          {"vertices", plan.vertices.empty()       ? Json()
                       : plan.vertices.size() == 1 ? Json(plan.vertices.front())
                                                   : Json(plan.vertices)},
          {"epsilon", plan.epsilon ? Json(*plan.epsilon) : Json()},
          {"sharp_angle", r.sharp_angle.value_or(bmesh::kSharpAngle)},
          {"keep_convex", r.keep_convex},
          {"max_work", r.max_work ? Json(*r.max_work) : Json()}};
}

Json verification_of(const certify::DecidedMesh& decided) {
  const auto claim = [](const verify::Claim& c) {
    Json json{{"answer", name_of(c.answer)}, {"reason", c.reason}};
    if (c.witness) {
      json["depth"] = c.witness->depth;
      json["triangles"] = c.inner_triangles.size() + c.outer_triangles.size();
    }
    return json;
  };
  Json json{{"solid", claim(decided.inclusion.solid)},
            {"relative", decided.inclusion.relative},
            {"surface", claim(decided.inclusion.surface)},
            {"distance_bound", decided.distance_bound},
            {"distance_original_to_result", name_of(decided.original_to_result)},
            {"distance_result_to_original", name_of(decided.result_to_original)}};
  if (decided.nested) json["nested"] = name_of(*decided.nested);
  return json;
}

/// The same words as under "verification".
std::string decided_surface(const verify::Claim& surface, bool outer) {
  std::string text = name_of(surface.answer);
  if (surface.answer == Answer::Verified)
    return text + (outer ? ": every triangle of the input lies in the result's solid"
                         : ": every triangle of the result lies in the input's solid");
  if (surface.answer == Answer::Refuted)
    return text + ": " + std::to_string(surface.inner_triangles.size()) + " triangles of the " +
           (outer ? "input do not lie in the result's solid"
                  : "result do not lie in the input's solid");
  return surface.reason.empty() ? text : text + ": " + surface.reason;
}

void add_surface(Json& json, const MeshCertificate& c, bool outer) {
  if (!c.closed) {
    json["surface"] = "none";
  } else if (c.surface) {
    const certify::DecidedSurface& surface = *c.surface;
    json["surface"] = decided_surface(surface.claim, outer);
    json["surface_triangles_looked_at"] = surface.looked_at;
    if (surface.left_out > 0) json["surface_triangles_left_out"] = surface.left_out;
    if (surface.claim.answer == Answer::Refuted) {
      const verify::Bracket& out = surface.sticks_out;
      json["surface_triangles_outside"] = surface.claim.inner_triangles.size();
      json["surface_depth"] = {{"lower", out.lower},
                               {"upper", std::isfinite(out.upper) ? Json(out.upper) : Json()},
                               {"at", {out.at.x(), out.at.y(), out.at.z()}},
                               {"triangle", surface.at_filling ? Json() : Json(out.triangle)}};
    }
  }
}

Json claims_of(const DecimationCase& run, const MeshCertificate& c) {
  if (c.direction == bmesh::Direction::Any) return {{"solid", "none"}, {"surface", "none"}};
  const bool outer = run.outer();
  Json json{{"of", in_words(c.subject)}};
  json["solid"] = c.closed ? (outer ? "certified: the result's solid contains the input's"
                                    : "certified: the input's solid contains the result's")
                           : "open mesh: certified only that the generalised winding number "
                             "nowhere " +
                                 std::string(outer ? "falls" : "rises");
  if (run.series().meshes.size() > 1)
    json["nested"] = outer ? "certified: contains the finer results"
                           : "certified: contained in the finer results";
  add_surface(json, c, outer);
  return json;
}

Json steps_of(const bmesh::DecimateStatistics& s) {
  return {{"contractions", s.contractions},
          {"moves", s.moves},
          {"pull_backs", s.pull_backs},
          {"flips", s.flips},
          {"placements", s.placements},
          {"predicates", s.predicates},
          {"exact_fallbacks", s.exact_fallbacks},
          {"rejected",
           {{"topology", s.rejected_topology},
            {"no_position", s.rejected_no_position},
            {"predicate", s.rejected_predicate},
            {"fold", s.rejected_fold},
            {"distance", s.rejected_distance},
            {"spike", s.rejected_spike},
            {"original", s.rejected_original}}}};
}

/// What the report says of one result.
Json result_of(const DecimationCase& run, std::size_t place) {
  const certify::CertifiedMesh& made = run.series().meshes[place];
  const MeshCertificate& c = made.certificate();
  const std::string& file = run.files[place];
  const double diagonal = run.series().plan.diagonal;
  Json r;
  r["stop"] = name_of_stop(c.stop);
  r["out_of_work"] = c.out_of_work;
  r["output"] = {{"file", file.empty() ? Json() : Json(file)},
                 {"precision", c.double_precision ? "double" : "float"}};
  r["output"].update(to_json(geom::analyse(made.artefact())));
  r["claims"] = claims_of(run, c);
  if (c.decided) r["verification"] = verification_of(*c.decided);
  r["certificate"] = steps_of(c.statistics);
  r["distance"] = {{"meaning",
                    "one-sided, surface to surface, certified brackets of the maximum, in the "
                    "input's unit; "
                    "the original is the input after preparation"},
                   {"bbox_diagonal", diagonal},
                   {"original_to_result", to_json(*c.original_to_result, diagonal)},
                   {"result_to_original", to_json(*c.result_to_original, diagonal)},
                   {"hausdorff_upper", c.hausdorff_upper()}};
  return r;
}

}  // namespace

Json report_of(const DecimationCase& run) {
  Json r{
      {"input", input_of(run)}, {"preparation", preparation_of(run)}, {"options", options_of(run)}};
  if (!run.asked.progressive.empty()) r["progressive"] = run.asked.progressive;
  if (run.series().meshes.size() == 1) {
    r.update(result_of(run, 0));
  } else {
    for (std::size_t i = 0; i < run.series().meshes.size(); ++i) {
      const MeshCertificate& c = run.series().meshes[i].certificate();
      Json& entry = r["levels"].emplace_back();
      entry["vertices"] = *c.requested;
      entry["reached"] = c.stop == bmesh::Stop::VertexTarget;
      entry.update(result_of(run, i));
    }
  }
  r["resources"] = {{"user_seconds_reading", run.seconds_read},
                    {"user_seconds_decimating", run.seconds_decimated - run.seconds_read},
                    {"threads", run.asked.common.threads}};
  return r;
}

}  // namespace kaboum::tools
