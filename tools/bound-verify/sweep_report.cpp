// The verdict on a motion, in words and as a report.

#include "sweep_report.h"

#include <kaboum/base/number_text.h>
#include <kaboum/verify/moving_robot.h>

#include <iomanip>
#include <sstream>

#include "common/verdict.h"

namespace kaboum::tools {

using verify::Answer;

namespace {

std::string line(const char* title, const verify::Claim& claim, const std::string& what) {
  return std::string(title) + ": " + name_of(claim.answer) + ": " +
         (claim.answer == Answer::Verified ? what : claim.reason);
}

std::string say(const verify::SweepPlace& p, const SweepCase& run) {
  std::ostringstream text;
  text << std::setprecision(17) << run.shapes.shapes[p.shape].name << " at " << p.s
       << " of segment " << p.segment + 1 << ", " << point(p.point);
  return text.str();
}

std::string line_of(const verify::MovingPointClaim& exact, const SweepCase& run) {
  const verify::PointClaim& p = exact.points;
  std::string text = std::string("points of exact faces: ") + name_of(p.answer) + ": ";
  if (p.answer == Answer::Undefined) return text + p.reason;
  text += std::to_string(p.outside) + " of " + std::to_string(p.points) + " looked at, at " +
          std::to_string(exact.configurations) + " configurations, stick out";
  if (p.outside == 0) return text;
  return text + ", by up to " + number_up(p.farthest) + ": of " +
         run.shapes.exact[exact.shape].name + " at " + number_text(exact.s) + " of segment " +
         std::to_string(exact.segment + 1) + ", " + point(p.at);
}

}  // namespace

std::vector<std::string> lines_of(const SweepCase& run) {
  std::vector<std::string> lines;
  const verify::SweepClaims& claims = run.verdict.claims;
  const std::string radii = text_of_radii(run.swept.set);
  lines.push_back(
      line("convexity", claims.convex,
           "all " + std::to_string(run.swept.set.bodies.size()) + " bodies are convex"));
  lines.push_back(line("surface claim", claims.surface,
                       "during the whole path " + std::to_string(run.shapes.shapes.size()) +
                           " shapes of the links stay within " + "the bodies" +
                           (radii.empty() ? "" : ", " + radii)));
  if (claims.refuting)
    lines.push_back("  " + say(*claims.refuting, run) + ": " + number(claims.refuting->distance) +
                    " from the nearest body" + (radii.empty() ? ", margin 0" : ", " + radii));
  else if (claims.undecided)
    lines.push_back("  " + say(*claims.undecided, run));
  if (!claims.refuting && run.knows_farthest())
    lines.push_back("  farthest of " + std::to_string(claims.samples) +
                    " places sampled: " + number(claims.farthest.distance) + ", " +
                    (claims.farthest.distance > 0 ? say(claims.farthest, run) : "none is outside"));
  if (run.asked.how.claims != verify::Claims::Surface && claims.solid.answer != Answer::Undefined)
    lines.push_back(line("solid claim", claims.solid, "so do the insides of the closed shapes"));
  if (claims.open_meshes > 0)
    lines.push_back(std::to_string(claims.open_meshes) +
                    " meshes are not closed: their surfaces alone are judged");
  const verify::MotionShapes& shapes = run.shapes;
  if (run.verdict.exact) lines.push_back(line_of(*run.verdict.exact, run));
  lines.push_back(std::string(name_of(run.verdict.answer)) + ": " +
                  robot::links_judged(shapes.judged, shapes.asked, shapes.bare) +
                  except_sheets(shapes.dropped) +
                  (!shapes.cad || run.verdict.answer != Answer::Verified ? ""
                   : run.verdict.exact
                       ? "; of the triangles, which stand for exact faces; no point of "
                         "these that was looked at sticks out"
                       : kOfTriangles));
  return lines;
}

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
  const verify::SweepClaims& claims = run.verdict.claims;
  const verify::MotionShapes& shapes = run.shapes;
  Json json{{"relation", "sweep"},
            {"verdict", name_of(run.verdict.answer)},
            {"deciding_claims", name_of(o.how.claims)},
            {"robot", {{"file", o.robot}, {"sha256", run.robot.sha256}, {"meshes", shapes.files}}},
            {"path", {{"file", o.path}, {"waypoints", run.path.size()}}},
            {"swept",
             {{"file", o.swept},
              {"sha256", run.swept.sha256},
              {"bodies", run.swept.set.bodies.size()},
              {"margin", margin_json(run.swept.set)}}},
            {"gap", run.verdict.gap},
            {"claims",
             {{"convex", to_json(claims.convex)},
              {"surface", to_json(claims.surface)},
              {"solid", to_json(claims.solid)}}}};
  if (claims.refuting) json["claims"]["surface"]["place"] = to_json(*claims.refuting, run);
  if (claims.undecided)
    json["claims"]["surface"]["first_undecided"] = to_json(*claims.undecided, run);
  if (const auto& exact = run.verdict.exact) {
    Json& claim = json["claims"]["exact_points"];
    claim = {{"answer", name_of(exact->points.answer)}, {"reason", exact->points.reason},
             {"points", exact->points.points},          {"outside", exact->points.outside},
             {"configurations", exact->configurations}, {"rounding", exact->points.rounding}};
    if (exact->points.outside > 0) {
      claim["shape"] = shapes.exact[exact->shape].name;
      claim["segment"] = exact->segment + 1;
      claim["s"] = exact->s;
      claim["farthest"] = exact->points.farthest;
      claim["at"] = to_json(exact->points.at);
      claim["face"] = exact->points.face + 1;
    }
  }
  if (run.knows_farthest()) json["largest_found"] = to_json(claims.farthest, run);
  json["prepared"] = o.how.shapes.prepare;
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
