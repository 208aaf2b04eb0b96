// Motions one after another: paths in the state that the ones before have led to, and what is
// carried.
#include "motion_sequence.h"

#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/gripper.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "stopwatch.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Of the range of each joint of a gripper but the first, at most: these are looked at one by one.
constexpr std::size_t kMostCells = 16;
/// Lines of such a covering at most: of hands with many joints there are fewer cells.
constexpr std::size_t kMostLines = 4096;

/// Has a motion of several variables covered: lines along the first of them, one for each cell of
/// the others' values. @param cells  of each of the others
void cover_values(Motion& motion, std::size_t cells) {
  const std::vector<double>&from = motion.path.front(), &to = motion.path.back();
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] != to[i]) moved.push_back(i);
  motion.covering.clear();
  motion.beside.clear();
  if (moved.size() < 2) return;
  motion.beside.assign(from.size(), 0);
  std::size_t lines = 1;
  for (std::size_t k = 1; k < moved.size(); ++k) {
    const std::size_t i = moved[k];
    // A little more than half a cell: middles are rounded.
    motion.beside[i] =
        (1 + 1e-9) * std::abs(to[i] - from[i]) / (2 * static_cast<double>(cells)) + 1e-12;
    lines *= cells;
  }
  std::vector<double> q = from;
  for (std::size_t line = 0; line < lines; ++line) {
    std::size_t rest = line;
    for (std::size_t k = 1; k < moved.size(); ++k, rest /= cells) {
      const std::size_t i = moved[k];
      const double share = (static_cast<double>(rest % cells) + 0.5) / static_cast<double>(cells);
      q[i] = from[i] + share * (to[i] - from[i]);
    }
    for (const double end : {from[moved[0]], to[moved[0]]}) {
      q[moved[0]] = end;
      motion.covering.push_back(q);
    }
  }
}

}  // namespace

bool is_at(const world::Transform& tool, const world::Grasp& grasp,
           const world::Transform& object) {
  const Transform member = world::nearest_member(grasp, inverse(tool) * object);
  const kinematics::PoseError error = kinematics::difference(tool * member, object);
  return error.position <= kSamePose && error.rotation <= kSamePose;
}

MotionSequence::MotionSequence(const Geometry& geometry, const plan::Question& question,
                               world::WorldState state,
                               std::vector<std::optional<std::size_t>> mounted)
    : geometry_(geometry),
      question_(question),
      state_(std::move(state)),
      mounted_(std::move(mounted)),
      random_(question.seed),
      last_paths_(geometry.world.robots.size()) {}

bool MotionSequence::fail(Answer::Kind kind, std::string reason) {
  failed_ = kind;
  reason_ = std::move(reason);
  listed_ = false;
  return false;
}

Answer MotionSequence::failure() const {
  Answer out{motions_.empty() ? failed_ : Answer::Kind::NotFound, "", "", reason_};
  out.choices = choices_;
  out.listed = listed_ && out.kind == Answer::Kind::Impossible;
  return out;
}

Answer MotionSequence::found(std::string value) const {
  nlohmann::json paths = nlohmann::json::array();
  for (const Motion& motion : motions_) {
    const world::RobotModel& model = geometry_.world.robots[motion.robot];
    nlohmann::json& path = paths.emplace_back();
    path = {{"robot", model.name}, {"path", motion.path}};
    for (const auto& [object, held] : motion.holds) {
      const std::string& name = geometry_.world.objects[object].name;
      path["holds"][name] = model.kinematics.links[held.link].name;
      if (!held.link_touches && !held.grasp.empty()) path["grasps"][name] = held.grasp;
    }
    if (motion.fingers != Motion::Fingers::Still)
      path[motion.fingers == Motion::Fingers::Close ? "closes" : "opens"] =
          geometry_.world.objects[motion.object].name;
  }
  Answer out = Answer::found(std::move(value), paths.dump());
  out.chosen = chosen_;
  out.choices = choices_;
  return out;
}

