// Which links of a robot can touch each other at all.

#include <kaboum/pairs/relation.h>
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

using pairs::Shaped;

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

std::vector<AllowedPair> connected(const robot::Robot& robot, const Shaped& shaped) {
  std::vector<AllowedPair> out;
  for (std::uint32_t a = 0; a < robot.links.size(); ++a)
    for (std::uint32_t b = a + 1; b < robot.links.size(); ++b)
      if (pairs::relation_of(robot, shaped, a, b) != pairs::Relation::Moving)
        out.push_back(
            {a, b, pairs::are_adjacent(robot, shaped, a, b) ? Reason::Adjacent : Reason::Always});
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
      if (pairs::are_adjacent(robot.kinematics, shaped, a.link, b.link)) {
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
