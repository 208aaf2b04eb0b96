// Motions to where constraints of a scene are met: of a robot with what it holds, and of what it
// holds onto another thing.
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/motion/goals.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/features.h>

#include <algorithm>
#include <array>
#include <limits>

#include "sequence.h"

namespace kaboum::manipulation {
namespace {

using plan::Answer;
using world::Transform;

/// Configurations that meet constraints, of which one is gone to; more with each attempt.
constexpr std::size_t kSatisfying = 16;
/// Between two waypoints of a line along which something is mounted. [m]
constexpr double kMateStep = 0.01;
/// Directions whose sine is smaller are the same.
constexpr double kSameDirection = 1e-3;

/// The directions along which a mate leaves a thing free to come: of axes that coincide, and the
/// normals of what is flat. In the frame of the second thing of the mate.
std::vector<geom::Vec3> approaches(const world::ConstraintSet& set, std::size_t onto) {
  using Kind = world::Feature::Kind;
  std::vector<geom::Vec3> out;
  for (const world::ToleratedConstraint& c : set.constraints) {
    const bool first = c.first.index == onto;
    const world::Feature &below = (first ? c.first : c.second).feature,
                         &thing = (first ? c.second : c.first).feature;
    const bool lengths = c.relation == kinematics::Relation::Coincident ||
                         c.relation == kinematics::Relation::Distance;
    const bool axes = thing.kind == Kind::Line && below.kind == Kind::Line;
    const bool flat = below.kind == Kind::Plane || below.kind == Kind::Surface;
    if (!lengths || !(axes || flat)) continue;
    if (std::ranges::all_of(out, [&](const geom::Vec3& d) {
          return d.cross(below.direction).norm() > kSameDirection;
        }))
      out.push_back(below.direction);
  }
  return out;
}

/// The least and the largest of a set along a direction.
std::array<double, 2> extent(const world::BoundingSet& set, const Transform& pose,
                             const geom::Vec3& direction) {
  std::array<double, 2> out{std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < set.size(); ++i)
    for (const geom::Vec3& v : set.body(i).core.vertices) {
      const double along = direction.dot(pose * v), r = set.body(i).radius;
      out = {std::min(out[0], along - r), std::max(out[1], along + r)};
    }
  return out;
}

}  // namespace

bool Sequence::mate(std::size_t robot, std::size_t object, std::size_t onto,
                    const world::ConstraintSet& set) {
  const world::World& world = geometry_.world;
  const std::string &name = world.objects[object].name, &below = world.objects[onto].name;
  if (!held_by(robot, object))
    return fail(Answer::Kind::Impossible, world.robots[robot].name + " does not hold " + name);
  if (onto == object || state_.absent[onto] || held_by(robot, onto))
    return fail(Answer::Kind::Impossible, below + " is not there to mount on");
  const auto reach = [&](const Goals& goals) {
    return slide_onto(robot, object, onto, set, goals) || go(robot, goals);
  };
  if (!satisfy(robot, set, reach)) return false;
  const world::Attachment held = *held_by(robot, object);
  target_ = Target{object, pose_of_link(robot, held.link) * held.pose, onto, held.link, 0};
  return true;
}

bool Sequence::slide_onto(std::size_t robot, std::size_t object, std::size_t onto,
                          const world::ConstraintSet& set, const Goals& goals) {
  const world::World& world = geometry_.world;
  const world::RobotModel& model = world.robots[robot];
  const world::BoundingSet &thing = world.objects[object].outer, &below = world.objects[onto].outer;
  const world::Attachment held = *held_by(robot, object);
  const Transform at = pose_of_object(onto);
  for (const std::vector<double>& goal : goals.configurations) {
    if (!is_free_at(robot, goal)) continue;
    const Transform link = model.base * forward(model.kinematics, goal)[held.link];
    for (const geom::Vec3& axis : approaches(set, onto))
      for (const double sense : {1.0, -1.0}) {
        const geom::Vec3 away = sense * (at.linear * axis).normalized();
        const double depth = extent(below, at, away)[1] - extent(thing, link * held.pose, away)[0] +
                             geometry_.options.clearance;
        if (!(depth > 0)) continue;
        const auto line = follow_line(model, held.link, goal,
                                      {link.linear, link.translation + depth * away}, kMateStep);
        if (!line) continue;
        robot::Path in(line->rbegin(), line->rend());
        in.front() =
            with_fingers(robot, configuration_of(manipulation::word_of(in.front()), model));
        if (!is_free_at(robot, in.front()) || !may_follow(robot, in)) continue;
        Goals before;
        before.configurations = {in.front()};
        before.all = false;
        if (!go(robot, before)) continue;
        record(robot, in);
        return true;
      }
  }
  return false;
}

bool Sequence::satisfy(std::size_t robot, const world::ConstraintSet& set,
                       const std::function<bool(const Goals&)>& reach) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  if (!motion::is_of_motion(geometry_.world, state_, robot, set))
    return fail(Answer::Kind::Impossible, "'" + set.name + "' is not between what moves with " +
                                              model.name + " now and what stays");
  if (const auto far = find_beyond_reach(robot, set))
    return fail(Answer::Kind::Impossible, model.name + " does not reach so far as '" + set.name +
                                              "' asks: " + describe(set.constraints[*far]));
  fail(Answer::Kind::NotFound, "no configuration was found that meets '" + set.name + "'");
  for (std::size_t count = set.preferred.size() + 1; count > 0; --count) {
    const Goals goals = goals_that_meet(
        robot, motion::path_constraints(geometry_.world, state_, robot, set, count - 1));
    if (goals.configurations.empty()) continue;
    choices_ =
        std::max(choices_, static_cast<unsigned>(std::min(kChoices, goals.configurations.size())));
    Goals preferred{{}, false};
    if (question_.choice > 0)
      preferred.configurations = {
          goals.configurations[spread(question_.choice, goals.configurations.size())]};
    if (!(question_.choice > 0 && reach(preferred)) && !reach(goals)) continue;
    chosen_ = true;
    return true;
  }
  return false;
}

