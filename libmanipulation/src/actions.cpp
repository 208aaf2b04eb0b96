// External functions of the planner: where a robot reaches, grasps and puts things down, by paths
// that are free at every instant. Source: [gaschler2016] §3.3.2, §6.1.2.
#include "actions.h"

#include <kaboum/base/error.h>
#include <kaboum/base/random.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/regions.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "goals.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using plan::Question;
using world::Transform;

/// Later attempts of a call may work so many times as long as the one before.
constexpr double kMoreWork = 2;
/// Poses no farther apart are the same: ten times what words are rounded to. [m, 1]
constexpr double kSame = 1e-6;
/// Turns about the vertical that are tried when an object is put down; more with each attempt.
constexpr int kTurns = 8;

Transform pose_of_link(const world::RobotModel& robot, const std::vector<double>& q,
                       std::uint32_t link) {
  return robot.base * forward(robot.kinematics, q)[link];
}

std::string name_of(const world::World& world, const std::array<world::Item, 2>& items) {
  return world.name_of(items[0]) + " and " + world.name_of(items[1]);
}

/// A motion that was looked for.
struct Motion {
  Answer::Kind kind = Answer::Kind::Impossible;
  std::string reason;
  robot::Path path;  ///< free at every instant, when found

  [[nodiscard]] bool found() const { return kind == Answer::Kind::Value; }
};

Motion none(bool all, std::string reason) {
  return {all ? Answer::Kind::Impossible : Answer::Kind::NotFound, std::move(reason), {}};
}

