// Pairs of a robot's links that need no check, proved of the bodies that were made.

#include "robot_pairs.h"

#include <kaboum/world/allowed_pairs.h>

#include <cstdint>

namespace kaboum::tools {
namespace {

using Reason = world::AllowedPair::Reason;

world::RobotModel model_of(const robot::Robot& robot,
                           const std::vector<certify::CertifiedLink>& links) {
  world::RobotModel model;
  model.name = robot.name;
  model.kinematics = robot;
  for (const certify::CertifiedLink& link : links) {
    // Of a link that has points only nothing is proved: its pairs are left to the checks.
    if (link.artefact().bodies.empty()) continue;
    model.shapes.push_back({static_cast<std::uint32_t>(link.certificate().link),
                            world::BoundingSet(link.artefact()),
                            {}});
  }
  return model;
}

}  // namespace

RobotPairs pairs_of(const robot::Robot& robot, const std::vector<certify::CertifiedLink>& links) {
  const world::RobotModel model = model_of(robot, links);
  const std::vector<world::LinkPair> examined = examine_pairs(model, {});
  const std::vector<world::AllowedPair> allowed = pairs_without_check(model, examined);
  RobotPairs out;
  for (const world::AllowedPair& pair : allowed)
    ++(pair.reason == Reason::Never      ? out.never
       : pair.reason == Reason::Adjacent ? out.adjacent
                                         : out.fixed);
  for (const world::LinkPair& pair : examined) out.others += pair.reason ? 0 : 1;
  out.srdf = to_srdf(model, allowed);
  out.words = "pairs of links that need no check: " + std::to_string(out.adjacent) + " adjacent, " +
              std::to_string(out.never) + " proved never to touch, " + std::to_string(out.fixed) +
              " fixed to each other; " + std::to_string(out.others) + " others";
  return out;
}

Json report_of(const RobotPairs& pairs) {
  return {{"adjacent", pairs.adjacent},
          {"never_in_contact", pairs.never},
          {"fixed_to_each_other", pairs.fixed},
          {"others", pairs.others}};
}

}  // namespace kaboum::tools
