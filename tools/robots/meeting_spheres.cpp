// Spheres that meet though their links do not.

#include "meeting_spheres.h"

#include <kaboum/robot/kinematics.h>
#include <kaboum/world/allowed_pairs.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>

namespace kaboum::tools {
namespace {

constexpr int kConfigurations = 1000, kNearlyAll = 900;

struct Balls {
  std::uint32_t link;
  std::vector<std::pair<geom::Vec3, double>> of;
};

bool meet(const Balls& a, const geom::Transform& at_a, const Balls& b,
          const geom::Transform& at_b) {
  for (const auto& [center, radius] : a.of) {
    const geom::Vec3 c = at_a * center;
    for (const auto& [other, reach] : b.of)
      if ((at_b * other - c).norm() <= radius + reach) return true;
  }
  return false;
}

std::vector<Balls> balls_of(const robot::Robot& robot, const robot::SphereFile& spheres) {
  std::vector<Balls> out;
  for (const robot::LinkSpheres& link : spheres.links) {
    const auto index = robot.find_link(link.link);
    if (!index) continue;
    Balls own{*index, {}};
    for (const geom::ConvexBody& ball : link.balls.bodies)
      own.of.emplace_back(ball.core.vertices.front(), ball.radius);
    out.push_back(std::move(own));
  }
  return out;
}

}  // namespace

std::vector<MeetingLinks> meeting_links(
    const robot::Robot& robot, const robot::SphereFile& spheres,
    const std::vector<std::pair<std::string, std::string>>& unchecked) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> left_out;
  for (const auto& [a, b] : unchecked) {
    const auto first = robot.find_link(a), second = robot.find_link(b);
    if (first && second) left_out.insert(std::minmax(*first, *second));
  }
  for (const world::AllowedPair& pair : world::connected_links(robot))
    left_out.insert(std::minmax(pair.a, pair.b));
  const std::vector<Balls> balls = balls_of(robot, spheres);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (balls[i].link != balls[j].link &&
          !left_out.contains(std::minmax(balls[i].link, balls[j].link)))
        pairs.emplace_back(j, i);
  std::vector<int> met(pairs.size(), 0);
  std::mt19937_64 random(1);
  for (int k = 0; k < kConfigurations; ++k) {
    std::vector<double> q;
    for (const robot::Variable& v : robot.variables) {
      const double low = v.lower.value_or(-std::numbers::pi),
                   high = v.upper.value_or(std::numbers::pi);
      q.push_back(low + 0x1p-64 * static_cast<double>(random()) * (high - low));
    }
    const std::vector<geom::Transform> at = robot::forward(robot, q);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const Balls &a = balls[pairs[p].first], &b = balls[pairs[p].second];
      met[p] += meet(a, at[a.link], b, at[b.link]) ? 1 : 0;
    }
  }
  std::vector<MeetingLinks> out;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (met[p] >= kNearlyAll)
      out.push_back({robot.links[balls[pairs[p].first].link].name,
                     robot.links[balls[pairs[p].second].link].name, met[p]});
  return out;
}

std::string text_of(const MeetingLinks& links, const std::string& epsilon) {
  return "WARNING: spheres of '" + links.a + "' and '" + links.b + "' meet in " +
         std::to_string(links.of_thousand) +
         " of 1000 configurations drawn, where the links may be apart: a planner that checks this "
         "pair finds next to no way; give the two a smaller epsilon (" +
         epsilon + "), or leave the pair out where kaboum-pairs proves that they never touch";
}

}  // namespace kaboum::tools
