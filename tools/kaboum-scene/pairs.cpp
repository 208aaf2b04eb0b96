// kaboum-scene pairs: pairs of links that never touch, or always do.

#include "pairs.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/scene/scene_update.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/scene.h>

#include <iostream>

namespace kaboum::tools {

int find_pairs(const SceneOptions& o) {
  require_apart({{"--srdf", o.srdf}, {"--report", o.common.report}}, scene::files_of(o.scene));
  const world::SceneFile scene = world::read_scene(o.scene);
  for (const std::string& note : scene.notes) log(o.common.quiet, note);
  const auto say = [&](const std::string& line) {
    if (!o.common.quiet) std::cout << line << '\n';
  };
  const world::RobotModel& robot = scene.world.robots[world::robot_named(scene.world, o.robot)];
  const auto name = [&](std::uint32_t link) { return robot.kinematics.links[link].name; };
  Json pairs = Json::array(), never = Json::array();
  std::vector<world::AllowedPair> proofs;
  const std::vector<world::LinkPair> examined = examine_pairs(robot, o.pairs);
  for (const world::LinkPair& pair : examined) {
    const std::string reason = pair.reason ? name_of(*pair.reason) : "unproved";
    pairs.push_back({{"links", {name(pair.a), name(pair.b)}},
                     {"reason", reason},
                     {"contact_found", pair.meets},
                     {"contact_always", pair.meets_always}});
    say(name(pair.a) + " " + name(pair.b) + ": " +
        (pair.reason         ? reason
         : pair.meets_always ? "in contact everywhere, though they move against each other"
         : pair.meets        ? "in contact somewhere"
                             : reason));
    if (pair.reason != world::AllowedPair::Reason::Never) continue;
    never.push_back({name(pair.a), name(pair.b)});
    proofs.push_back({pair.a, pair.b, *pair.reason});
  }
  if (!o.srdf.empty()) {
    const std::string text = to_srdf(robot, pairs_without_check(robot, examined));
    io::write_file(o.srdf, {text.data(), text.size()});
  }
  const Json proved = {{"proved_for", proof_hash(robot, proofs)}, {"pairs", never}};
  if (!never.empty()) say("for the robot in the scene: \"never_in_contact\": " + proved.dump());
  write_report(o.common, "kaboum-scene",
               {{"command", "pairs"},
                {"scene", o.scene},
                {"robot", robot.name},
                {"pairs", pairs},
                {"never_in_contact", proved}});
  return kDone;
}

}  // namespace kaboum::tools
