// External functions of the planner that make volumes and tell where they are.
// docs/planning/geometry.md, "Volumes".
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/gripper.h>

#include <algorithm>

#include "actions.h"
#include "motion_sequence.h"
#include "volumes.h"

namespace kaboum::manipulation {

using plan::Answer;
using plan::Question;

Answer swept_volume(Geometry& geometry, const Question& question) {
  const std::size_t r = robot_named(geometry, question.arguments[0]);
  const std::vector<double> to = configuration_of(question.arguments[1], geometry.world.robots[r]);
  if (find_out_of_limits(geometry.world.robots[r].kinematics, to))
    return Answer::impossible("outside the limits of a joint");
  GeometricState state(geometry, question.state);
  if (!state.read_all()) return Answer::not_found(state.unknown());
  const std::vector<double>& from = state.world().q[r];
  const Motion motion =
      motion_in(state.world(), r, {from, with_fingers_of(geometry.world.robots[r], from, to)});
  return Answer::found(volume_word(geometry.world, {motion}));
}

Answer occupied_volume(Geometry& geometry, const Question& question) {
  const std::string& name = question.arguments[0];
  GeometricState state(geometry, question.state);
  auto robot = geometry.world.find_robot(name);
  if (!robot) {
    const std::size_t o = object_named(geometry, name);
    if (!state.read_object(o)) return Answer::not_found(state.unknown());
    if (state.world().absent[o]) return Answer::impossible(name + " is away");
    const auto& held = state.world().attachments[o];
    if (!held) return Answer::found(volume_word(geometry.world, o, state.world().poses[o]));
    robot = held->robot;
  }
  if (!state.read_all()) return Answer::not_found(state.unknown());
  const Motion motion = motion_in(state.world(), *robot, {state.world().q[*robot]});
  return Answer::found(volume_word(geometry.world, {motion}));
}

namespace {

/// Where an object is in a state.
world::Transform pose_in_state(const Geometry& geometry, const world::WorldState& state,
                               std::size_t object) {
  const auto& held = state.attachments[object];
  if (!held) return state.poses[object];
  const world::RobotModel& robot = geometry.world.robots[held->robot];
  return robot.base * forward(robot.kinematics, state.q[held->robot])[held->link] * held->pose;
}

/// Whether a volume's motions carry the object, from this pose on.
bool is_taken_from(const Geometry& geometry, const Volume& volume, std::size_t object,
                   const world::Transform& pose) {
  for (const Motion& motion : volume.motions)
    for (const auto& [carried, held] : motion.holds) {
      if (carried != object) continue;
      const world::RobotModel& robot = geometry.world.robots[motion.robot];
      const world::Transform first =
          robot.base * forward(robot.kinematics, motion.path.front())[held.link] * held.pose;
      const kinematics::PoseError error = kinematics::difference(first, pose);
      return error.position <= kSamePose && error.rotation <= kSamePose;
    }
  return false;
}

}  // namespace

Answer volume_collides(Geometry& geometry, const Question& question) {
  const auto volume = volume_of(geometry, question.arguments[0]);
  const std::size_t o = object_named(geometry, question.arguments[1]);
  const world::Item item{world::Item::kObject, o};
  GeometricState asked(geometry, question.state);
  if (!asked.read_object(o)) return Answer::not_found(asked.unknown());
  const world::WorldState& state = asked.world();
  if (state.absent[o]) return Answer::holds(false, question.arguments[1] + " is away");
  const auto& held = state.attachments[o];
  if (is_taken_from(geometry, *volume, o, pose_in_state(geometry, state, o)))
    return Answer::holds(false, question.arguments[1] + " is carried from where it is");
  if (!held) {
    const std::string word = volume_word(geometry.world, o, state.poses[o]);
    if (word == question.arguments[0])
      return Answer::holds(false, question.arguments[1] + " is the volume");
    const auto object = volume_of(geometry, word);
    return Answer::holds(are_in_contact(geometry, *volume, *object), "they are apart");
  }
  // Of the robot that holds it, the object alone.
  Motion motion{held->robot, {state.q[held->robot]}, {{o, *held}}};
  Volume object = *volume_of(geometry, volume_word(geometry.world, {motion}));
  std::erase_if(object.shapes, [&](const Volume::Shape& shape) { return shape.item != item; });
  object.has_loose_fingers = false;  // it is fixed to their hand
  return Answer::holds(are_in_contact(geometry, *volume, object), "they are apart");
}

Answer volumes_collide(Geometry& geometry, const Question& question) {
  const auto a = volume_of(geometry, question.arguments[0]);
  const auto b = volume_of(geometry, question.arguments[1]);
  return Answer::holds(are_in_contact(geometry, *a, *b), "they are apart at all times");
}

Answer volume_inside(Geometry& geometry, const Question& question) {
  const auto volume = volume_of(geometry, question.arguments[0]);
  const std::size_t region = region_named(geometry, question.arguments[1]);
  return Answer::holds(is_inside(geometry, *volume, region), "it is not certain");
}

}  // namespace kaboum::manipulation