Transform MotionSequence::pose_of_link(std::size_t robot, std::uint32_t link) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  return model.base * forward(model.kinematics, state_.q[robot])[link];
}

Transform MotionSequence::pose_of_object(std::size_t object) const {
  const auto& held = state_.attachments[object];
  return held ? pose_of_link(held->robot, held->link) * held->pose : state_.poses[object];
}

std::optional<world::Attachment> MotionSequence::held_by(std::size_t robot,
                                                         std::size_t object) const {
  const auto& held = state_.attachments[object];
  return held && held->robot == robot ? held : std::nullopt;
}

bool MotionSequence::may_follow(std::size_t robot, const robot::Path& path) const {
  const auto kept = motion::carried_constraints(geometry_.world, state_, robot);
  if (motion::check_constraints(geometry_.world.robots[robot], path, kept).outcome !=
      motion::ConstraintAnswer::Outcome::Kept)
    return false;
  const Stopwatch watch;
  const bool free = check_motion(geometry_.checker, state_, robot, path,
                                 check_of(geometry_, robot, state_.attachments))
                        .outcome == world::MotionAnswer::Outcome::Free;
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->predicate_calls;
    counters->positive += free ? 0 : 1;
    counters->path_seconds += watch.seconds();
  }
  return free;
}

bool MotionSequence::follow(std::size_t robot, const robot::Path& path) {
  if (!may_follow(robot, path)) {
    fail(Answer::Kind::Impossible, "the motion of the volume is not certainly free now");
    listed_ = true;  // other motions may do
    return false;
  }
  record(robot, path);
  return true;
}

void MotionSequence::add_goals(Goals& goals, std::size_t robot, std::uint32_t link,
                               const Transform& target, bool any) const {
  const Stopwatch watch;
  manipulation::add_goals(goals, geometry_.world.robots[robot], link, target, state_.q[robot],
                          {question_.seed, question_.attempt, any});
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    ++counters->ik_calls;
    counters->ik_seconds += watch.seconds();
  }
}

bool MotionSequence::is_free(const world::WorldState& state) const {
  return geometry_.checker.is_free(state, geometry_.scratch);
}

bool MotionSequence::is_free_at(std::size_t robot, const std::vector<double>& q) const {
  world::WorldState there = state_;
  there.q[robot] = q;
  return is_free(there);
}

bool MotionSequence::is_free_of(std::size_t robot, std::size_t object, const char* when) {
  const world::MotionAnswer answer =
      check_motion(geometry_.checker, state_, robot, {state_.q[robot]},
                   check_of(geometry_, robot, state_.attachments));
  if (answer.outcome == world::MotionAnswer::Outcome::Free) return true;
  std::string reason =
      "the gripper is not free " + std::string(when) + " " + geometry_.world.objects[object].name;
  if (answer.contact)
    reason += ", in the way: " + geometry_.world.name_of(answer.contact->items[0]) + " and " +
              geometry_.world.name_of(answer.contact->items[1]);
  return fail(Answer::Kind::NotFound, std::move(reason));
}

std::vector<double> MotionSequence::with_fingers(std::size_t robot, std::vector<double> q) const {
  return with_fingers_of(geometry_.world.robots[robot], state_.q[robot], std::move(q));
}

