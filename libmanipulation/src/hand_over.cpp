// Motions to places that are found at random: where one robot takes what another one holds, and
// anywhere.
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/grasp_family.h>

#include <Eigen/Geometry>

#include "sequence.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Places at which a thing may be handed over, and configurations to wander to, that are tried;
/// more with each attempt.
constexpr int kMeetings = 60, kWanderings = 100;
/// Ways to take a thing at such a place that are enough.
constexpr std::size_t kEnough = 4;
/// Members of a family of grasps that are tried at one such place: there are many places.
constexpr std::size_t kMembers = 8;

}  // namespace

/// One robot holds the object at q; the other one takes it there, and both go home.
bool Sequence::meet(std::size_t from, std::size_t object, std::size_t to,
                    const std::vector<double>& q, Grasps grasps) {
  world::WorldState then = state_;
  then.q[from] = q;
  if (!is_free(then)) return false;
  const world::WorldState before = state_;
  const std::vector<Motion> motions = motions_;
  state_ = then;
  Goals goals;
  const auto add_free = [&](const Goals& reaching) {
    for (const std::vector<double>& goal : reaching.configurations) {
      if (goals.configurations.size() == kEnough) return;
      world::WorldState both = then;
      both.q[to] = goal;
      if (is_free(both)) goals.configurations.push_back(goal);
    }
  };
  if (grasps == Grasps::Preferred) {
    add_free(preferred_goals(to, object).value_or(Goals{}));
  } else {
    for (const Hold& hold : holds(to, object, kMembers)) {
      if (goals.configurations.size() == kEnough) break;
      Goals reaching;
      add_goals_of(reaching, to, object, hold);
      add_free(reaching);
    }
  }
  state_ = before;
  goals.all = false;
  const std::vector<world::RobotModel>& robots = geometry_.world.robots;
  if (!goals.configurations.empty() && go(from, q) && go(to, goals) && take(to, object) &&
      go(from, robots[from].home) && go(to, robots[to].home))
    return true;
  state_ = before;
  motions_ = motions;
  return false;
}

/// Tries places at random. @return whether it was done at one.
bool Sequence::meet_somewhere(std::size_t from, std::size_t object, std::size_t to, Grasps grasps) {
  const std::vector<world::RobotModel>& robots = geometry_.world.robots;
  const world::Attachment held = *held_by(from, object);
  const geom::Vec3 middle = 0.5 * (robots[from].base.translation + robots[to].base.translation);
  const double apart = (robots[from].base.translation - robots[to].base.translation).norm();
  const int tries = kMeetings * static_cast<int>(question_.attempt + 1);
  for (int i = 0; i < tries; ++i) {
    const auto share = [&](double low, double high) { return apart * random_.between(low, high); };
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1),
                           random_.between(-1, 1))
            .normalized();
    const geom::Vec3 offset(share(-0.25, 0.25), share(-0.25, 0.25), share(0.1, 0.6));
    Transform pose{turn.toRotationMatrix(), middle + offset};
    // Objects that stay upright are turned about the vertical alone.
    const world::Object& thing = geometry_.world.objects[object];
    if (thing.upright)
      pose.linear = robot::rotation_about(geom::Vec3::UnitZ(), 2 * std::atan2(turn.z(), turn.w())) *
                    thing.pose.linear;
    Goals goals;
    add_goals(goals, from, held.link, pose * inverse(held.pose));
    for (const std::vector<double>& q : goals.configurations)
      if (meet(from, object, to, q, grasps)) return true;
  }
  return false;
}

bool Sequence::hand_over(std::size_t from, std::size_t object, std::size_t to) {
  const std::vector<world::RobotModel>& robots = geometry_.world.robots;
  const std::string& name = geometry_.world.objects[object].name;
  if (!held_by(from, object))
    return fail(Answer::Kind::Impossible, robots[from].name + " does not hold " + name);
  if (!held_by(from, object)->fingers.empty())
    return fail(Answer::Kind::NotFound,
                name + " is held by a gripper with joints, which hands nothing over");
  if (from == to) return fail(Answer::Kind::Impossible, "a robot hands nothing to itself");
  preferred_goals(to, object);  // says among how many grasps it chooses
  if ((question_.choice > 0 && meet_somewhere(from, object, to, Grasps::Preferred)) ||
      meet_somewhere(from, object, to, Grasps::All)) {
    chosen_ = true;
    return true;
  }
  return fail(Answer::Kind::NotFound, "no place was found at which " + robots[to].name + " takes " +
                                          name + " from " + robots[from].name);
}

bool Sequence::wander(std::size_t robot) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const int tries = kWanderings * static_cast<int>(question_.attempt + 1);
  for (int i = 0; i < tries; ++i) {
    std::vector<double> q;
    for (const robot::Variable& v : model.kinematics.variables)
      q.push_back(random_.between(v.lower.value_or(-3), v.upper.value_or(3)));
    q = with_fingers(robot, configuration_of(manipulation::word_of(q), model));
    world::WorldState then = state_;
    then.q[robot] = q;
    if (is_free(then) && go(robot, q)) {
      chosen_ = true;
      return true;
    }
  }
  return fail(Answer::Kind::NotFound, "no configuration to move to was found");
}

}  // namespace kaboum::manipulation
