// Reaching, grasping and letting go.
#include "sequence.h"

#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Turns that are tried when an object is put down; more with each attempt.
constexpr int kTurns = 8;
/// More than sums of lengths lose. [1]
constexpr double kRounding = 1e-9;

/// All of 0 … n − 1 for the choices 1 … n, what is near in the list far apart in time.
std::size_t spread(unsigned choice, std::size_t n) {
  auto step = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(n)));
  while (std::gcd(step, n) != 1) ++step;
  return (choice - 1) * step % n;
}

}  // namespace

std::vector<double> Sequence::turns() {
  const double first = question_.attempt == 0 ? 0 : random_.between(0, 2 * std::numbers::pi);
  const int count = kTurns * static_cast<int>(question_.attempt + 1);
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out.push_back(first + 2 * std::numbers::pi * i / count);
  return out;
}

Goals Sequence::goals_of_reach(std::size_t robot, std::size_t object) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const world::Object& thing = geometry_.world.objects[object];
  Goals goals;
  for (const world::Grasp& grasp : thing.grasps)
    for (const world::ToolFrame& tool : model.tools)
      if (fits(tool, grasp))
        add_goals(goals, robot, tool.link,
                  pose_of_object(object) * inverse(grasp.pose) * inverse(tool.pose));
  const auto fitting = std::ranges::count_if(thing.grasps, [&](const world::Grasp& grasp) {
    return std::ranges::any_of(model.tools,
                               [&](const world::ToolFrame& tool) { return fits(tool, grasp); });
  });
  goals.listed = (fitting == 1 ? "the only grasp" : "the " + std::to_string(fitting) + " grasps") +
                 (" listed for " + thing.name);
  return goals;
}

std::optional<Goals> Sequence::preferred_goals(std::size_t robot, std::size_t object) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const world::Object& thing = geometry_.world.objects[object];
  std::vector<std::pair<const world::Grasp*, const world::ToolFrame*>> all;
  for (const world::Grasp& grasp : thing.grasps)
    for (const world::ToolFrame& tool : model.tools)
      if (fits(tool, grasp)) all.emplace_back(&grasp, &tool);
  if (all.size() < 2) return std::nullopt;
  choices_ = std::max(choices_, static_cast<unsigned>(all.size()));
  if (question_.choice == 0) return std::nullopt;
  const auto [grasp, tool] = all[spread(question_.choice, all.size())];
  Goals goals;
  add_goals(goals, robot, tool->link,
            pose_of_object(object) * inverse(grasp->pose) * inverse(tool->pose));
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
    aside = std::max(aside, (grasp.pose * ball.center).norm() - ball.radius);
  const robot::Robot& robot_of = model.kinematics;
  return std::ranges::all_of(tools, [&](const world::ToolFrame& tool) {
    const kinematics::Arm arm =
        kinematics::arm_of(robot_of, robot_of.links[0].name, robot_of.links[tool.link].name);
    // From one axis to the next nothing but sliding changes how far their points are apart.
    double longest = tool.pose.translation.norm() + aside;
    geom::Vec3 at = geom::Vec3::Zero();
    for (const kinematics::Axis& axis : arm.axes) {
      longest += (axis.point - at).norm();
      at = axis.point;
      if (!axis.turns) longest += axis.rate * std::max(std::abs(axis.lower), std::abs(axis.upper));
    }
    longest += (arm.tool.translation - at).norm();
    return distance > longest * (1 + kRounding);
  });
}

std::string Sequence::name_with_grasp(std::size_t object, const world::Attachment& held) const {
  const world::Object& thing = geometry_.world.objects[object];
  for (const world::ToolFrame& tool : geometry_.world.robots[held.robot].tools)
    for (const world::Grasp& grasp : thing.grasps) {
      if (tool.link != held.link || !fits(tool, grasp)) continue;
      const kinematics::PoseError error = kinematics::difference(tool.pose * grasp.pose, held.pose);
      if (error.position <= kSamePose && error.rotation <= kSamePose)
        return thing.name + ", held by its grasp '" + grasp.name + "',";
    }
  return thing.name;
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
                "robot '" + model.name + "' of the scene has no tools, which reaching needs");
  if (held_by(robot, object))
    return none(Answer::Kind::Impossible, thing.name + " is held already");
  Goals goals = goals_of_reach(robot, object);
  if (!goals.configurations.empty()) return goals;
  if (goals.all) {
    none(Answer::Kind::Impossible,
         thing.name + " is out of reach: " + goals.none() + " can be reached by " + model.name);
    listed_ = !is_beyond_reach(robot, object);
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
  carry(object, held, {});
  return true;
}

void Sequence::let_go(std::size_t robot, std::size_t object) {
  const auto held = held_by(robot, object);
  ensure(held.has_value(), "what is let go is held");
  Transform pose = pose_of_link(robot, held->link) * held->pose;
  // Where it was meant to be: that does not depend on the configuration that brought it there.
  if (target_ && target_->object == object) {
    const kinematics::PoseError error = kinematics::difference(pose, target_->pose);
    if (error.position <= kSamePose && error.rotation <= kSamePose) pose = target_->pose;
  }
  const auto onto = target_ && target_->object == object ? target_->onto : std::nullopt;
  if (!onto) {
    const world::Object& thing = geometry_.world.objects[object];
    const kinematics::PoseError error = kinematics::difference(pose, thing.pose);
    const bool at_start = error.position <= kSamePose && error.rotation <= kSamePose;
    carry(object, std::nullopt,
          at_start ? thing.pose
                   : place_of(manipulation::word_of(pose), geometry_.world, object).pose);
    return;
  }
  mounted_[object] = onto;
  const Transform relative = inverse(pose_of_object(*onto)) * pose;
  std::optional<world::Attachment> with = state_.attachments[*onto];
  if (with) with->pose = with->pose * relative;
  carry(object, with, pose);
}

}  // namespace kaboum::manipulation
