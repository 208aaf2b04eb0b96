// Questions for paths: whether their ends are free, and what is accepted as an answer.

#include "path_query.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>

#include "shorten.h"

namespace kaboum::motion {
namespace {

using Certain = world::MotionAnswer::Outcome;

}  // namespace

bool PathQuery::look_at_start() {
  if (const auto outside = find_out_of_limits(space_.kinematics(), start_)) {
    answer_.variable = *outside;
    end(Outcome::StartOutsideLimits);
    return false;
  }
  answer_.contact = space_.find_contact(start_);
  if (answer_.contact) {
    end(Outcome::StartInContact);
    return false;
  }
  answer_.broken = space_.find_broken({start_});
  if (answer_.broken) end(Outcome::StartBreaksConstraint);
  return !answer_.broken;
}

bool PathQuery::look_at_goals() {
  std::optional<std::uint32_t> variable;
  std::optional<world::Contact> contact;
  std::optional<ConstraintAnswer> broken;
  for (std::size_t g = 0; g < goals_.size(); ++g) {
    if (const auto outside = find_out_of_limits(space_.kinematics(), goals_[g])) {
      if (!variable) variable = outside;
    } else if (auto met = space_.find_contact(goals_[g])) {
      if (!contact) contact = std::move(met);
    } else if (auto not_kept = space_.find_broken({goals_[g]})) {
      // One that is not certain is told of: then nothing is known of all.
      if (!broken || not_kept->outcome == ConstraintAnswer::Outcome::Undecided)
        broken = std::move(not_kept);
    } else {
      order_.push_back(g);
    }
  }
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return space_.distance(start_, goals_[a]) < space_.distance(start_, goals_[b]);
  });
  if (!order_.empty()) return true;
  if (broken) {
    answer_.broken = std::move(broken);
    end(Outcome::GoalBreaksConstraint);
  } else if (contact) {
    answer_.contact = std::move(contact);
    end(Outcome::GoalInContact);
  } else {
    answer_.variable = *variable;
    end(Outcome::GoalOutsideLimits);
  }
  return false;
}

bool PathQuery::accept(const robot::Path& path, std::size_t goal) {
  // Whatever made it: a roadmap's file may state any nodes.
  if (std::ranges::any_of(path, [&](const Values& q) {
        return find_out_of_limits(space_.kinematics(), q).has_value();
      }))
    return false;
  if (space_.check(path).outcome != Certain::Free || space_.find_broken(path)) return false;
  answer_.deviations = space_.deviations();
  answer_.path = path;
  answer_.goal = goal;
  end(Outcome::Found);
  return true;
}

bool PathQuery::go_straight() {
  for (const std::size_t g : order_) {
    const auto way = space_.way(start_, goals_[g]);
    if (!way) continue;
    robot::Path path{start_};
    path.insert(path.end(), way->begin(), way->end());
    if (path.size() > 2) path = without_detours(path, space_);
    if (!accept(path, g)) continue;
    answer_.straight = path.size() == 2;
    return true;
  }
  return false;
}

PathAnswer PathQuery::take() {
  answer_.blockers = space_.blockers(answer_.outcome == Outcome::Found);
  answer_.spent = space_.spent();
  return std::move(answer_);
}

void require_query(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                   const Values& start, std::span<const Values> goals, const PathOptions& options) {
  if (goals.empty()) throw Error(ErrorCode::InvalidArgument, "a path without a goal");
  if (!(options.most_work > 0) || !(options.most_seconds > 0) || options.most_nodes == 0)
    throw Error(ErrorCode::InvalidArgument, "limits of a search must be above 0");
  if (!(options.check.resolution > 0))
    throw Error(ErrorCode::InvalidArgument, "the resolution of motions must be above 0");
  require_fits(checker, state, robot, start);
  for (const Values& goal : goals) require_fits(checker, state, robot, goal);
  for (const PathConstraint& constraint : options.constraints)
    require_keepable(constraint, checker.world().robots[robot].kinematics);
}

}  // namespace kaboum::motion
