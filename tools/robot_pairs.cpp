// Pairs of a robot's links that need no check, proved of the bodies that were made.

#include "robot_pairs.h"

#include <kaboum/world/allowed_pairs.h>

#include <vector>

namespace kaboum::tools {
namespace {

using Reason = world::AllowedPair::Reason;

world::RobotModel model_of(const robot::Robot& robot,
                           const std::vector<certify::CertifiedLink>& links) {
  world::RobotModel model;
  model.name = robot.name;
  model.kinematics = robot;
  for (const certify::CertifiedLink& link : links)
    model.shapes.push_back({static_cast<std::uint32_t>(link.certificate().link),
                            world::BoundingSet(link.artefact()),
                            {}});
  return model;
}

}  // namespace

RobotPairs pairs_of(const robot::Robot& robot, const std::vector<certify::CertifiedLink>& links) {
  const world::RobotModel model = model_of(robot, links);
  std::vector<world::AllowedPair> allowed = connected_links(model);
  RobotPairs out;
  for (const world::LinkPair& pair : examine_pairs(model, {})) {
    std::size_t& count = !pair.reason                       ? out.others
                         : *pair.reason == Reason::Never    ? out.never
                         : *pair.reason == Reason::Adjacent ? out.adjacent
                                                            : out.always;
    ++count;
    if (pair.reason && *pair.reason != Reason::Adjacent)
      allowed.push_back({pair.a, pair.b, *pair.reason});
  }
  out.srdf = to_srdf(model, allowed);
  out.words = "pairs of links that need no check: " + std::to_string(out.adjacent) + " adjacent, " +
              std::to_string(out.never) + " proved never to touch, " + std::to_string(out.always) +
              " fixed to each other; " + std::to_string(out.others) + " others";
  return out;
}

}  // namespace kaboum::tools
