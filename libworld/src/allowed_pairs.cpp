// Which links of a robot can touch each other at all.

#include <kaboum/world/allowed_pairs.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <map>

#include "pair_proof.h"

namespace kaboum::world {
namespace {

using Reason = AllowedPair::Reason;

/// The link that fixed joints make one body with this one: the one nearest to the root.
std::uint32_t body_of(const robot::Robot& robot, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// Of each link, whether it has shapes.
using Shaped = std::vector<char>;

Shaped shaped_links(const robot::Robot& robot) {
  Shaped out;
  for (const robot::Link& link : robot.links) out.push_back(link.collision.empty() ? 0 : 1);
  return out;
}

Shaped shaped_links(const RobotModel& robot) {
  Shaped out = shaped_links(robot.kinematics);
  for (const LinkShape& shape : robot.shapes) out[shape.link] = 1;
  return out;
}

/// A link itself if it has shapes or moves against its parent; else the nearest such one on the way
/// to the root: flanges and frames between a joint and what it carries.
std::uint32_t carrier_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t link) {
  while (link > 0 && shaped[link] == 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
    link = robot.joints[link - 1].parent;
  return link;
}

/// The child, but for frames without shapes that are fixed between it and the joint that it hangs
/// on.
std::uint32_t joint_of(const robot::Robot& robot, const Shaped& shaped, std::uint32_t link) {
  while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed &&
         robot.joints[link - 1].parent > 0 && shaped[robot.joints[link - 1].parent] == 0)
    link = robot.joints[link - 1].parent;
  return link;
}

/// Whether one joint connects both, with nothing that has shapes between them. What is fixed to the
/// one elsewhere (a camera, a wall beside a rail) is not meant: it may well be touched.
bool are_adjacent(const robot::Robot& robot, const Shaped& shaped, std::uint32_t a,
                  std::uint32_t b) {
  const auto hangs_on = [&](std::uint32_t child, std::uint32_t parent) {
    if (child > 0 && robot.joints[child - 1].parent == parent) return true;
    const std::uint32_t joint = joint_of(robot, shaped, child);
    return joint > 0 && carrier_of(robot, shaped, robot.joints[joint - 1].parent) == parent;
  };
  return hangs_on(a, b) || hangs_on(b, a);
}

std::vector<AllowedPair> connected(const robot::Robot& robot, const Shaped& shaped) {
  std::vector<AllowedPair> out;
  for (std::uint32_t a = 0; a < robot.links.size(); ++a)
    for (std::uint32_t b = a + 1; b < robot.links.size(); ++b)
      if (are_adjacent(robot, shaped, a, b))
        out.push_back({a, b, Reason::Adjacent});
      else if (body_of(robot, a) == body_of(robot, b))
        out.push_back({a, b, Reason::Always});
  return out;
}

}  // namespace

std::vector<AllowedPair> connected_links(const robot::Robot& robot) {
  return connected(robot, shaped_links(robot));
}

std::vector<AllowedPair> connected_links(const RobotModel& robot) {
  return connected(robot.kinematics, shaped_links(robot));
}

std::vector<LinkPair> examine_pairs(const RobotModel& robot, const PairOptions& given) {
  using Clock = std::chrono::steady_clock;
  PairOptions options = given;
  if (std::isfinite(given.most_seconds))
    options.stop = [&, begin = Clock::now(),
                    allowed = std::chrono::duration<double>(given.most_seconds)] {
      return (given.stop && given.stop()) || Clock::now() - begin > allowed;
    };
  std::map<std::pair<std::uint32_t, std::uint32_t>, LinkPair> found;
  const Shaped shaped = shaped_links(robot);
  for (const LinkShape& a : robot.shapes) {
    for (const LinkShape& b : robot.shapes) {
      if (a.link >= b.link) continue;
      LinkPair pair{a.link, b.link, std::nullopt, false};
      if (are_adjacent(robot.kinematics, shaped, a.link, b.link)) {
        pair.reason = Reason::Adjacent;
      } else {
        pair = detail::examine_pair(robot, a, b, options);
      }
      const auto [known, is_new] = found.emplace(std::pair(a.link, b.link), pair);
      if (is_new) continue;
      known->second.meets = known->second.meets || pair.meets;
      if (known->second.reason != pair.reason) known->second.reason.reset();
    }
  }
  std::vector<LinkPair> out;
  out.reserve(found.size());
  for (const auto& [links, pair] : found) out.push_back(pair);
  return out;
}

std::vector<AllowedPair> pairs_without_check(const RobotModel& robot,
                                             const std::vector<LinkPair>& examined) {
  std::vector<AllowedPair> out = connected_links(robot);
  const auto is_connected = [&, connected = out.size()](const LinkPair& pair) {
    return std::any_of(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(connected),
                       [&](const AllowedPair& p) { return p.a == pair.a && p.b == pair.b; });
  };
  for (const LinkPair& pair : examined)
    if (pair.reason == Reason::Never && !is_connected(pair))
      out.push_back({pair.a, pair.b, Reason::Never});
  return out;
}

}  // namespace kaboum::world
