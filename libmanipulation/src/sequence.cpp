// Reaching, grasping and letting go.
#include "sequence.h"

#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Turns that are tried when an object is put down; more with each attempt.
constexpr int kTurns = 8;
/// Members of a family of grasps that are drawn; with each attempt twice as many.
constexpr std::size_t kDraws = 16;
constexpr unsigned kMostDoublings = 3;
static_assert(kDraws << kMostDoublings == world::kMostMembers);
/// More than sums of lengths lose. [1]
constexpr double kRounding = 1e-9;

}  // namespace

std::vector<double> Sequence::turns() {
  const double first = question_.attempt == 0 ? 0 : random_.between(0, 2 * std::numbers::pi);
  const int count = kTurns * static_cast<int>(question_.attempt + 1);
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out.push_back(first + 2 * std::numbers::pi * i / count);
  return out;
}

std::vector<Sequence::Hold> Sequence::holds(std::size_t robot, std::size_t object,
                                            std::size_t draws) const {
  std::vector<Hold> out;
  for (const world::Grasp& grasp : geometry_.world.objects[object].grasps)
    for (const world::ToolFrame& tool : geometry_.world.robots[robot].tools) {
      if (!fits(tool, grasp)) continue;
      const std::size_t members = is_family(grasp) ? draws : 1;
      for (std::size_t i = 0; i < members; ++i)
        out.push_back({&grasp, &tool, drawn_member(grasp, i)});
    }
  return out;
}

void Sequence::add_goals_of(Goals& goals, std::size_t robot, std::size_t object, const Hold& hold,
                            bool any) const {
  add_goals(goals, robot, hold.tool->link,
            pose_of_object(object) * inverse(hold.pose) * inverse(hold.tool->pose), any);
  if (is_family(*hold.grasp)) goals.all = false;
}

std::size_t Sequence::draws() const {
  return kDraws << std::min(question_.attempt, kMostDoublings);
}

Goals Sequence::goals_of_reach(std::size_t robot, std::size_t object,
                               std::optional<unsigned> rank) const {
  Goals goals;
  std::set<const world::Grasp*> fitting;
  bool family = false;
  for (const Hold& hold : holds(robot, object, draws())) {
    if (rank && hold.grasp->rank != *rank) continue;
    fitting.insert(hold.grasp);
    family = family || is_family(*hold.grasp);
    add_goals_of(goals, robot, object, hold);
  }
  const std::string& name = geometry_.world.objects[object].name;
  goals.listed =
      (fitting.size() == 1 ? "the only grasp"
                           : "the " + std::to_string(fitting.size()) + " grasps") +
      (" listed for " + name) +
      (family ? ", of families " + std::to_string(draws()) + " members each," : std::string());
  return goals;
}

std::optional<Goals> Sequence::preferred_goals(std::size_t robot, std::size_t object) {
  const std::vector<Hold> all = holds(robot, object, kChoices);
  if (all.size() < 2) return std::nullopt;
  choices_ = std::max(choices_, static_cast<unsigned>(all.size()));
  if (question_.choice == 0) return std::nullopt;
  Goals goals;
  add_goals_of(goals, robot, object, all[spread(question_.choice, all.size())]);
  goals.all = false;  // there are other grasps
  if (goals.configurations.empty()) return std::nullopt;
  return goals;
}

bool Sequence::is_beyond_reach(std::size_t robot, std::size_t object) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const world::Object& thing = geometry_.world.objects[object];
  const auto& ball = thing.outer.ball();
  const double distance =
      (inverse(model.base) * (pose_of_object(object) * ball.center)).norm() - ball.radius;
  double aside =
      0;  // how far from the ball tools may be, as they are at the grasps that are listed
  std::vector<world::ToolFrame> tools;
  for (const world::ToolFrame& tool : model.tools)
    if (std::ranges::any_of(thing.grasps,
                            [&](const world::Grasp& grasp) { return fits(tool, grasp); }))
      tools.push_back(tool);
  if (tools.empty()) return false;
  for (const world::Grasp& grasp : thing.grasps)
    aside = std::max(aside, farthest_from(grasp, ball.center) - ball.radius);
  return std::ranges::all_of(tools, [&](const world::ToolFrame& tool) {
    const double longest = longest_reach(model, tool.link, tool.pose.translation);
    return distance > (longest + aside) * (1 + kRounding);
  });
}

std::string Sequence::name_with_grasp(std::size_t object, const world::Attachment& held) const {
  const world::Object& thing = geometry_.world.objects[object];
  for (const world::ToolFrame& tool : geometry_.world.robots[held.robot].tools)
    for (const world::Grasp& grasp : thing.grasps) {
      if (tool.link != held.link || !fits(tool, grasp)) continue;
      if (is_at(tool.pose, grasp, held.pose))
        return thing.name + ", held by its grasp '" + grasp.name + "',";
    }
  return thing.name;
}

bool Sequence::reaches_any(std::size_t robot, std::size_t object) const {
  if (state_.absent[object] || held_by(robot, object)) return false;
  return std::ranges::any_of(holds(robot, object, draws()), [&](const Hold& hold) {
    Goals goals;
    add_goals_of(goals, robot, object, hold, true);
    return !goals.configurations.empty();
  });
}

