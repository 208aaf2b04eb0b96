// Paths of a sequence of motions: the way back, straight, along the tool, and by random trees
// (docs/planning/geometry.md).
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "along_tool.h"
#include "motion_sequence.h"
#include "stopwatch.h"

namespace kaboum::manipulation {
namespace {

using plan::Answer;

/// Later attempts of a call may work so many times as long as the one before.
constexpr double kMoreWork = 2;
/// Goals that straight paths and those along the tool are tried for.
constexpr std::size_t kNear = 4;

bool is_certain(const motion::ConstraintAnswer& broken) {
  return broken.outcome == motion::ConstraintAnswer::Outcome::Broken;
}

std::string name_of(const world::World& world, const std::array<world::Item, 2>& items) {
  return world.name_of(items[0]) + " and " + world.name_of(items[1]);
}

}  // namespace

/// The goals that are free, of the nearest ones: the farthest that a joint has to go decides.
std::vector<std::vector<double>> MotionSequence::nearest_free(
    const world::WorldState& state, std::size_t robot,
    const std::vector<std::vector<double>>& goals) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < goals.size(); ++g) {
    double most = 0;
    for (std::size_t i = 0; i < goals[g].size(); ++i)
      most = std::max(most, std::abs(goals[g][i] - state.q[robot][i]));
    order.emplace_back(most, g);
  }
  std::ranges::sort(order);
  std::vector<std::vector<double>> out;
  world::WorldState there = state;
  for (const auto& [distance, g] : order) {
    there.q[robot] = goals[g];
    if (!find_out_of_limits(geometry_.world.robots[robot].kinematics, goals[g]) && is_free(there))
      out.push_back(goals[g]);
    if (out.size() == kNear) break;
  }
  return out;
}

motion::PathAnswer MotionSequence::look_for_path(const world::WorldState& state, std::size_t robot,
                                                 const Goals& goals,
                                                 const motion::PathOptions& options) const {
  const Stopwatch watch;
  const std::vector<double>& start = state.q[robot];
  std::size_t looked_at = 0;
  const auto count = [&](motion::PathAnswer answer) {
    looked_at += answer.spent.configurations + answer.spent.motions;
    return answer;
  };
  // Straight, or along the tool, to one of the nearest; then anyhow to any.
  motion::PathOptions straight = options;
  straight.most_work = std::min(kNoWork, options.most_work);
  const auto near = nearest_free(state, robot, goals.configurations);
  motion::PathAnswer answer;
  if (!near.empty()) {
    answer = count(find_path(geometry_.checker, state, robot, start, near, straight));
    if (answer.outcome == motion::PathAnswer::Outcome::WorkEnded)
      answer = count(find_path_along_tool(geometry_.checker, state, robot, start, near, options));
  }
  // Lines along the tool were not asked whether they keep anything.
  if (answer.outcome == motion::PathAnswer::Outcome::Found &&
      motion::check_constraints(geometry_.world.robots[robot], answer.path, options.constraints)
              .outcome != motion::ConstraintAnswer::Outcome::Kept)
    answer = {};
  if (answer.outcome != motion::PathAnswer::Outcome::Found)
    answer =
        count(find_path(geometry_.checker, state, robot, start, goals.configurations, options));
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->paths;
    counters->predicate_calls += looked_at;
    for (const motion::Blocker& blocker : answer.blockers) counters->positive += blocker.times;
    counters->path_seconds += watch.seconds();
  }
  return answer;
}

bool MotionSequence::go(std::size_t robot, const std::vector<double>& to) {
  const std::vector<double> q = with_fingers(robot, to);
  // Back where it came from the same way, if that is free as things are now.
  robot::Path back(last_paths_[robot].rbegin(), last_paths_[robot].rend());
  for (std::vector<double>& at : back) at = with_fingers(robot, std::move(at));
  if (back.size() > 1 && back.back() == q && back.front() == state_.q[robot]) {
    if (may_follow(robot, back)) {
      record(robot, back);
      return true;
    }
  }
  Goals goals;
  goals.configurations = {q};
  return go(robot, goals);
}

bool MotionSequence::go(std::size_t robot, const Goals& goals,
                        std::vector<motion::PathConstraint> kept) {
  const auto none = [&](bool all, const std::string& reason) {
    return fail(all ? Answer::Kind::Impossible : Answer::Kind::NotFound, reason);
  };
  motion::PathOptions options = geometry_.options.path;
  options.check = check_of(geometry_, robot, state_.attachments);
  for (const world::Gripper& gripper : geometry_.world.robots[robot].grippers)
    options.still.insert(options.still.end(), gripper.joints.begin(), gripper.joints.end());
  options.constraints = motion::carried_constraints(geometry_.world, state_, robot);
  std::ranges::move(kept, std::back_inserter(options.constraints));
  options.seed = question_.seed;
  for (unsigned i = 0; i < question_.attempt; ++i) options.most_work *= kMoreWork;
  const motion::PathAnswer answer = look_for_path(state_, robot, goals, options);
  using Outcome = motion::PathAnswer::Outcome;
  switch (answer.outcome) {
    case Outcome::Found:
      record(robot, answer.path);
      chosen_ = chosen_ || goals.configurations.size() > 1 || !goals.all || !goals.alone;
      return true;
    case Outcome::GoalInContact:
    case Outcome::GoalBreaksConstraint: {
      const bool meets = answer.outcome == Outcome::GoalInContact;
      const bool all = goals.all && goals.alone && (meets || is_certain(*answer.broken));
      std::string where = meets ? "blocked at its end" : "not upright at its end";
      if (!goals.listed.empty())
        where = (all ? goals.none() : "no configuration that was tried for " + goals.listed) +
                (meets ? " is free of contact" : " keeps it upright");
      none(all, where + ": " +
                    (meets ? name_of(geometry_.world, answer.contact->items)
                           : describe(*answer.broken, options.constraints)));
      listed_ = !goals.listed.empty();
      return false;
    }
    case Outcome::StartInContact:
      return none(true, "the robot cannot start: contact of " +
                            name_of(geometry_.world, answer.contact->items));
    case Outcome::StartBreaksConstraint:
      return none(is_certain(*answer.broken),
                  "the robot cannot start: " + describe(*answer.broken, options.constraints));
    case Outcome::StartOutsideLimits:
    case Outcome::GoalOutsideLimits:
      return none(true, "outside the limits of a joint");
    case Outcome::WorkEnded:
    case Outcome::NodesEnded:
    case Outcome::TimeEnded:
      break;
  }
  std::string reason = "no path was found";
  if (!answer.blockers.empty())
    reason += "; in the way: " + name_of(geometry_.world, answer.blockers.front().items);
  return none(false, reason);
}

}  // namespace kaboum::manipulation
