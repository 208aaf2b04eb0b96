// `bound-verify robot ROBOT --spheres FILE`: whether spheres hold the links of a robot.
#include "robot_spheres.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/robot/sphere_file.h>
#include <kaboum/verify/sphere_verdict.h>

#include <cmath>
#include <iostream>

#include "common/file_kind.h"
#include "common/verdict.h"
#include "robot_bodies.h"
#include "robots/spheres_page.h"

namespace kaboum::tools {
namespace {

Json point_json(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json claim_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness) json["witness"] = {{"point", point_json(claim.witness->point)}};
  return json;
}

Json link_json(const verify::LinkSpheresVerdict& link) {
  Json json{{"link", link.link},
            {"answer", name_of(link.answer)},
            {"sentence", link.sentence},
            {"spheres", link.spheres},
            {"triangles", link.triangles},
            {"claims",
             {{"surface", claim_json(link.inclusion.surface)},
              {"solid", claim_json(link.inclusion.solid)}}}};
  const verify::OutsideBalls& o = link.outside;
  json["share_outside"] = {{"lower", o.share_lower}, {"upper", o.share_upper}};
  if (std::isfinite(o.depth_upper))
    json["depth"] = {{"lower", o.depth_lower}, {"upper", o.depth_upper}, {"at", point_json(o.at)}};
  if (link.missed) {
    json["missed"] = {{"point", point_json(link.missed->point)}};
    if (std::isfinite(link.missed->depth)) json["missed"]["depth"] = link.missed->depth;
  }
  add_reach(link.reach, json["claims"]);
  return json;
}

/// @throws Error as robot::read_spheres; of a robot with other shapes it says what judges them
robot::SphereFile read(const std::string& file) {
  try {
    return robot::read_spheres(file);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput || kind_of(file) != FileKind::Robot) throw;
    throw Error(error.code(), std::string(error.what()) +
                                  ". A robot's meshes are judged as RESULT, its boxes, cylinders "
                                  "and capsules by --bodies");
  }
}

}  // namespace

int verify_spheres(const VerifyRobotOptions& o, const CommonOptions& common) {
  const ThreadLimit threads(common.threads);
  require_apart({{"--report", common.report}, {"--page", o.page}},
                {o.original, o.spheres, o.epsilon_map.value_or("")});
  const robot::RobotFile robot =
      robot::read_robot(o.original, robot::Motions::None, o.xacro_arguments, o.how.shapes.packages);
  robot::require_links(robot, o.how.shapes.links);
  const robot::SphereFile spheres = read(o.spheres);
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  const verify::SpheresVerdict verdict = verify::decide_spheres(
      robot, spheres, o.spheres, o.how.shapes,
      [&](const verify::LinkSpheresVerdict& link) {
        if (!common.quiet)
          out << "link '" << link.link << "': " << name_of(link.answer) << ": " << link.sentence
              << std::endl;
      },
      length_of_reach(o.how.epsilon), bounds_of(o, robot));
  for (const std::string& note : verdict.notes)
    log(common.quiet, "note: " + o.spheres + ": " + note);
  if (!o.page.empty()) io::write_file(o.page, page_of_spheres(robot, o.spheres, verdict));
  if (!common.report.empty()) {
    Json links = Json::array();
    for (const verify::LinkSpheresVerdict& link : verdict.links) links.push_back(link_json(link));
    write_report(
        common, "bound-verify",
        {{"relation", "spheres"},
         {"verdict", name_of(verdict.answer)},
         {"geometry", o.how.shapes.visual ? "visual" : "collision"},
         {"original", {{"file", o.original}, {"sha256", robot.sha256}}},
         {"spheres", {{"file", o.spheres}, {"format", spheres.format}}},
         {"count", verdict.spheres},
         {"links_held", verdict.held},
         {"uncovered", verdict.uncovered},
         {"share_outside", {{"lower", verdict.share_lower}, {"upper", verdict.share_upper}}},
         {"depth", verdict.depth},
         {"epsilon", verdict.epsilon ? Json(*verdict.epsilon) : Json()},
         {"links", std::move(links)},
         {"notes", verdict.notes}});
  }
  if (!common.quiet) out << name_of(verdict.answer) << ": " << verdict.sentence << std::endl;
  return exit_code(verdict.answer);
}

}  // namespace kaboum::tools
