// What was found of a motion, as a report.
#include <kaboum/verify/moving_robot.h>

#include "sweep_case.h"

namespace kaboum::tools {
namespace {

Json to_json(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const verify::SweepPlace& p, const SweepCase& run) {
  return {{"shape", run.shapes.shapes[p.shape].name},
          {"segment", p.segment + 1},
          {"s", p.s},
          {"configuration", verify::configuration_at(run.path, p)},
          {"point", to_json(p.point)},
          {"distance", p.distance}};
}

Json to_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness)
    json["witness"] = {{"point", to_json(claim.witness->point)}, {"depth", claim.witness->depth}};
  return json;
}

}  // namespace

Json report_of(const SweepCase& run) {
  const VerifySweepOptions& o = run.asked;
  const verify::SweepClaims& claims = run.claims;
  const SweepShapes& shapes = run.shapes;
  Json json{
      {"relation", "sweep"},
      {"verdict", name_of(run.answer)},
      {"deciding_claims", o.claims},
      {"robot", {{"file", o.files[0]}, {"sha256", run.robot.sha256}, {"meshes", shapes.files}}},
      {"path", {{"file", o.files[1]}, {"waypoints", run.path.size()}}},
      {"swept",
       {{"file", o.files[2]},
        {"sha256", run.swept.sha256},
        {"bodies", run.swept.set.bodies.size()},
        {"margin", run.swept.set.margin}}},
      {"gap", run.gap},
      {"claims",
       {{"convex", to_json(claims.convex)},
        {"surface", to_json(claims.surface)},
        {"solid", to_json(claims.solid)}}}};
  if (claims.refuting) json["claims"]["surface"]["place"] = to_json(*claims.refuting, run);
  if (claims.undecided)
    json["claims"]["surface"]["first_undecided"] = to_json(*claims.undecided, run);
  if (run.knows_farthest()) json["largest_found"] = to_json(claims.farthest, run);
  json["prepared"] = o.prepare;
  json["dropped_sheet_triangles"] = shapes.dropped;
  json["open_meshes"] = claims.open_meshes;
  json["shapes"] = shapes.shapes.size();
  json["links"] = {{"asked", shapes.asked},
                   {"judged", shapes.judged},
                   {"without_shapes", shapes.bare.all()},
                   {"with_other_shapes_only", shapes.bare.other}};
  json["cells"] = claims.cells;
  json["samples"] = claims.samples;
  return json;
}

}  // namespace kaboum::tools
