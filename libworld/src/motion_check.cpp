// Motions that are free at every instant: time is halved until bodies move less than they are
// apart.

#include <kaboum/base/error.h>
#include <kaboum/world/motion_check.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "moving_pairs.h"
#include "sampled_motion.h"

namespace kaboum::world {
namespace {

using detail::MovingPairs;
using Outcome = MotionAnswer::Outcome;

constexpr std::size_t kToldEvery = 64;  // intervals

std::vector<std::size_t> all_of(const MovingPairs& pairs) {
  std::vector<std::size_t> all(pairs.pairs().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

class Motion {
 public:
  Motion(const Checker& checker, const WorldState& state,
         const std::vector<detail::MovingRobot>& robots, const MotionOptions& options)
      : world_(checker.world()),
        waypoints_(robots.front().path->size()),
        options_(options),
        moving_(checker, state, robots, options.scratch) {}

  MotionAnswer run() {
    for (std::size_t i = 0; i == 0 || i + 1 < waypoints_; ++i) {
      segment_ = i;
      moving_.prepare(i);
      if (!is_free(0, 1, all_of(moving_))) break;
    }
    // What was merely near at some middle may be found free in its parts.
    if (answer_.outcome != Outcome::Contact && !answer_.meets) answer_.contact.reset();
    return answer_;
  }

 private:
  [[nodiscard]] std::optional<collide::BodyPair> ask(std::size_t k, double slack) {
    ++answer_.queries;
    return moving_.ask(k, slack);
  }

  void tell() const {
    if (!options_.progress || answer_.intervals % kToldEvery != 1) return;
    options_.progress("segment " + std::to_string(segment_ + 1) + " of " +
                      std::to_string(std::max<std::size_t>(waypoints_, 2) - 1) + ", " +
                      std::to_string(answer_.intervals) + " intervals");
  }

  /// Whether these pairs are apart from `begin` to `end`; else the answer is written.
  bool is_free(double begin, double end, const std::vector<std::size_t>& pairs) {
    if (pairs.empty()) return true;
    if (++answer_.intervals > options_.most_intervals) {
      answer_.outcome = Outcome::Undecided;
      answer_.segment = segment_;
      answer_.share = begin;
      return false;
    }
    tell();
    const double middle = 0.5 * begin + 0.5 * end;
    const double half = std::max(middle - begin, end - middle) * kUp;
    moving_.place(middle, pairs);
    // The last stretch: doubles hold no instant between its ends.
    const bool last = !(begin < middle && middle < end);
    std::vector<std::size_t> near;
    double farthest = 0;
    bool contact = false;
    for (const std::size_t k : pairs) {
      const double slack = moving_.pairs()[k].speed * half * kUp;
      const auto bodies = ask(k, slack);
      if (!bodies) continue;
      near.push_back(k);
      farthest = std::max(farthest, slack);
      if (contact) continue;
      const auto meeting = slack > 0 ? ask(k, 0) : bodies;
      if (meeting && !options_.where) {
        note(k, *meeting, middle, true);
        answer_.outcome = Outcome::Contact;
        answer_.segment = segment_;
        return false;
      }
      if ((!meeting && !last && farthest > options_.resolution)) continue;
      contact = meeting.has_value();
      note(k, meeting ? *meeting : *bodies, middle, contact);
    }
    if (near.empty()) return true;
    if (farthest <= options_.resolution || last) {
      answer_.outcome = Outcome::Contact;
      answer_.segment = segment_;
      answer_.share = begin;
      return false;
    }
    return is_free(begin, middle, near) && is_free(middle, end, near);
  }

  /// Keeps the earliest contact; one that meets rather than one that is merely near.
  void note(std::size_t k, const collide::BodyPair& bodies, double at, bool meets) {
    if (answer_.contact && answer_.meets && !meets) return;
    const MovingPairs::Pair& pair = moving_.pairs()[k];
    answer_.contact = contact_of(world_, moving_.mover(pair), moving_.other(pair), moving_.first(k),
                                 moving_.second(k), bodies, pair.margin);
    answer_.meets = meets;
    answer_.contact_segment = segment_;
    answer_.contact_share = at;
  }

  const World& world_;
  std::size_t waypoints_;
  const MotionOptions& options_;
  MovingPairs moving_;
  std::size_t segment_ = 0;
  MotionAnswer answer_;
};

/// Which things that rest are in the way of a path; each pair is decided by itself.
class Obstacles {
 public:
  Obstacles(const Checker& checker, const WorldState& state, std::size_t robot,
            const robot::Path& path, const std::vector<Item>& things, const MotionOptions& options)
      : path_(path),
        options_(options),
        moving_(checker, state, {{robot, &path, &options.around}}, options.scratch, &things),
        intervals_(moving_.pairs().size()) {}

  std::vector<Item> run() {
    for (std::size_t i = 0; i == 0 || i + 1 < path_.size(); ++i) {
      moving_.prepare(i);
      look(0, 1, all_of(moving_));
    }
    std::sort(found_.begin(), found_.end());
    return std::move(found_);
  }

 private:
  void look(double begin, double end, const std::vector<std::size_t>& pairs) {
    const double middle = 0.5 * begin + 0.5 * end;
    const double half = std::max(middle - begin, end - middle) * kUp;
    moving_.place(middle, pairs);
    const bool last = !(begin < middle && middle < end);
    std::vector<std::size_t> near;
    for (const std::size_t k : pairs) {
      const MovingPairs::Pair& pair = moving_.pairs()[k];
      const Item& thing = moving_.other(pair);
      if (std::ranges::find(found_, thing) != found_.end()) continue;
      const double slack = pair.speed * half * kUp;
      if (!moving_.ask(k, slack)) continue;
      if (slack <= options_.resolution || last || ++intervals_[k] > options_.most_intervals ||
          moving_.ask(k, 0))
        found_.push_back(thing);
      else
        near.push_back(k);
    }
    if (near.empty()) return;
    look(begin, middle, near);
    look(middle, end, near);
  }

  const robot::Path& path_;
  const MotionOptions& options_;
  MovingPairs moving_;
  std::vector<std::size_t> intervals_;  ///< in which a pair was near
  std::vector<Item> found_;
};

}  // namespace

std::pair<std::vector<double>, std::vector<double>> outward(std::span<const double> from,
                                                            std::span<const double> to,
                                                            std::span<const double> around) {
  std::vector<double> base(from.begin(), from.end()), out;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (std::abs(to[i]) > std::abs(from[i])) base[i] = to[i];
    // What is lost in the sum is less than 2^-52 of it.
    const double grown = around[i] > 0 ? around[i] * kUp + 0x1p-51 * std::abs(base[i]) : 0;
    out.push_back(base[i] < 0 ? base[i] - grown : base[i] + grown);
  }
  return {std::move(base), std::move(out)};
}

void detail::require_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                            const robot::Path& path, const MotionOptions& options) {
  if (robot >= checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "no such robot");
  if (state.q.size() != checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "a state of another world");
  if (!(options.resolution > 0))
    throw Error(ErrorCode::InvalidArgument, "a resolution must be above 0");
  if (path.empty()) throw Error(ErrorCode::InvalidArgument, "a path without waypoints");
  if (!options.around.empty() &&
      (options.around.size() != checker.world().robots[robot].kinematics.variables.size() ||
       !std::ranges::all_of(options.around, [](double x) { return x >= 0 && x <= 1e9; })))
    throw Error(ErrorCode::InvalidArgument,
                "how far each variable may be from its line is a number from 0 to 1e9");
  for (const std::vector<double>& q : path) {
    if (q.size() != checker.world().robots[robot].kinematics.variables.size())
      throw Error(ErrorCode::InvalidArgument, "a waypoint of another robot");
    if (!std::all_of(q.begin(), q.end(), [](double x) { return std::abs(x) <= 1e9; }))
      throw Error(ErrorCode::InvalidArgument,
                  "a waypoint with a value that is not from -1e9 to 1e9");
  }
}

MotionAnswer check_motion(const Checker& checker, const WorldState& state, std::size_t robot,
                          const robot::Path& path, const MotionOptions& options) {
  detail::require_motion(checker, state, robot, path, options);
  if (Observer* observer = checker.observer()) observer->asked(state, robot, path, nullptr);
  if (checker.substitute() != nullptr)
    return detail::sampled_motion(checker, state, {{robot, &path}}, options);
  return Motion(checker, state, {{robot, &path, &options.around}}, options).run();
}

MotionAnswer check_motions(const Checker& checker, const WorldState& state,
                           const std::vector<RobotPath>& paths, const MotionOptions& options) {
  if (paths.empty()) throw Error(ErrorCode::InvalidArgument, "a motion of no robot");
  std::vector<detail::MovingRobot> robots;
  MotionOptions own = options;
  for (const RobotPath& p : paths) {
    own.around = p.around;
    detail::require_motion(checker, state, p.robot, p.path, own);
    const std::string& name = checker.world().robots[p.robot].name;
    if (std::ranges::find(robots, p.robot, &detail::MovingRobot::robot) != robots.end())
      throw Error(ErrorCode::InvalidArgument, "robot '" + name + "' has two paths");
    if (p.path.size() != paths.front().path.size())
      throw Error(ErrorCode::InvalidArgument,
                  "robots that move at once need equally many waypoints: '" + name + "' has " +
                      std::to_string(p.path.size()) + ", '" +
                      checker.world().robots[paths.front().robot].name + "' has " +
                      std::to_string(paths.front().path.size()));
    robots.push_back({p.robot, &p.path, &p.around});
  }
  if (Observer* observer = checker.observer())
    for (const RobotPath& p : paths) observer->asked(state, p.robot, p.path, nullptr);
  if (checker.substitute() != nullptr)
    return detail::sampled_motion(checker, state, robots, options);
  return Motion(checker, state, robots, options).run();
}

std::vector<Item> find_obstacles(const Checker& checker, const WorldState& state, std::size_t robot,
                                 const robot::Path& path, const std::vector<Item>& things,
                                 const MotionOptions& options) {
  detail::require_motion(checker, state, robot, path, options);
  if (Observer* observer = checker.observer()) observer->asked(state, robot, path, &things);
  if (checker.substitute() != nullptr)
    return detail::sampled_obstacles(checker, state, {robot, &path}, things, options);
  return Obstacles(checker, state, robot, path, things, options).run();
}

}  // namespace kaboum::world
