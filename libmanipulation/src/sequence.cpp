// Motions of an action, one after another: what all of them need, reaching and grasping.
#include "sequence.h"

#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <chrono>
#include <numbers>

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Later attempts of a call may work so many times as long as the one before.
constexpr double kMoreWork = 2;
/// Poses no farther apart are the same: ten times what words are rounded to. [m, 1]
constexpr double kSame = 1e-6;
/// Turns that are tried when an object is put down; more with each attempt.
constexpr int kTurns = 8;

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string name_of(const world::World& world, const std::array<world::Item, 2>& items) {
  return world.name_of(items[0]) + " and " + world.name_of(items[1]);
}

}  // namespace

bool fits(const world::ToolFrame& tool, const world::Grasp& grasp) {
  const std::size_t slash = grasp.name.find('/');
  return slash == std::string::npos || grasp.name.substr(0, slash) == tool.name;
}

Sequence::Sequence(const Geometry& geometry, const plan::Question& question,
                   const GeometricState& state)
    : geometry_(geometry),
      question_(question),
      state_(state.world()),
      mounted_(state.mounted()),
      random_(question.seed) {}

bool Sequence::fail(Answer::Kind kind, std::string reason) {
  failed_ = kind;
  reason_ = std::move(reason);
  return false;
}

Answer Sequence::failure() const {
  return {paths_.empty() ? failed_ : Answer::Kind::NotFound, "", "", reason_};
}

Answer Sequence::found(std::string value) const {
  return Answer::found(std::move(value), paths_.dump());
}

Transform Sequence::pose_of_link(std::size_t robot, std::uint32_t link) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  return model.base * forward(model.kinematics, state_.q[robot])[link];
}

Transform Sequence::pose_of_object(std::size_t object) const {
  const auto& held = state_.attachments[object];
  return held ? pose_of_link(held->robot, held->link) * held->pose : state_.poses[object];
}

std::optional<world::Attachment> Sequence::held_by(std::size_t robot, std::size_t object) const {
  const auto& held = state_.attachments[object];
  return held && held->robot == robot ? held : std::nullopt;
}

std::vector<double> Sequence::turns() {
  const double first = question_.attempt == 0 ? 0 : random_.between(0, 2 * std::numbers::pi);
  const int count = kTurns * static_cast<int>(question_.attempt + 1);
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(first + 2 * std::numbers::pi * i / count);
  return out;
}

bool Sequence::is_free(std::size_t robot, const robot::Path& path) const {
  const Stopwatch watch;
  const bool free =
      check_motion(geometry_.checker, state_, robot, path, geometry_.options.path.check).outcome ==
      world::MotionAnswer::Outcome::Free;
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->predicate_calls;
    counters->positive += free ? 0 : 1;
    counters->path_seconds += watch.seconds();
  }
  return free;
}

void Sequence::add_goals(Goals& goals, std::size_t robot, std::uint32_t link,
                         const Transform& target) const {
  const Stopwatch watch;
  manipulation::add_goals(goals, geometry_.world.robots[robot], link, target, state_.q[robot],
                          question_.seed);
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->ik_calls;
    counters->ik_seconds += watch.seconds();
  }
}

bool Sequence::is_free(const world::WorldState& state) const {
  world::Scratch scratch;
  return !geometry_.checker.find_contact(state, scratch);
}

/// What moves, what it holds by which link, and how.
void Sequence::record(std::size_t robot, const robot::Path& path) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  nlohmann::json out = {{"robot", model.name}, {"path", path}};
  for (std::size_t o = 0; o < state_.attachments.size(); ++o)
    if (const auto held = held_by(robot, o))
      out["holds"][geometry_.world.objects[o].name] = model.kinematics.links[held->link].name;
  paths_.push_back(std::move(out));
  state_.q[robot] = path.back();
}

