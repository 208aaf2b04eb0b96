// Motions looked at at instants, by a substitute of the bounded predicates.

#include "sampled_motion.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>

namespace kaboum::world::detail {
namespace {

constexpr std::size_t kToldEvery = 256;  // samples

/// The instants of a motion, one after another.
class Samples {
 public:
  Samples(const Checker& checker, const WorldState& state, const std::vector<MovingRobot>& robots,
          const MotionOptions& options)
      : checker_(checker), state_(state), robots_(robots), options_(options) {
    if (!(checker.substitute()->step() > 0))
      throw Error(ErrorCode::InvalidArgument, "a step must be above 0");
    for (std::size_t r = 0; r < checker.world().robots.size(); ++r) {
      if (!moves(r)) continue;
      for (std::size_t s = 0; s < checker.world().robots[r].shapes.size(); ++s)
        movers_.push_back(mover_of(checker, state, {r, s}));
    }
    for (std::size_t o = 0; o < state.attachments.size(); ++o) {
      const auto& held = state.attachments[o];
      if (held && moves(held->robot))
        movers_.push_back(mover_of(checker, state, {Item::kObject, o}));
    }
  }

  /// Calls look(state, segment, share) until it is true.
  /// @return samples that were looked at; nullopt: more than the options allow are needed.
  template <typename Look>
  std::optional<std::size_t> visit(const Look& look) {
    std::size_t looked_at = 0;
    const std::size_t waypoints = robots_.front().path->size();
    for (std::size_t segment = 0; segment == 0 || segment + 1 < waypoints; ++segment) {
      const double wanted =
          waypoints == 1 ? 0 : std::ceil(most_moved(segment) / checker_.substitute()->step());
      if (!(wanted + static_cast<double>(looked_at) < static_cast<double>(options_.most_intervals)))
        return std::nullopt;
      const std::size_t count = waypoints == 1 ? 0 : std::max<std::size_t>(1, to_count(wanted));
      for (std::size_t k = segment == 0 ? 0 : 1; k <= count; ++k) {
        const double share = count == 0 ? 0 : static_cast<double>(k) / static_cast<double>(count);
        place(segment, share);
        if (options_.progress && looked_at % kToldEvery == 0)
          options_.progress("segment " + std::to_string(segment + 1) + ", " +
                            std::to_string(looked_at) + " samples");
        ++looked_at;
        if (look(state_, segment, share)) return looked_at;
      }
    }
    return looked_at;
  }

 private:
  static std::size_t to_count(double x) { return static_cast<std::size_t>(x); }

  [[nodiscard]] bool moves(std::size_t robot) const {
    return std::ranges::any_of(robots_, [&](const MovingRobot& m) { return m.robot == robot; });
  }
  [[nodiscard]] const robot::Path& path_of(std::size_t robot) const {
    return *std::ranges::find(robots_, robot, &MovingRobot::robot)->path;
  }

  /// Bound of how far a point of what moves goes in a segment. [length]
  [[nodiscard]] double most_moved(std::size_t segment) const {
    double most = 0;
    for (const Mover& m : movers_) {
      const robot::Path& path = path_of(m.robot);
      const sweep::LinkMotion motion(checker_.world().robots[m.robot].kinematics, m.link,
                                     path[segment], path[segment + 1]);
      if (motion.moves()) most = std::max(most, sweep::MotionBounds(motion, m.reach).derivative(1));
    }
    return most;
  }

  void place(std::size_t segment, double share) {
    for (const auto& [robot, path, around] : robots_) {
      const std::vector<double>&from = (*path)[segment],
            &to = (*path)[std::min(segment + 1, path->size() - 1)];
      std::vector<double>& q = state_.q[robot];
      q = share < 1 ? from : to;
      if (share > 0 && share < 1)
        for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * (to[i] - from[i]);
    }
  }

  const Checker& checker_;
  WorldState state_;
  const std::vector<MovingRobot>& robots_;
  const MotionOptions& options_;
  std::vector<Mover> movers_;
};

/// The pairs of which a robot of these moves one: as for MovingPairs, a path that leaves the limits
/// makes those count that are proved apart within them.
std::vector<std::array<Item, 2>> moving_pairs(const Checker& checker, const WorldState& state,
                                              const std::vector<MovingRobot>& robots) {
  WorldState start = state;
  for (const auto& [robot, path, around] : robots) {
    start.q[robot] = path->front();
    for (const std::vector<double>& q : *path)
      if (!checker.is_within_limits(robot, q)) start.q[robot] = q;
  }
  std::vector<std::array<Item, 2>> out = checker.pairs(start, {});
  std::erase_if(out, [&](const std::array<Item, 2>& pair) {
    return std::ranges::none_of(pair, [&](const Item& item) {
      return std::ranges::any_of(
          robots, [&](const MovingRobot& m) { return is_moved_by(m.robot, item, state); });
    });
  });
  return out;
}

}  // namespace

MotionAnswer sampled_motion(const Checker& checker, const WorldState& state,
                            const std::vector<MovingRobot>& robots, const MotionOptions& options) {
  MotionAnswer out;
  Samples samples(checker, state, robots, options);
  const std::vector<std::array<Item, 2>> pairs = moving_pairs(checker, state, robots);
  const auto count = samples.visit([&](const WorldState& now, std::size_t segment, double share) {
    const auto found = checker.substitute()->find_meeting(now, pairs, false);
    if (found.empty()) return false;
    out.outcome = MotionAnswer::Outcome::Contact;
    out.segment = out.contact_segment = segment;
    out.share = out.contact_share = share;
    out.contact = substituted_contact(pairs[found.front()]);
    out.meets = true;
    return true;
  });
  if (!count) {
    out.outcome = MotionAnswer::Outcome::Undecided;
    return out;
  }
  out.samples = out.queries = *count;
  return out;
}

std::vector<Item> sampled_obstacles(const Checker& checker, const WorldState& state,
                                    const MovingRobot& robot, const std::vector<Item>& things,
                                    const MotionOptions& options) {
  const std::vector<MovingRobot> robots{robot};
  const auto thing_of = [&](const std::array<Item, 2>& pair) {
    return is_moved_by(robot.robot, pair[0], state) ? pair[1] : pair[0];
  };
  std::vector<std::array<Item, 2>> pairs = moving_pairs(checker, state, robots);
  std::erase_if(pairs, [&](const std::array<Item, 2>& pair) {
    const Item thing = thing_of(pair);
    return is_moved_by(robot.robot, thing, state) ||
           std::ranges::find(things, thing) == things.end();
  });
  std::vector<Item> found;
  Samples samples(checker, state, robots, options);
  const auto count =
      samples.visit([&](const WorldState& now, std::size_t /*segment*/, double /*share*/) {
        const std::size_t before = found.size();
        for (const std::size_t k : checker.substitute()->find_meeting(now, pairs, true))
          if (const Item thing = thing_of(pairs[k]); std::ranges::find(found, thing) == found.end())
            found.push_back(thing);
        if (found.size() > before)
          std::erase_if(pairs, [&](const std::array<Item, 2>& pair) {
            return std::ranges::find(found, thing_of(pair)) != found.end();
          });
        return pairs.empty();
      });
  if (!count) found = things;  // of what was not looked at nothing is said to be free
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace kaboum::world::detail
