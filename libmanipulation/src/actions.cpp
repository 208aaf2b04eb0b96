// External functions of the planner: where robots reach, grasp and put things down, by paths that
// are free at every instant. Source: [gaschler2016] §3.3.2, §6.1.2.
#include "actions.h"

#include <kaboum/base/error.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/regions.h>

#include <algorithm>

#include "involved.h"
#include "sequence.h"
#include "volumes.h"

namespace kaboum::manipulation {
namespace {

using plan::Answer;
using plan::Question;

/// What a call is about, and all that it looks at.
struct CallState {
  CallState(Geometry& geometry, const Question& question) : state(geometry, question.state) {}
  GeometricState state;

  [[nodiscard]] Answer not_known() const { return Answer::not_found(state.unknown()); }
};

/// A call, by the names of its function and of the things that it is about.
struct Call {
  const char* name;
  std::vector<std::size_t> robots, objects;
};

/// Rounds after which all things are involved; answers that are kept, and things in the way of
/// them.
constexpr int kRounds = 4;
constexpr std::size_t kMostKept = 20'000, kMostDecided = 50'000'000;

std::string key_of(const Call& call, const Question& question) {
  std::string key = call.name;
  for (const std::string& argument : question.arguments) key.append(1, ' ').append(argument);
  key += '\n';
  add_to_key(key, question.seed);
  add_to_key(key, question.attempt);
  add_to_key(key, question.choice);
  return key;
}

/// What a call leads to among the things that are involved.
template <typename Act, typename Value>
Performed& perform_among(Geometry& geometry, const Question& question, const std::string& prefix,
                         const Involved& involved, const Act& act, const Value& value) {
  std::string key = prefix;
  involved.add_to(key);
  auto found = geometry.performed.find(key);
  if (found == geometry.performed.end()) {
    Sequence sequence(geometry, question, involved.state(), involved.mounted());
    Performed done;
    done.answer = act(sequence) ? sequence.found(value(sequence)) : sequence.failure();
    done.motions = sequence.motions();
    found = geometry.performed.emplace(std::move(key), std::move(done)).first;
  }
  return found->second;
}

/// Does what `act` does, among the things that the call is about and those that are in the way;
/// `value` is what it has led to. What fails among some things fails among all: so what fails among
/// those that the call names reads nothing else.
template <typename Act, typename Value>
Answer perform(Geometry& geometry, const Question& question, const Call& call, const Act& act,
               const Value& value) {
  CallState asked(geometry, question);
  if (!asked.state.read(call.robots, call.objects)) return asked.not_known();
  if (question.early && !asked.state.read_all()) return asked.not_known();
  if (geometry.performed.size() >= kMostKept ||
      geometry.performed.size() * geometry.placed.size() >= kMostDecided) {
    geometry.performed.clear();
    geometry.placed.clear();
  }
  const std::string prefix = key_of(call, question);
  if (!call.objects.empty()) {  // else what is carried is not known
    const Involved named(geometry, asked.state, call.robots, call.objects);
    const Answer& answer = perform_among(geometry, question, prefix, named, act, value).answer;
    if (answer.kind != Answer::Kind::Value) return answer;
  }
  if (!asked.state.read_all()) return asked.not_known();
  Involved involved(geometry, asked.state, call.robots, call.objects);
  for (int round = 1;; ++round) {
    Performed& performed = perform_among(geometry, question, prefix, involved, act, value);
    if (performed.answer.kind != Answer::Kind::Value || !involved.add_obstacles(performed))
      return performed.answer;
    if (round == kRounds) involved.add_all();
  }
}

/// Reads the object alone, and says where it is out of reach whatever else there is.
std::optional<Answer> out_of_reach(Geometry& geometry, const Question& question, std::size_t robot,
                                   std::size_t object) {
  CallState asked(geometry, question);
  if (!asked.state.read_object(object)) return asked.not_known();
  const world::WorldState& state = asked.state.world();
  Sequence sequence(geometry, question, state, asked.state.mounted());
  std::string key;
  add_to_key(key, robot);
  add_to_key(key, object);
  add_to_key(key, question.seed);
  add_to_key(key, question.attempt);
  add_to_key(key, (state.absent[object] ? 1U : 0U) + (sequence.held_by(robot, object) ? 2U : 0U));
  add_to_key(key, state.q[robot]);
  add_to_key(key, sequence.pose_of_object(object));
  if (geometry.reached.size() >= kMostKept) geometry.reached.clear();
  auto found = geometry.reached.find(key);
  if (found == geometry.reached.end()) {
    Answer answer = sequence.is_in_reach(robot, object) ? Answer::holds(true) : sequence.failure();
    found = geometry.reached.emplace(std::move(key), std::move(answer)).first;
  }
  if (found->second.kind == Answer::Kind::Value) return std::nullopt;
  return found->second;
}

/// Motions that fetch an object and go back, or why there are none.
struct Fetched {
  std::vector<Motion> motions;
  Answer found;  ///< without a value
  Answer failure;
};

/// Reads what a motion that fetches an object is looked for among: robots, the object and the
/// things that nobody grasps.
bool read_to_fetch(const Geometry& geometry, GeometricState& state, std::size_t object) {
  const world::World& world = geometry.world;
  for (std::size_t robot = 0; robot < world.robots.size(); ++robot)
    if (!state.read_robot(robot)) return false;
  for (std::size_t i = 0; i < world.objects.size(); ++i)
    if ((i == object || world.objects[i].grasps.empty()) && !state.read_object(i)) return false;
  return true;
}

/// The first that is found, of all attempts up to the question's. A question's own seed is made of
/// its arguments: what is found here is the same whatever else is asked about.
Fetched fetch_alone(Geometry& geometry, const Question& question, const world::WorldState& state,
                    const std::vector<std::optional<std::size_t>>& mounted, std::size_t robot,
                    std::size_t object) {
  Fetched out;
  for (unsigned attempt = 0; attempt <= question.attempt; ++attempt) {
    const Question same{question.arguments, question.state, 1, attempt, 0};
    Sequence sequence(geometry, same, state, mounted);
    if (sequence.reach(robot, object) && sequence.take(robot, object) &&
        sequence.go(robot, state.q[robot])) {
      out.motions = sequence.motions();
      out.found = sequence.found("");
      break;
    }
    out.failure = sequence.failure();
    if (out.failure.kind == Answer::Kind::Impossible) break;
  }
  return out;
}

/// Whether the same objects are held in the very same way.
bool are_same(const std::vector<std::pair<std::size_t, world::Attachment>>& a,
              const std::vector<std::pair<std::size_t, world::Attachment>>& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.link == y.second.link &&
           x.second.pose.linear == y.second.pose.linear &&
           x.second.pose.translation == y.second.pose.translation;
  });
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
      geometry, question, {"reach", {r}, {o}}, [&](Sequence& s) { return s.reach(r, o); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer grasp(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::vector<double> q = configuration_of(question.arguments[2], geometry.world.robots[r]);
  if (has_pads(geometry.world.robots[r]))  // what they hold already matters
    return perform(
        geometry, question, {"grasp", {r}, {o}},
        [&](Sequence& s) {
          s.start_at(r, q);
          return !s.state().attachments[o] && s.take(r, o);
        },
        [&](const Sequence& s) { return s.word_of_object(o); });
  CallState asked(geometry, question);
  if (!asked.state.read_object(o)) return asked.not_known();
  asked.state.set_robot(r, q);
  Sequence sequence(geometry, question, asked.state.world(), asked.state.mounted());
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
      geometry, question, {"place", {r}, {o, support}},
      [&](Sequence& s) { return s.place(r, o, support, false); },
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
    return s.let_go(r, o) && s.go(r, end);
  };
  return perform(geometry, question, {"transfer", {r}, {o, support}}, act,
                 [&](const Sequence& s) { return s.word_of_object(o); });
}

Answer fetch(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::vector<double> end = configuration_of(question.arguments[2], geometry.world.robots[r]);
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  return perform(
      geometry, question, {"fetch", {r}, {o}},
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
    return s.let_go(r, o) && s.go(r, end);
  };
  return perform(geometry, question, {upright ? "putUpright" : "put", {r}, {o, support}}, act,
                 [&](const Sequence& s) { return s.word_of_object(o); });
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
      geometry, question, {"lift", {r}, {o}},
      [&](Sequence& s) { return s.lift(r, o, geometry.options.lift); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer join(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t onto = object_named(geometry, question.arguments[2]);
  const std::vector<double> end = configuration_of(question.arguments[3], geometry.world.robots[r]);
  const auto act = [&](Sequence& s) {
    if (!s.mount(r, o, onto)) return false;
    return s.let_go(r, o) && s.withdraw(r) && s.go(r, end);
  };
  return perform(geometry, question, {"join", {r}, {o, onto}}, act,
                 [&](const Sequence& s) { return s.word_of_mounted(o); });
}

Answer push(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t support = object_named(geometry, question.arguments[2]);
  const std::vector<double> end = configuration_of(question.arguments[3], geometry.world.robots[r]);
  return perform(
      geometry, question, {"push", {r}, {o, support}},
      [&](Sequence& s) { return s.push(r, o, support) && s.go(r, end); },
      [&](const Sequence& s) { return s.word_of_object(o); });
}

Answer hand_over(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t to = robot_named(geometry, question.arguments[2]);
  return perform(
      geometry, question, {"handOver", {r, to}, {o}},
      [&](Sequence& s) { return s.hand_over(r, o, to); },
      [&](const Sequence& s) { return s.word_of_object(o); });
}

Answer wander(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  return perform(
      geometry, question, {"wander", {r}, {}}, [&](Sequence& s) { return s.wander(r); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer release(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::RobotModel& robot = geometry.world.robots[r];
  const std::vector<double> q = configuration_of(question.arguments[2], robot);
  const std::string not_held = robot.name + " does not hold " + geometry.world.objects[o].name;
  if (has_finger_joints(robot))
    return perform(
        geometry, question, {"release", {r}, {o}},
        [&](Sequence& s) {
          s.start_at(r, q);
          return s.held_by(r, o) ? s.let_go(r, o) : s.fail(Answer::Kind::Impossible, not_held);
        },
        [&](const Sequence& s) { return s.word_of_object(o); });
  CallState asked(geometry, question);
  if (!asked.state.read_object(o)) return asked.not_known();
  asked.state.set_robot(r, q);
  Sequence sequence(geometry, question, asked.state.world(), asked.state.mounted());
  if (!sequence.held_by(r, o)) return Answer::impossible(not_held);
  if (!sequence.let_go(r, o)) return sequence.failure();
  return Answer::found(sequence.word_of_object(o));
}

Answer move(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> end = configuration_of(question.arguments[1], geometry.world.robots[r]);
  Answer answer = perform(
      geometry, question, {"move", {r}, {}}, [&](Sequence& s) { return s.go(r, end); },
      [&](const Sequence&) { return question.arguments[1]; });  // "home"
  answer.fixed = true;
  return answer;
}

Answer is_inside(Geometry& geometry, const Question& question) {
  const std::size_t o = object_named(geometry, question.arguments[0]);
  const world::World& world = geometry.world;
  const std::size_t region = region_named(geometry, question.arguments[1]);
  CallState asked(geometry, question);
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
  CallState asked(geometry, question);
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

namespace {

/// @throws Error{InvalidInput} when the scene has none of that name.
const world::ConstraintSet& constraints_named(const Geometry& geometry, const std::string& name) {
  try {
    return geometry.world.constraint_set(name);
  } catch (const Error& error) {
    throw Error(ErrorCode::InvalidInput, error.what());
  }
}

/// Objects, or robots, that constraints are about, each once; after `first`.
std::vector<std::size_t> things_of(const world::ConstraintSet& set, world::FixedFeature::To kind,
                                   std::vector<std::size_t> first = {}) {
  std::vector<std::size_t> out = std::move(first);
  for (const std::vector<world::ToleratedConstraint>* some : {&set.constraints, &set.preferred})
    for (const world::ToleratedConstraint& c : *some)
      for (const world::FixedFeature* feature : {&c.first, &c.second})
        if (feature->to == kind && std::ranges::find(out, feature->index) == out.end())
          out.push_back(feature->index);
  return out;
}

}  // namespace

Answer satisfy(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  using To = world::FixedFeature::To;
  const world::ConstraintSet& set = constraints_named(geometry, question.arguments[1]);
  // Where other robots are decides what is met: they are read like what is named.
  return perform(
      geometry, question, {"satisfy", things_of(set, To::Link, {r}), things_of(set, To::Object)},
      [&](Sequence& s) { return s.satisfy(r, set); },
      [&](const Sequence& s) { return configuration(s, r); });
}

Answer mate(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const std::size_t onto = object_named(geometry, question.arguments[2]);
  const world::ConstraintSet& set = constraints_named(geometry, question.arguments[3]);
  const std::vector<double> end = configuration_of(question.arguments[4], geometry.world.robots[r]);
  const auto is_of = [](const world::FixedFeature& feature, std::size_t object) {
    return feature.to == world::FixedFeature::To::Object && feature.index == object;
  };
  const auto is_between = [&](const world::ToleratedConstraint& c) {
    return (is_of(c.first, o) && is_of(c.second, onto)) ||
           (is_of(c.first, onto) && is_of(c.second, o));
  };
  if (!std::ranges::all_of(set.constraints, is_between) ||
      !std::ranges::all_of(set.preferred, is_between))
    throw Error(ErrorCode::InvalidInput, "the constraints '" + set.name + "' are not between " +
                                             question.arguments[1] + " and " +
                                             question.arguments[2] + " alone, as a mate's are");
  const auto act = [&](Sequence& s) {
    if (!s.mate(r, o, onto, set)) return false;
    return s.let_go(r, o) && s.go(r, end);
  };
  return perform(geometry, question, {"mate", {r}, {o, onto}}, act,
                 [&](const Sequence& s) { return s.word_of_mounted(o); });
}

/// Table II of the workshop paper. The arguments may come in either order, as in the thesis.
Answer is_reachable(Geometry& geometry, const Question& question) {
  const bool robot_first = geometry.world.find_robot(question.arguments[0]).has_value();
  const std::size_t r = robot_named(geometry, question.arguments[robot_first ? 0 : 1]);
  const std::size_t o = object_named(geometry, question.arguments[robot_first ? 1 : 0]);
  if (geometry.world.objects[o].grasps.empty())
    throw Error(ErrorCode::InvalidInput, "object '" + geometry.world.objects[o].name +
                                             "' of the scene has no grasps, which isReachable "
                                             "looks for");
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  return Answer::holds(true);
}

/// Table I of the workshop paper: one motion that fetches an object is found among the things that
/// nobody grasps; then it is tried against the other one.
Answer grasp_motion_collides(Geometry& geometry, const Question& question) {
  const world::World& world = geometry.world;
  const std::size_t skip = question.arguments.size() - 2;
  if (skip == 0 && world.robots.size() != 1)
    throw Error(ErrorCode::InvalidInput,
                "graspMotionCollides(object, object) is of the only robot, and the scene has " +
                    std::to_string(world.robots.size()) +
                    ": graspMotionCollides(robot, object, object)");
  const std::size_t r = skip == 0 ? 0 : robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[skip]);
  const std::size_t other = object_named(geometry, question.arguments[skip + 1]);
  if (other == o) return Answer::holds(false, "it is what is grasped");
  CallState asked(geometry, question);
  if (!read_to_fetch(geometry, asked.state, o) || !asked.state.read_object(other))
    return asked.not_known();
  world::WorldState state = asked.state.world();
  if (state.absent[other]) return Answer::holds(false, question.arguments[skip + 1] + " is away");
  state.absent[other] = true;
  const Fetched fetched = fetch_alone(geometry, question, state, asked.state.mounted(), r, o);
  if (fetched.motions.empty()) {
    // Impossible would mean that nothing collides.
    return fetched.failure.kind == Answer::Kind::NotFound
               ? fetched.failure
               : Answer::holds(true, fetched.failure.reason);
  }
  state.absent[other] = false;
  const std::vector<world::Item> things{{world::Item::kObject, other}};
  for (const Motion& motion : fetched.motions) {
    world::WorldState then = state;
    for (const auto& [object, held] : motion.holds) then.attachments[object] = held;
    if (!find_obstacles(geometry.checker, then, r, motion.decided(), things,
                        check_of(geometry, r, then.attachments, motion.beside))
             .empty())
      return Answer::holds(true);
  }
  return Answer::holds(false, "the motion is free of it");
}

Answer swept_collides(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> to = configuration_of(question.arguments[1], geometry.world.robots[r]);
  const std::size_t o = object_named(geometry, question.arguments[2]);
  CallState asked(geometry, question);
  // The other robots are in the world as well, where they are.
  for (std::size_t other = 0; other < geometry.world.robots.size(); ++other)
    if (!asked.state.read_robot(other)) return asked.not_known();
  if (!asked.state.read_object(o)) return asked.not_known();
  const world::WorldState& state = asked.state.world();
  if (state.absent[o]) return Answer::holds(false, question.arguments[2] + " is away");
  // All other objects are absent: they were not read. Contacts of the robot with itself and
  // with others count.
  world::MotionOptions check = geometry.check;
  check.around = asked.state.finger_room(r);
  const auto motion =
      check_motion(geometry.checker, state, r,
                   {state.q[r], with_fingers_of(geometry.world.robots[r], state.q[r], to)}, check);
  return Answer::holds(motion.outcome != world::MotionAnswer::Outcome::Free, "it is free");
}

namespace {

/// The word of the volume of what a sequence did; where it did nothing, of the robot where it is.
std::string volume_of_sequence(const Geometry& geometry, const Sequence& s, std::size_t robot) {
  if (!s.motions().empty()) return volume_word(geometry.world, s.motions());
  return volume_word(geometry.world, {motion_in(s.state(), robot, {s.state().q[robot]})});
}

}  // namespace

Answer path_volume(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> end = configuration_of(question.arguments[1], geometry.world.robots[r]);
  Answer answer = perform(
      geometry, question, {"pathVolume", {r}, {}}, [&](Sequence& s) { return s.go(r, end); },
      [&](const Sequence& s) { return volume_of_sequence(geometry, s, r); });
  answer.payload.clear();  // nothing moves
  return answer;
}

Answer reach_volume(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  if (auto no = out_of_reach(geometry, question, r, o)) return *no;
  Answer answer = perform(
      geometry, question, {"reachVolume", {r}, {o}}, [&](Sequence& s) { return s.reach(r, o); },
      [&](const Sequence& s) { return volume_of_sequence(geometry, s, r); });
  answer.payload.clear();
  return answer;
}

/// The motion is that of graspMotionCollides, and free of what nobody grasps.
Answer grasp_volume(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  CallState asked(geometry, question);
  if (!read_to_fetch(geometry, asked.state, o)) return asked.not_known();
  const Fetched fetched =
      fetch_alone(geometry, question, asked.state.world(), asked.state.mounted(), r, o);
  if (fetched.motions.empty()) return fetched.failure;
  Answer answer = fetched.found;
  answer.value = volume_word(geometry.world, fetched.motions);
  return answer;
}

Answer follow(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const world::RobotModel& robot = geometry.world.robots[r];
  const auto volume = volume_of(geometry, question.arguments[1]);
  if (volume->motions.size() != 1 || volume->motions.front().robot != r)
    return Answer::impossible("the volume is not of one motion of " + robot.name);
  const Motion& motion = volume->motions.front();
  const auto begins_here = [&](const world::WorldState& state) {
    const Motion now = motion_in(state, r, {state.q[r]});
    return now.path.front() == motion.path.front() && are_same(now.holds, motion.holds);
  };
  return perform(
      geometry, question, {"follow", {r}, {}},
      [&](Sequence& s) {
        return begins_here(s.state())
                   ? s.follow(r, motion.path)
                   : s.fail(Answer::Kind::Impossible,
                            robot.name +
                                " is not where the volume's motion begins, with what it holds");
      },
      [&](const Sequence& s) {
        return s.state().q[r] == robot.home ? std::string(kHome) : configuration(s, r);
      });
}

}  // namespace kaboum::manipulation
