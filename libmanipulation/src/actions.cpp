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
/// Turns about the vertical that are tried when an object is put down; more with each attempt.
constexpr int kTurns = 8;

Transform pose_of_link(const world::RobotModel& robot, const std::vector<double>& q,
                       std::uint32_t link) {
  return robot.base * forward(robot.kinematics, q)[link];
}

std::string name_of(const world::World& world, const std::array<world::Item, 2>& items) {
  return world.name_of(items[0]) + " and " + world.name_of(items[1]);
}

/// A path to one of some goals, as an answer: the goal's word, and the path as payload.
Answer path_to(Geometry& geometry, const world::WorldState& state, std::size_t robot,
               const Goals& goals, const Question& question, const std::string& out_of_reach) {
  if (goals.configurations.empty())
    return goals.all ? Answer::impossible(out_of_reach) : Answer::not_found(out_of_reach);
  motion::PathOptions options = geometry.options.path;
  options.seed = question.seed;
  for (unsigned i = 0; i < question.attempt; ++i) options.most_work *= kMoreWork;
  const motion::PathAnswer answer =
      find_path(geometry.checker, state, robot, state.q[robot], goals.configurations, options);
  using Outcome = motion::PathAnswer::Outcome;
  switch (answer.outcome) {
    case Outcome::Found:
      return Answer::found(
          word_of(goals.configurations[answer.goal]),
          nlohmann::json{{"robot", geometry.world.robots[robot].name}, {"path", answer.path}}
              .dump());
    case Outcome::GoalInContact: {
      const std::string reason =
          "blocked at its end: " + name_of(geometry.world, answer.contact->items);
      return goals.all ? Answer::impossible(reason) : Answer::not_found(reason);
    }
    case Outcome::StartInContact:
      return Answer::impossible("the robot cannot start: contact of " +
                                name_of(geometry.world, answer.contact->items));
    case Outcome::StartOutsideLimits:
    case Outcome::GoalOutsideLimits:
      return Answer::impossible("outside the limits of a joint");
    case Outcome::WorkEnded:
    case Outcome::NodesEnded:
    case Outcome::TimeEnded:
      break;
  }
  std::string reason = "no path was found";
  if (!answer.blockers.empty())
    reason += "; in the way: " + name_of(geometry.world, answer.blockers.front().items);
  return Answer::not_found(reason);
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

}  // namespace

Answer reach(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  const world::WorldState& state = known.state;
  const world::RobotModel& robot = geometry.world.robots[r];
  const world::Object& object = geometry.world.objects[o];
  if (state.absent[o]) return Answer::impossible(object.name + " is away");
  if (state.attachments[o]) return Answer::impossible(object.name + " is held already");
  if (object.grasps.empty())
    throw Error(ErrorCode::InvalidInput,
                "object '" + object.name + "' of the scene has no grasps, which reach() needs");
  if (robot.tools.empty())
    throw Error(ErrorCode::InvalidInput,
                "robot '" + robot.name + "' of the scene has no tools, which reach() needs");
  Goals goals;
  for (const world::Grasp& grasp : object.grasps)
    for (const world::ToolFrame& tool : robot.tools)
      add_goals(goals, robot, tool.link, state.poses[o] * inverse(grasp.pose) * inverse(tool.pose),
                state.q[r], question.seed);
  return path_to(geometry, state, r, goals, question, object.name + " is out of reach");
}

Answer grasp(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::RobotModel& robot = geometry.world.robots[r];
  const world::Object& object = geometry.world.objects[o];
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  if (known.state.absent[o] || known.state.attachments[o])
    return Answer::impossible(object.name + " does not rest");
  const std::vector<double> q = configuration_of(question.arguments[2], robot);
  // The tool that is where a grasp says.
  const Transform& pose = known.state.poses[o];
  for (const world::ToolFrame& tool : robot.tools) {
    const Transform link = pose_of_link(robot, q, tool.link);
    for (const world::Grasp& grasp : object.grasps) {
      const kinematics::PoseError error =
          kinematics::difference(link * tool.pose * grasp.pose, pose);
      constexpr double kSame = 1e-6;  ///< inverse kinematics and words are far more accurate [m, 1]
      if (error.position > kSame || error.rotation > kSame) continue;
      world::Attachment held;
      held.robot = r;
      held.link = tool.link;
      held.pose = inverse(link) * pose;
      return Answer::found(word_of(geometry.world, held));
    }
  }
  return Answer::impossible("no tool of " + robot.name + " is at a grasp of " + object.name);
}

Answer place(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t s = object_named(geometry, question.arguments[2]);
  const world::World& world = geometry.world;
  const world::Object &object = world.objects[o], &support = world.objects[s];
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  const auto held = held_by(known.state, r, o);
  if (!held) return Answer::impossible(world.robots[r].name + " does not hold " + object.name);
  if (s == o || known.state.absent[s])
    return Answer::impossible(support.name + " is not there to stand on");

  geom::Vec3 top = pose_of_object(world, known.state, s) * point_named(support, "top");
  top.z() += geometry.options.clearance + object.outer.epsilon() + support.outer.epsilon();
  const geom::Vec3 bottom = point_named(object, "bottom");
  Random random(question.seed);
  Goals goals;
  goals.all = false;  // turns between these are possible
  const double first = question.attempt == 0 ? 0 : random.between(0, 2 * std::numbers::pi);
  const int turns = kTurns * static_cast<int>(question.attempt + 1);
  for (int i = 0; i < turns; ++i) {
    Transform pose = turned(first + 2 * std::numbers::pi * i / turns);
    pose.linear = pose.linear * object.pose.linear;  // upright as in the scene
    pose.translation = top - pose.linear * bottom;
    add_goals(goals, world.robots[r], held->link, pose * inverse(held->pose), known.state.q[r],
              question.seed);
  }
  goals.all = false;
  return path_to(geometry, known.state, r, goals, question,
                 object.name + " on " + support.name + " is out of reach");
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
  return Answer::found(word_of(pose_of_link(robot, q, held->link) * held->pose));
}

Answer move(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const GeometricState known = read_state(geometry, question.state);
  if (!known.unknown.empty()) return Answer::not_found(known.unknown);
  Goals goals;
  goals.configurations = {configuration_of(question.arguments[1], geometry.world.robots[r])};
  Answer answer = path_to(geometry, known.state, r, goals, question, "");
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