std::optional<Goals> Sequence::goals_in_reach(std::size_t robot, std::size_t object) {
  const auto none = [&](Answer::Kind kind, const std::string& reason) {
    fail(kind, reason);
    return std::nullopt;
  };
  const world::Object& thing = geometry_.world.objects[object];
  const world::RobotModel& model = geometry_.world.robots[robot];
  if (state_.absent[object]) return none(Answer::Kind::Impossible, thing.name + " is away");
  if (thing.grasps.empty())
    throw Error(ErrorCode::InvalidInput,
                "object '" + thing.name + "' of the scene has no grasps, which reaching it needs");
  if (model.tools.empty())
    throw Error(ErrorCode::InvalidInput,
                "robot '" + model.name +
                    "' of the scene has no tools, which reaching needs; the scene "
                    "states them as " +
                    std::string(world::kToolExample));
  if (held_by(robot, object))
    return none(Answer::Kind::Impossible, thing.name + " is held already");
  Goals goals = goals_of_reach(robot, object);
  if (!goals.configurations.empty()) return goals;
  const bool beyond = is_beyond_reach(robot, object);
  if (goals.all || beyond) {
    none(Answer::Kind::Impossible,
         thing.name + " is out of reach: " + goals.none() + " can be reached by " + model.name);
    listed_ = !beyond;
    return std::nullopt;
  }
  return none(Answer::Kind::NotFound,
              thing.name + " was not found to be in reach: nothing was found for " + goals.listed);
}

bool Sequence::reach(std::size_t robot, std::size_t object) {
  const auto goals = goals_in_reach(robot, object);
  if (!goals) return false;
  if (state_.attachments[object])
    return fail(Answer::Kind::Impossible,
                geometry_.world.objects[object].name + " is held already");
  const auto preferred = preferred_goals(robot, object);
  if (preferred && go(robot, *preferred)) return true;
  std::set<unsigned> ranks;
  for (const Hold& hold : holds(robot, object, 1)) ranks.insert(hold.grasp->rank);
  if (ranks.size() > 1)
    for (const unsigned rank : ranks) {
      Goals best = goals_of_reach(robot, object, rank);
      best.all = false;  // there are other ranks
      if (!best.configurations.empty() && go(robot, best)) return true;
    }
  return go(robot, *goals);
}

bool Sequence::take(std::size_t robot, std::size_t object) {
  const auto held = find_grasp(robot, object);
  if (!held)
    return fail(Answer::Kind::Impossible,
                "no tool of " + geometry_.world.robots[robot].name + " is at a grasp of " +
                    geometry_.world.objects[object].name + ", or it does not rest");
  if (mounted_[object])
    return fail(Answer::Kind::Impossible, geometry_.world.objects[object].name + " is mounted on " +
                                              geometry_.world.objects[*mounted_[object]].name);
  if (held->link_touches) {
    carry(object, held, {});
    return true;
  }
  const world::RobotModel& model = geometry_.world.robots[robot];
  const world::Gripper* gripper = world::gripper_with_pads(model, held->link);
  for (std::size_t o = 0; o < state_.attachments.size(); ++o)
    if (const auto other = held_by(robot, o);
        other && !other->link_touches && !state_.absent[o] && !mounted_[o] &&
        world::gripper_with_pads(model, other->link) == gripper)
      return fail(Answer::Kind::Impossible, "the gripper holds " + geometry_.world.objects[o].name);
  if (!is_free_of(robot, object, "before it closes on")) return false;
  const world::WorldState before = state_;
  carry(object, held, {});
  if (move_fingers(robot, object, Motion::Fingers::Close)) return true;
  state_ = before;
  return false;
}

bool Sequence::let_go(std::size_t robot, std::size_t object) {
  const auto held = held_by(robot, object);
  ensure(held.has_value(), "what is let go is held");
  if (!held->fingers.empty() && !move_fingers(robot, object, Motion::Fingers::Open)) return false;
  Transform pose = pose_of_link(robot, held->link) * held->pose;
  // Where it was meant to be: that does not depend on the configuration that brought it there.
  if (target_ && target_->object == object) {
    const kinematics::PoseError error = kinematics::difference(pose, target_->pose);
    if (error.position <= kSamePose && error.rotation <= kSamePose) pose = target_->pose;
  }
  const auto onto = target_ && target_->object == object ? target_->onto : std::nullopt;
  // Pads that may touch what they hold may not touch it any more.
  const auto is_let_go = [&] {
    return held->link_touches || is_free_of(robot, object, "when it has opened from");
  };
  if (!onto) {
    const world::Object& thing = geometry_.world.objects[object];
    const kinematics::PoseError error = kinematics::difference(pose, thing.pose);
    const bool at_start = error.position <= kSamePose && error.rotation <= kSamePose;
    carry(object, std::nullopt,
          at_start ? thing.pose
                   : place_of(manipulation::word_of(pose), geometry_.world, object).pose);
    return is_let_go();
  }
  mounted_[object] = onto;
  const Transform relative = inverse(pose_of_object(*onto)) * pose;
  std::optional<world::Attachment> with = state_.attachments[*onto];
  if (with) with = carried_along(*with, relative);
  carry(object, with, pose);
  return is_let_go();
}

}  // namespace kaboum::manipulation