/// From the state's configuration to one of some goals.
Motion find_motion(const Geometry& geometry, const world::WorldState& state, std::size_t robot,
                   const Goals& goals, const Question& question) {
  motion::PathOptions options = geometry.options.path;
  options.seed = question.seed;
  for (unsigned i = 0; i < question.attempt; ++i) options.most_work *= kMoreWork;
  motion::PathAnswer answer =
      find_path(geometry.checker, state, robot, state.q[robot], goals.configurations, options);
  using Outcome = motion::PathAnswer::Outcome;
  switch (answer.outcome) {
    case Outcome::Found:
      return {Answer::Kind::Value, "", std::move(answer.path)};
    case Outcome::GoalInContact:
      return none(goals.all,
                  "blocked at its end: " + name_of(geometry.world, answer.contact->items));
    case Outcome::StartInContact:
      return none(true, "the robot cannot start: contact of " +
                            name_of(geometry.world, answer.contact->items));
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
    reason += "; in the way: " + name_of(geometry.world, answer.blockers.front().items);
  return none(false, reason);
}

/// A part of an action in a payload: what moves, what it holds, and how.
nlohmann::json to_json(const Geometry& geometry, const world::WorldState& state, std::size_t robot,
                       const robot::Path& path) {
  nlohmann::json out = {{"robot", geometry.world.robots[robot].name}, {"path", path}};
  for (std::size_t o = 0; o < state.attachments.size(); ++o)
    if (state.attachments[o] && state.attachments[o]->robot == robot)
      out["holds"].push_back(geometry.world.objects[o].name);
  return out;
}

/// The answer of a function whose value is the configuration where a motion ends.
Answer answer_of(const Geometry& geometry, const world::WorldState& state, std::size_t robot,
                 const Motion& motion) {
  if (!motion.found()) return {motion.kind, "", "", motion.reason};
  return Answer::found(
      word_of(motion.path.back()),
      nlohmann::json::array({to_json(geometry, state, robot, motion.path)}).dump());
}

/// A point of an object that a domain's author is asked for.
geom::Vec3 point_named(const world::Object& object, const std::string& name) {
  for (const world::Feature& feature : object.features)
    if (feature.name == name && feature.kind == world::Feature::Kind::Point) return feature.point;
  throw Error(ErrorCode::InvalidInput, "object '" + object.name + "' of the scene has no point '" +
                                           name + "' among its features, which place() needs");
}

/// The attachment of an object to a robot; nullopt: the robot does not hold it.
std::optional<world::Attachment> held_by(const world::WorldState& state, std::size_t robot,
                                         std::size_t object) {
  const auto& attachment = state.attachments[object];
  return attachment && attachment->robot == robot ? attachment : std::nullopt;
}

/// Where an object is in a state. @pre it is not absent.
Transform pose_of_object(const world::World& world, const world::WorldState& state,
                         std::size_t object) {
  const auto& attachment = state.attachments[object];
  if (!attachment) return state.poses[object];
  const world::RobotModel& robot = world.robots[attachment->robot];
  return pose_of_link(robot, state.q[attachment->robot], attachment->link) * attachment->pose;
}

Transform turned(double angle) {
  return {robot::rotation_about(geom::Vec3::UnitZ(), angle), geom::Vec3::Zero()};
}

/// To where a tool holds an object by one of its grasps.
Motion find_reach(const Geometry& geometry, const world::WorldState& state, std::size_t r,
                  std::size_t o, const Question& question) {
  const world::RobotModel& robot = geometry.world.robots[r];
  const world::Object& object = geometry.world.objects[o];
  if (state.absent[o]) return none(true, object.name + " is away");
  if (state.attachments[o]) return none(true, object.name + " is held already");
  if (object.grasps.empty())
    throw Error(ErrorCode::InvalidInput,
                "object '" + object.name + "' of the scene has no grasps, which reaching it needs");
  if (robot.tools.empty())
    throw Error(ErrorCode::InvalidInput,
                "robot '" + robot.name + "' of the scene has no tools, which reaching needs");
  Goals goals;
  for (const world::Grasp& grasp : object.grasps)
    for (const world::ToolFrame& tool : robot.tools)
      add_goals(goals, robot, tool.link, state.poses[o] * inverse(grasp.pose) * inverse(tool.pose),
                state.q[r], question.seed);
  if (goals.configurations.empty()) return none(goals.all, object.name + " is out of reach");
  return find_motion(geometry, state, r, goals, question);
}

/// How a robot holds a resting object with the tool that is at one of its grasps; nullopt: none is.
std::optional<world::Attachment> find_grasp(const Geometry& geometry,
                                            const world::WorldState& state, std::size_t r,
                                            std::size_t o, const std::vector<double>& q) {
  if (state.absent[o] || state.attachments[o]) return std::nullopt;
  const world::RobotModel& robot = geometry.world.robots[r];
  const Transform& pose = state.poses[o];
  for (const world::ToolFrame& tool : robot.tools) {
    const Transform link = pose_of_link(robot, q, tool.link);
    for (const world::Grasp& grasp : geometry.world.objects[o].grasps) {
      const kinematics::PoseError error =
          kinematics::difference(link * tool.pose * grasp.pose, pose);
      if (error.position > kSame || error.rotation > kSame) continue;
      world::Attachment held;
      held.robot = r;
      held.link = tool.link;
      held.pose = inverse(link) * pose;
      // As the word has it, with the fingers that may touch.
      return place_of(word_of(geometry.world, held), geometry.world, o).attachment;
    }
  }
  return std::nullopt;
}

/// To where an object that is held stands on another one, upright as in the scene.
Motion find_place(const Geometry& geometry, const world::WorldState& state, std::size_t r,
                  std::size_t o, std::size_t s, const Question& question) {
  const world::World& world = geometry.world;
  const world::Object &object = world.objects[o], &support = world.objects[s];
  const auto held = held_by(state, r, o);
  if (!held) return none(true, world.robots[r].name + " does not hold " + object.name);
  if (s == o || state.absent[s]) return none(true, support.name + " is not there to stand on");
  geom::Vec3 top = pose_of_object(world, state, s) * point_named(support, "top");
  top.z() += geometry.options.clearance + object.outer.epsilon() + support.outer.epsilon();
  const geom::Vec3 bottom = point_named(object, "bottom");
  Random random(question.seed);
  const double first = question.attempt == 0 ? 0 : random.between(0, 2 * std::numbers::pi);
  const int turns = kTurns * static_cast<int>(question.attempt + 1);
  // One after the other: an object that is put to the same place again is likely to be in the same
  // state again.
  Motion last = none(false, object.name + " on " + support.name + " is out of reach");
  for (int i = 0; i < turns; ++i) {
    Transform pose = turned(first + 2 * std::numbers::pi * i / turns);
    pose.linear = pose.linear * object.pose.linear;
    pose.translation = top - pose.linear * bottom;
    Goals goals;
    add_goals(goals, world.robots[r], held->link, pose * inverse(held->pose), state.q[r],
              question.seed);
    goals.all = false;  // there are other turns
    if (goals.configurations.empty()) continue;
    last = find_motion(geometry, state, r, goals, question);
    if (last.found()) break;
  }
  return last;
}

/// Of a pose where an object rests; `kStart` where that is, up to rounding.
std::string word_of_rest(const world::Object& object, const Transform& pose) {
  const kinematics::PoseError error = kinematics::difference(pose, object.pose);
  return error.position <= kSame && error.rotation <= kSame ? std::string(kStart) : word_of(pose);
}

/// Where an object is when it is let go, as its word has it.
Transform let_go(const Geometry& geometry, std::size_t r, std::size_t o,
                 const world::Attachment& held, const std::vector<double>& q) {
  const Transform pose = pose_of_link(geometry.world.robots[r], q, held.link) * held.pose;
  return place_of(word_of_rest(geometry.world.objects[o], pose), geometry.world, o).pose;
}

}  // namespace