Goals Sequence::goals_that_meet(std::size_t robot,
                                const std::vector<motion::PathConstraint>& constraints) const {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const std::uint32_t link = constraints.front().link;
  const motion::Goals drawn = motion::constraint_goals(
      model, {model.kinematics.links[link].name, link, {}}, constraints, state_.q[robot],
      question_.seed + question_.attempt, kSatisfying * (question_.attempt + 1));
  Goals goals;
  goals.all = false;
  for (const std::vector<double>& q : drawn.configurations) {
    std::vector<double> word =
        with_fingers(robot, configuration_of(manipulation::word_of(q), model));
    if (!find_out_of_limits(model.kinematics, word) &&
        motion::check_constraints(model, {word}, constraints).outcome ==
            motion::ConstraintAnswer::Outcome::Kept)
      goals.configurations.push_back(std::move(word));
  }
  return goals;
}

/// The first constraint that is farther away than the robot reaches, by its number.
std::optional<std::size_t> Sequence::find_beyond_reach(std::size_t robot,
                                                       const world::ConstraintSet& set) const {
  for (std::size_t i = 0; i < set.constraints.size(); ++i) {
    world::ToleratedConstraint c = set.constraints[i];
    c.first = at_state(geometry_.world, state_, c.first);
    c.second = at_state(geometry_.world, state_, c.second);
    if (c.second.to == world::FixedFeature::To::Link && c.second.index == robot)
      std::swap(c.first, c.second);
    if (c.second.to == world::FixedFeature::To::World &&
        world::is_beyond_reach(geometry_.world.robots[robot], c))
      return i;
  }
  return std::nullopt;
}

}  // namespace kaboum::manipulation