motion::PathAnswer Sequence::look_for_path(const world::WorldState& state, std::size_t robot,
                                           const Goals& goals,
                                           const motion::PathOptions& options) const {
  const Stopwatch watch;
  motion::PathAnswer answer =
      find_path(geometry_.checker, state, robot, state.q[robot], goals.configurations, options);
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->paths;
    counters->predicate_calls += answer.spent.configurations + answer.spent.motions;
    for (const motion::Blocker& blocker : answer.blockers) counters->positive += blocker.times;
    counters->path_seconds += watch.seconds();
  }
  return answer;
}

/// The path there would be if nothing that the domain moves were there, but what this robot holds;
/// empty: none was found. It is the same whenever it is asked for.
const robot::Path& Sequence::usual_path(std::size_t robot, const Goals& goals,
                                        const motion::PathOptions& options) const {
  std::string key;
  const auto add = [&](const void* data, std::size_t size) {
    key.append(static_cast<const char*>(data), size);
  };
  add(&robot, sizeof robot);
  for (const auto& q : state_.q) add(q.data(), q.size() * sizeof(double));
  for (const auto& q : goals.configurations) add(q.data(), q.size() * sizeof(double));
  add(&options.seed, sizeof options.seed);
  add(&options.most_work, sizeof options.most_work);
  world::WorldState bare = state_;
  for (std::size_t o = 0; o < bare.absent.size(); ++o) {
    if (const auto held = held_by(robot, o); held && !bare.absent[o]) {
      add(&o, sizeof o);
      add(&held->link, sizeof held->link);
      add(held->pose.linear.data(), 9 * sizeof(double));
      add(held->pose.translation.data(), 3 * sizeof(double));
    } else if (!geometry_.fixed.contains("pose(" + geometry_.world.objects[o].name + ")")) {
      bare.absent[o] = true;
      bare.attachments[o].reset();
    }
  }
  constexpr std::size_t kMost = 20'000;  // paths that are kept
  if (geometry_.usual_paths.size() >= kMost) geometry_.usual_paths.clear();
  const auto [found, fresh] = geometry_.usual_paths.try_emplace(std::move(key));
  if (fresh) {
    motion::PathAnswer answer = look_for_path(bare, robot, goals, options);
    if (answer.outcome == motion::PathAnswer::Outcome::Found)
      found->second = std::move(answer.path);
  }
  return found->second;
}

bool Sequence::go(std::size_t robot, const std::vector<double>& q) {
  Goals goals;
  goals.configurations = {q};
  return go(robot, goals);
}

