// External functions of the planner: where robots reach, grasp and put things down, by paths that
// are free at every instant. Source: [gaschler2016] §3.3.2, §6.1.2.
#include "actions.h"

#include <kaboum/base/error.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/regions.h>

#include "sequence.h"

namespace kaboum::manipulation {
namespace {

using plan::Answer;
using plan::Question;

/// What a call is about, and all that it looks at.
struct Asked {
  Asked(Geometry& geometry, const Question& question) : state(geometry, question.state) {}
  GeometricState state;

  [[nodiscard]] Answer not_known() const { return Answer::not_found(state.unknown()); }
};

/// Looks at everything, and does what `act` does; `value` is what it has led to.
template <typename Act, typename Value>
Answer perform(Geometry& geometry, const Question& question, const Act& act, const Value& value) {
  Asked asked(geometry, question);
  if (!asked.state.read_all()) return asked.not_known();
  Sequence sequence(geometry, question, asked.state);
  return act(sequence) ? sequence.found(value(sequence)) : sequence.failure();
}

/// Reads the object alone, and says where it is out of reach whatever else there is.
std::optional<Answer> out_of_reach(Geometry& geometry, const Question& question, std::size_t robot,
                                   std::size_t object) {
  Asked asked(geometry, question);
  if (!asked.state.read_object(object)) return asked.not_known();
  Sequence sequence(geometry, question, asked.state);
  if (sequence.is_in_reach(robot, object)) return std::nullopt;
  return sequence.failure();
}

std::string configuration(const Sequence& s, std::size_t robot) {
  return word_of(s.state().q[robot]);
}

}  // namespace

Answer reach(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  return perform(
      geometry, question, [&](Sequence& s) { return s.reach(r, o); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer grasp(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  Asked asked(geometry, question);
  if (!asked.state.read_object(o)) return asked.not_known();
  asked.state.set_robot(r, configuration_of(question.arguments[2], geometry.world.robots[r]));
  Sequence sequence(geometry, question, asked.state);
  if (sequence.state().attachments[o] || !sequence.take(r, o))
    return Answer::impossible("no tool of " + geometry.world.robots[r].name + " is at a grasp of " +
                              geometry.world.objects[o].name + ", or it does not rest");
  return Answer::found(sequence.word_of_object(o));
}

Answer place(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t support = object_named(geometry, question.arguments[2]);
  return perform(
      geometry, question, [&](Sequence& s) { return s.place(r, o, support, false); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer transfer(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t support = object_named(geometry, question.arguments[2]);
  const std::vector<double> end = configuration_of(question.arguments[3], geometry.world.robots[r]);
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  const auto act = [&](Sequence& s) {
    if (!s.reach(r, o) || !s.take(r, o) || !s.place(r, o, support, false)) return false;
    s.let_go(r, o);
    return s.go(r, end);
  };
  return perform(geometry, question, act, [&](const Sequence& s) { return s.word_of_object(o); });
}

Answer fetch(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::vector<double> end = configuration_of(question.arguments[2], geometry.world.robots[r]);
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  return perform(
      geometry, question,
      [&](Sequence& s) { return s.reach(r, o) && s.take(r, o) && s.go(r, end); },
      [&](const Sequence& s) { return s.word_of_object(o); });
}

namespace {

Answer put_down(Geometry& geometry, const Question& question, bool upright) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t support = object_named(geometry, question.arguments[2]);
  const std::vector<double> end = configuration_of(question.arguments[3], geometry.world.robots[r]);
  const auto act = [&](Sequence& s) {
    if (!s.place(r, o, support, upright)) return false;
    s.let_go(r, o);
    return s.go(r, end);
  };
  return perform(geometry, question, act, [&](const Sequence& s) { return s.word_of_object(o); });
}

}  // namespace

Answer put(Geometry& geometry, const Question& question) {
  return put_down(geometry, question, false);
}

Answer put_upright(Geometry& geometry, const Question& question) {
  return put_down(geometry, question, true);
}

Answer lift(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  return perform(
      geometry, question, [&](Sequence& s) { return s.lift(r, o, geometry.options.lift); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer join(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t onto = object_named(geometry, question.arguments[2]);
  const std::vector<double> end = configuration_of(question.arguments[3], geometry.world.robots[r]);
  const auto act = [&](Sequence& s) {
    if (!s.mount(r, o, onto)) return false;
    s.let_go(r, o);
    return s.withdraw(r) && s.go(r, end);
  };
  return perform(geometry, question, act, [&](const Sequence& s) { return s.word_of_mounted(o); });
}

Answer hand_over(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t to = robot_named(geometry, question.arguments[2]);
  return perform(
      geometry, question, [&](Sequence& s) { return s.hand_over(r, o, to); },
      [&](const Sequence& s) { return s.word_of_object(o); });
}

Answer wander(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  return perform(
      geometry, question, [&](Sequence& s) { return s.wander(r); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer release(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::RobotModel& robot = geometry.world.robots[r];
  Asked asked(geometry, question);
  if (!asked.state.read_object(o)) return asked.not_known();
  asked.state.set_robot(r, configuration_of(question.arguments[2], robot));
  Sequence sequence(geometry, question, asked.state);
  if (!sequence.held_by(r, o))
    return Answer::impossible(robot.name + " does not hold " + geometry.world.objects[o].name);
  sequence.let_go(r, o);
  return Answer::found(sequence.word_of_object(o));
}

Answer move(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> end = configuration_of(question.arguments[1], geometry.world.robots[r]);
  return perform(
      geometry, question, [&](Sequence& s) { return s.go(r, end); },
      [&](const Sequence&) { return question.arguments[1]; });  // "home"
}

Answer is_inside(Geometry& geometry, const Question& question) {
  const std::size_t o = object_named(geometry, question.arguments[0]);
  const world::World& world = geometry.world;
  std::size_t region = 0;
  while (region < world.regions.size() && world.regions[region].name != question.arguments[1])
    ++region;
  if (region == world.regions.size())
    throw Error(ErrorCode::InvalidInput, "the scene has no region '" + question.arguments[1] + "'");
  Asked asked(geometry, question);
  if (!asked.state.read_object(o)) return asked.not_known();
  if (asked.state.world().absent[o])
    return Answer::holds(false, world.objects[o].name + " is away");
  const auto inclusion =
      find_inclusion(geometry.checker, asked.state.world(), {world::Item::kObject, o}, region);
  return Answer::holds(inclusion == collide::Inclusion::Included, "it is not certain");
}

Answer collides(Geometry& geometry, const Question& question) {
  const world::Item a{world::Item::kObject, object_named(geometry, question.arguments[0])};
  const world::Item b{world::Item::kObject, object_named(geometry, question.arguments[1])};
  Asked asked(geometry, question);
  if (!asked.state.read_object(a.index) || !asked.state.read_object(b.index))
    return asked.not_known();
  world::Scratch scratch;
  world::Checker::Options options;
  options.resting = true;
  for (const world::Contact& contact :
       geometry.checker.find_contacts(asked.state.world(), scratch, options))
    if ((contact.items[0] == a && contact.items[1] == b) ||
        (contact.items[0] == b && contact.items[1] == a))
      return Answer::holds(true);
  return Answer::holds(false, "they are apart");
}

Answer swept_collides(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> to = configuration_of(question.arguments[1], geometry.world.robots[r]);
  const std::size_t o = object_named(geometry, question.arguments[2]);
  Asked asked(geometry, question);
  // The other robots are in the world as well, where they are.
  for (std::size_t other = 0; other < geometry.world.robots.size(); ++other)
    if (!asked.state.read_robot(other)) return asked.not_known();
  if (!asked.state.read_object(o)) return asked.not_known();
  const world::WorldState& state = asked.state.world();
  if (state.absent[o]) return Answer::holds(false, question.arguments[2] + " is away");
  // All other objects are absent: they were not read. Contacts of the robot with itself and
  // with others count.
  const auto motion =
      check_motion(geometry.checker, state, r, {state.q[r], to}, geometry.options.path.check);
  return Answer::holds(motion.outcome != world::MotionAnswer::Outcome::Free, "it is free");
}

}  // namespace kaboum::manipulation
