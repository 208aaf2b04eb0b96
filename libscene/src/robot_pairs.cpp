// Pairs of a robot's links that need no check, proved of the bodies that were made.

#include <kaboum/base/error.h>
#include <kaboum/scene/robot_pairs.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/world.h>

#include <algorithm>
#include <cstdint>

namespace kaboum::scene {
namespace {

using Reason = world::AllowedPair::Reason;

/// A robot as worlds have it, by the certified sets of its links, standing at the origin. Links
/// that have points only, and those without a set, have no shape in it.
/// @param visual  the sets hold shapes for drawing
world::RobotModel robot_model(const robot::Robot& robot,
                              const std::vector<certify::CertifiedLink>& links, bool visual) {
  world::RobotModel model;
  model.name = robot.name;
  model.kinematics = robot;
  for (const certify::CertifiedLink& link : links) {
    // Of a link that has points only nothing is proved: its pairs are left to the checks.
    if (link.artefact().bodies.empty()) continue;
    // Nor of one with a plane, which no set holds.
    if (std::ranges::any_of(
            robot.links[link.certificate().link].unread,
            [&](const robot::UnreadShape& unread) { return visual || !unread.visual; }))
      continue;
    model.shapes.push_back({static_cast<std::uint32_t>(link.certificate().link),
                            world::BoundingSet(link.artefact()),
                            {}});
  }
  return model;
}

}  // namespace

RobotPairs pairs_of(const robot::Robot& robot, const certify::CertifiedRobot& made,
                    const std::function<void()>& progress) {
  const robot::ShapeChoice& choice = made.bodies.certificate().choice;
  if (!choice.links.empty())
    throw Error(ErrorCode::InvalidArgument,
                "pairs of links (srdf) are about all links of a robot: only some have sets here");
  world::RobotModel model = robot_model(robot, made.links, choice.visual);
  // A link whose shapes for drawing could not be held is no frame across which others are adjacent.
  if (choice.visual)
    for (robot::Link& link : model.kinematics.links)
      link.collision.insert(link.collision.end(), link.visual.begin(), link.visual.end());
  world::PairOptions options;
  if (progress)
    options.stop = [&] {
      progress();
      return false;
    };
  const std::vector<world::LinkPair> examined = examine_pairs(model, options);
  const std::vector<world::AllowedPair> allowed = pairs_without_check(model, examined);
  RobotPairs out;
  for (const world::AllowedPair& pair : allowed)
    ++(pair.reason == Reason::Never      ? out.never
       : pair.reason == Reason::Adjacent ? out.adjacent
                                         : out.fixed);
  for (const world::LinkPair& pair : examined) out.others += pair.reason ? 0 : 1;
  out.srdf = to_srdf(model, allowed);
  return out;
}

}  // namespace kaboum::scene