bool MotionSequence::move_fingers(std::size_t robot, std::size_t object, Motion::Fingers how) {
  std::vector<double> end = state_.q[robot];
  if (how == Motion::Fingers::Close) {
    set_grippers(geometry_.world, robot, state_.attachments, end);
  } else {
    auto others = state_.attachments;
    others[object].reset();
    set_grippers(geometry_.world, robot, others, end);
  }
  // Suction. Fingers that are there already are looked at: they hold, or let go, from here on.
  if (state_.attachments[object]->fingers.empty()) return true;
  Motion motion;
  motion.path = {state_.q[robot], end};
  world::MotionAnswer answer;
  // Fingers that do not go together come to any combination of values.
  for (std::size_t cells = 1; cells <= kMostCells; cells *= 2) {
    cover_values(motion, cells);
    if (cells > 1 && motion.covering.size() > 2 * kMostLines) break;
    answer = check_motion(geometry_.checker, state_, robot, motion.decided(),
                          check_of(geometry_, robot, state_.attachments, motion.beside));
    if (answer.outcome == world::MotionAnswer::Outcome::Free || motion.covering.empty()) break;
  }
  if (answer.outcome != world::MotionAnswer::Outcome::Free) {
    std::string reason = "the gripper does not ";
    reason += how == Motion::Fingers::Close ? "close on " : "open from ";
    reason += geometry_.world.objects[object].name;
    if (answer.contact)
      reason += ", in the way: " + geometry_.world.name_of(answer.contact->items[0]) + " and " +
                geometry_.world.name_of(answer.contact->items[1]);
    return fail(Answer::Kind::NotFound, std::move(reason));
  }
  const robot::Path last = last_paths_[robot];
  record(robot, motion.path);
  last_paths_[robot] = last;
  motions_.back().fingers = how;
  motions_.back().object = object;
  motions_.back().covering = std::move(motion.covering);
  motions_.back().beside = std::move(motion.beside);
  return true;
}

/// What moves, what it holds by which link, and how.
void MotionSequence::record(std::size_t robot, const robot::Path& path) {
  Motion& motion = motions_.emplace_back();
  motion.robot = robot;
  motion.path = path;
  for (std::size_t o = 0; o < state_.attachments.size(); ++o)
    if (const auto held = held_by(robot, o)) motion.holds.emplace_back(o, *held);
  state_.q[robot] = path.back();
  last_paths_[robot] = path;
}

/// How a robot holds an object with the tool that is at one of its grasps; nullopt: none is.
std::optional<world::Attachment> MotionSequence::find_grasp(std::size_t robot,
                                                            std::size_t object) const {
  if (state_.absent[object] || held_by(robot, object)) return std::nullopt;
  const Transform pose = pose_of_object(object);
  for (const world::ToolFrame& tool : geometry_.world.robots[robot].tools) {
    const Transform link = pose_of_link(robot, tool.link);
    for (const world::Grasp& grasp : geometry_.world.objects[object].grasps) {
      if (!fits(tool, grasp)) continue;
      if (!is_at(link * tool.pose, grasp, pose)) continue;
      world::Attachment held;
      held.robot = robot;
      held.link = tool.link;
      held.pose = inverse(link) * pose;
      if (world::gripper_with_pads(geometry_.world.robots[robot], tool.link) != nullptr)
        held = world::hold_by(geometry_.world, robot, tool.link, held.pose, grasp);
      // As the word has it, with the fingers that may touch.
      return place_of(manipulation::word_of(geometry_.world, held), geometry_.world, object)
          .attachment;
    }
  }
  return std::nullopt;
}

void MotionSequence::carry(std::size_t object, const std::optional<world::Attachment>& held,
                           const Transform& pose) {
  for (std::size_t o = 0; o < mounted_.size(); ++o) {
    if (mounted_[o] != object || state_.absent[o]) continue;
    const Transform relative = inverse(pose_of_object(object)) * pose_of_object(o);
    carry(o, held ? std::optional(carried_along(*held, relative)) : std::nullopt, pose * relative);
  }
  state_.attachments[object] = held;
  if (!held) state_.poses[object] = pose;
}

std::string MotionSequence::word_of_object(std::size_t object) const {
  if (const auto& held = state_.attachments[object])
    return manipulation::word_of(geometry_.world, *held);
  const world::Object& thing = geometry_.world.objects[object];
  const kinematics::PoseError error = kinematics::difference(state_.poses[object], thing.pose);
  return error.position <= kSamePose && error.rotation <= kSamePose
             ? std::string(kStart)
             : manipulation::word_of(state_.poses[object]);
}

std::string MotionSequence::word_of_mounted(std::size_t object) const {
  return manipulation::word_of(geometry_.world, *mounted_[object],
                               inverse(pose_of_object(*mounted_[object])) * pose_of_object(object));
}

}  // namespace kaboum::manipulation