Answer reach(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  return answer_of(geometry, known.state, r, find_reach(geometry, known.state, r, o, question));
}

Answer grasp(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::RobotModel& robot = geometry.world.robots[r];
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  const auto held =
      find_grasp(geometry, known.state, r, o, configuration_of(question.arguments[2], robot));
  if (!held)
    return Answer::impossible("no tool of " + robot.name + " is at a grasp of " +
                              geometry.world.objects[o].name + ", or it does not rest");
  return Answer::found(word_of(geometry.world, *held));
}

Answer place(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t s = object_named(geometry, question.arguments[2]);
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  return answer_of(geometry, known.state, r, find_place(geometry, known.state, r, o, s, question));
}

Answer transfer(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t s = object_named(geometry, question.arguments[2]);
  const world::RobotModel& robot = geometry.world.robots[r];
  Goals end;
  end.configurations = {configuration_of(question.arguments[3], robot)};
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  world::WorldState state = known.state;
  nlohmann::json paths = nlohmann::json::array();
  // What fails here failed for the grasp that was chosen; another attempt may choose another one.
  const auto failed = [&](const Motion& motion) {
    return paths.empty() ? Answer{motion.kind, "", "", motion.reason}
                         : Answer::not_found(motion.reason);
  };
  const auto perform = [&](const Motion& motion) {
    paths.push_back(to_json(geometry, state, r, motion.path));
    state.q[r] = motion.path.back();
  };
  const Motion to_object = find_reach(geometry, state, r, o, question);
  if (!to_object.found()) return failed(to_object);
  perform(to_object);
  state.attachments[o] = find_grasp(geometry, state, r, o, state.q[r]);
  ensure(state.attachments[o].has_value(), "a configuration that reaches no grasp");
  const Motion to_support = find_place(geometry, state, r, o, s, question);
  if (!to_support.found()) return failed(to_support);
  perform(to_support);
  state.poses[o] = let_go(geometry, r, o, *state.attachments[o], state.q[r]);
  state.attachments[o].reset();
  const Motion away = find_motion(geometry, state, r, end, question);
  if (!away.found()) return failed(away);
  perform(away);
  return Answer::found(word_of_rest(geometry.world.objects[o], state.poses[o]), paths.dump());
}

Answer release(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::RobotModel& robot = geometry.world.robots[r];
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  const auto held = held_by(known.state, r, o);
  if (!held)
    return Answer::impossible(robot.name + " does not hold " + geometry.world.objects[o].name);
  const std::vector<double> q = configuration_of(question.arguments[2], robot);
  return Answer::found(word_of_rest(geometry.world.objects[o], let_go(geometry, r, o, *held, q)));
}

Answer move(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  Goals goals;
  goals.configurations = {configuration_of(question.arguments[1], geometry.world.robots[r])};
  Answer answer =
      answer_of(geometry, known.state, r, find_motion(geometry, known.state, r, goals, question));
  if (answer.kind == Answer::Kind::Value) answer.value = question.arguments[1];  // "home"
  return answer;
}

Answer is_inside(Geometry& geometry, const Question& question) {
  const std::size_t o = object_named(geometry, question.arguments[0]);
  const world::World& world = geometry.world;
  std::size_t region = 0;
  while (region < world.regions.size() && world.regions[region].name != question.arguments[1])
    ++region;
  if (region == world.regions.size())
    throw Error(ErrorCode::InvalidInput, "the scene has no region '" + question.arguments[1] + "'");
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  if (known.state.absent[o]) return Answer::holds(false, world.objects[o].name + " is away");
  const auto inclusion =
      find_inclusion(geometry.checker, known.state, {world::Item::kObject, o}, region);
  return Answer::holds(inclusion == collide::Inclusion::Included, "it is not certain");
}

Answer collides(Geometry& geometry, const Question& question) {
  const world::Item a{world::Item::kObject, object_named(geometry, question.arguments[0])};
  const world::Item b{world::Item::kObject, object_named(geometry, question.arguments[1])};
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  world::Scratch scratch;
  world::Checker::Options options;
  options.resting = true;
  for (const world::Contact& contact :
       geometry.checker.find_contacts(known.state, scratch, options))
    if ((contact.items[0] == a && contact.items[1] == b) ||
        (contact.items[0] == b && contact.items[1] == a))
      return Answer::holds(true);
  return Answer::holds(false, "they are apart");
}

}  // namespace kaboum::manipulation