bool Sequence::go(std::size_t robot, const Goals& goals) {
  const auto none = [&](bool all, const std::string& reason) {
    return fail(all ? Answer::Kind::Impossible : Answer::Kind::NotFound, reason);
  };
  motion::PathOptions options = geometry_.options.path;
  options.seed = question_.seed;
  for (unsigned i = 0; i < question_.attempt; ++i) options.most_work *= kMoreWork;
  const bool some_end_is_free =
      std::ranges::any_of(goals.configurations, [&](const std::vector<double>& q) {
        world::WorldState there = state_;
        there.q[robot] = q;
        return is_free(there);
      });
  // What does for most states is tried first: deciding a path is much cheaper than finding one.
  if (some_end_is_free)
    if (const robot::Path& usual = usual_path(robot, goals, options);
        !usual.empty() && is_free(robot, usual)) {
      record(robot, usual);
      return true;
    }
  const motion::PathAnswer answer = look_for_path(state_, robot, goals, options);
  using Outcome = motion::PathAnswer::Outcome;
  switch (answer.outcome) {
    case Outcome::Found:
      record(robot, answer.path);
      return true;
    case Outcome::GoalInContact:
      return none(goals.all,
                  "blocked at its end: " + name_of(geometry_.world, answer.contact->items));
    case Outcome::StartInContact:
      return none(true, "the robot cannot start: contact of " +
                            name_of(geometry_.world, answer.contact->items));
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

Goals Sequence::goals_of_reach(std::size_t robot, std::size_t object) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  Goals goals;
  for (const world::Grasp& grasp : geometry_.world.objects[object].grasps)
    for (const world::ToolFrame& tool : model.tools)
      if (fits(tool, grasp))
        add_goals(goals, robot, tool.link,
                  pose_of_object(object) * inverse(grasp.pose) * inverse(tool.pose));
  return goals;
}

bool Sequence::is_in_reach(std::size_t robot, std::size_t object) {
  const world::Object& thing = geometry_.world.objects[object];
  const world::RobotModel& model = geometry_.world.robots[robot];
  if (state_.absent[object]) return fail(Answer::Kind::Impossible, thing.name + " is away");
  if (thing.grasps.empty())
    throw Error(ErrorCode::InvalidInput,
                "object '" + thing.name + "' of the scene has no grasps, which reaching it needs");
  if (model.tools.empty())
    throw Error(ErrorCode::InvalidInput,
                "robot '" + model.name + "' of the scene has no tools, which reaching needs");
  if (held_by(robot, object))
    return fail(Answer::Kind::Impossible, thing.name + " is held already");
  const Goals goals = goals_of_reach(robot, object);
  if (!goals.configurations.empty()) return true;
  return fail(goals.all ? Answer::Kind::Impossible : Answer::Kind::NotFound,
              thing.name + " is out of reach");
}

bool Sequence::reach(std::size_t robot, std::size_t object) {
  if (!is_in_reach(robot, object)) return false;
  if (state_.attachments[object])
    return fail(Answer::Kind::Impossible,
                geometry_.world.objects[object].name + " is held already");
  return go(robot, goals_of_reach(robot, object));
}

/// How a robot holds an object with the tool that is at one of its grasps; nullopt: none is.
std::optional<world::Attachment> Sequence::find_grasp(std::size_t robot, std::size_t object) const {
  if (state_.absent[object] || held_by(robot, object)) return std::nullopt;
  const Transform pose = pose_of_object(object);
  for (const world::ToolFrame& tool : geometry_.world.robots[robot].tools) {
    const Transform link = pose_of_link(robot, tool.link);
    for (const world::Grasp& grasp : geometry_.world.objects[object].grasps) {
      if (!fits(tool, grasp)) continue;
      const kinematics::PoseError error =
          kinematics::difference(link * tool.pose * grasp.pose, pose);
      if (error.position > kSame || error.rotation > kSame) continue;
      world::Attachment held;
      held.robot = robot;
      held.link = tool.link;
      held.pose = inverse(link) * pose;
      // As the word has it, with the fingers that may touch.
      return place_of(manipulation::word_of(geometry_.world, held), geometry_.world, object)
          .attachment;
    }
  }
  return std::nullopt;
}

void Sequence::carry(std::size_t object, const std::optional<world::Attachment>& held,
                     const Transform& pose) {
  for (std::size_t o = 0; o < mounted_.size(); ++o) {
    if (mounted_[o] != object || state_.absent[o]) continue;
    const Transform relative = inverse(pose_of_object(object)) * pose_of_object(o);
    std::optional<world::Attachment> with = held;
    if (with) with->pose = with->pose * relative;
    carry(o, with, pose * relative);
  }
  state_.attachments[object] = held;
  if (!held) state_.poses[object] = pose;
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
    if (error.position <= kSame && error.rotation <= kSame) pose = target_->pose;
  }
  const auto onto = target_ && target_->object == object ? target_->onto : std::nullopt;
  if (!onto) {
    const world::Object& thing = geometry_.world.objects[object];
    const kinematics::PoseError error = kinematics::difference(pose, thing.pose);
    const bool at_start = error.position <= kSame && error.rotation <= kSame;
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

std::string Sequence::word_of_object(std::size_t object) const {
  if (const auto& held = state_.attachments[object])
    return manipulation::word_of(geometry_.world, *held);
  const world::Object& thing = geometry_.world.objects[object];
  const kinematics::PoseError error = kinematics::difference(state_.poses[object], thing.pose);
  return error.position <= kSame && error.rotation <= kSame
             ? std::string(kStart)
             : manipulation::word_of(state_.poses[object]);
}

std::string Sequence::word_of_mounted(std::size_t object) const {
  return manipulation::word_of(geometry_.world, *mounted_[object],
                               inverse(pose_of_object(*mounted_[object])) * pose_of_object(object));
}

}  // namespace kaboum::manipulation
