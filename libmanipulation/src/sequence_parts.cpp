// Motions of an action: putting down, mounting, lifting.
#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "sequence.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Between two waypoints of a straight line, and of one on which something is kept upright. [m]
constexpr double kStep = 0.01, kUprightStep = 0.02;
/// How far things are lifted before they are carried upright. [m]
constexpr std::array<double, 6> kHeights{0.03, 0.08, 0.15, 0.25, 0.35, 0.5};

/// "seat/pipe" where there is one, else "seat".
std::string for_part(const world::Object& below, const std::string& name,
                     const world::Object& part) {
  std::string special = name + "/" + part.name;
  for (const world::Feature& feature : below.features)
    if (feature.name == special) return special;
  return name;
}

const world::Feature& feature_named(const world::Object& object, const std::string& name,
                                    world::Feature::Kind kind, const char* needs) {
  for (const world::Feature& feature : object.features)
    if (feature.name == name && feature.kind == kind) return feature;
  throw Error(ErrorCode::InvalidInput,
              "object '" + object.name + "' of the scene has no " +
                  (kind == world::Feature::Kind::Point ? "point" : "plane") + " '" + name +
                  "' among its features, which " + needs + " needs");
}

Transform turned(const geom::Vec3& axis, double angle) {
  return {robot::rotation_about(axis, angle), geom::Vec3::Zero()};
}

Transform shifted(Transform pose, const geom::Vec3& by) {
  pose.translation += by;
  return pose;
}

/// Leaves out waypoints between which the path is good as well.
template <typename Good>
robot::Path thinned(robot::Path path, const Good& good) {
  for (std::size_t at = 0; at + 2 < path.size(); ++at) {
    std::size_t step = path.size() - 1 - at;
    while (step > 1 && !good({path[at], path[at + step]})) step /= 2;
    path.erase(path.begin() + static_cast<std::ptrdiff_t>(at) + 1,
               path.begin() + static_cast<std::ptrdiff_t>(at + step));
  }
  return path;
}

}  // namespace

bool Sequence::go_upright(std::size_t robot, std::size_t object, const world::Attachment& held,
                          const Goals& goals, const Transform& link_pose) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const geom::Vec3 up =
      held.pose.linear *
      (geometry_.world.objects[object].pose.linear.transpose() * geom::Vec3::UnitZ());
  const Upright upright{held.link, up, geometry_.options.upright};
  const auto good = [&](const robot::Path& path) {
    return stays_upright(model, path, upright) && is_free(robot, path);
  };
  if (!stays_upright(model, {state_.q[robot], state_.q[robot]}, upright))
    return fail(Answer::Kind::Impossible,
                geometry_.world.objects[object].name + " is not upright where it is");
  for (const std::vector<double>& goal : goals.configurations) {
    const robot::Path path{state_.q[robot], goal};
    if (!good(path)) continue;
    record(robot, path);
    return true;
  }
  // Up, across and down.
  for (const double height : kHeights) {
    const geom::Vec3 by = height * geom::Vec3::UnitZ();
    robot::Path path{state_.q[robot]};
    bool whole = true;
    for (const Transform& to :
         {shifted(pose_of_link(robot, held.link), by), shifted(link_pose, by), link_pose}) {
      const auto line = follow_line(model, held.link, path.back(), to, kUprightStep);
      whole = line.has_value();
      if (!whole) break;
      path.insert(path.end(), line->begin() + 1, line->end());
    }
    if (!whole) continue;
    path.back() = configuration_of(manipulation::word_of(path.back()), model);
    if (!good(path)) continue;
    record(robot, thinned(std::move(path), good));
    return true;
  }
  return fail(Answer::Kind::NotFound, "no path on which " + geometry_.world.objects[object].name +
                                          " stays upright was found");
}

bool Sequence::place(std::size_t robot, std::size_t object, std::size_t support, bool upright) {
  const world::World& world = geometry_.world;
  const world::Object &thing = world.objects[object], &below = world.objects[support];
  const auto held = held_by(robot, object);
  if (!held)
    return fail(Answer::Kind::Impossible,
                world.robots[robot].name + " does not hold " + thing.name);
  if (support == object || state_.absent[support])
    return fail(Answer::Kind::Impossible, below.name + " is not there to stand on");
  using Kind = world::Feature::Kind;
  feature_named(below, "top", Kind::Point, "putting something on it");
  const double gap = geometry_.options.clearance + thing.outer.epsilon() + below.outer.epsilon();
  const geom::Vec3 bottom = feature_named(thing, "bottom", Kind::Point, "putting it down").point;
  // One after the other: an object that is put to the same place again is likely to be in the same
  // state again.
  fail(Answer::Kind::NotFound, "nothing was found to be in reach");
  const std::vector<double> angles = turns();
  std::size_t points = 0;
  for (const world::Feature& feature : below.features) {
    if (feature.kind != Kind::Point || !feature.name.starts_with("top")) continue;
    ++points;
    const geom::Vec3 top = pose_of_object(support) * feature.point + gap * geom::Vec3::UnitZ();
    for (const double angle : angles) {
      Transform pose = turned(geom::Vec3::UnitZ(), angle);
      pose.linear = pose.linear * thing.pose.linear;
      pose.translation = top - pose.linear * bottom;
      const Transform link = pose * inverse(held->pose);
      Goals goals;
      add_goals(goals, robot, held->link, link);
      goals.all = false;  // there are other turns
      if (goals.configurations.empty()) continue;
      if (!(upright ? go_upright(robot, object, *held, goals, link) : go(robot, goals))) continue;
      target_ = Target{object, pose, std::nullopt, held->link, 0};
      chosen_ = true;
      return true;
    }
  }
  if (failed_ == Answer::Kind::NotFound)
    reason_ = name_with_grasp(object, *held) + " on " + below.name + ": " + std::to_string(points) +
              (points == 1 ? " point 'top…'" : " points 'top…'") + " of the scene and " +
              std::to_string(angles.size()) + " turns were tried; the last: " + reason_;
  return false;
}

bool Sequence::mount(std::size_t robot, std::size_t object, std::size_t onto) {
  const world::World& world = geometry_.world;
  const world::RobotModel& model = world.robots[robot];
  const world::Object &thing = world.objects[object], &below = world.objects[onto];
  const auto held = held_by(robot, object);
  if (!held) return fail(Answer::Kind::Impossible, model.name + " does not hold " + thing.name);
  if (onto == object || state_.absent[onto] || held_by(robot, onto))
    return fail(Answer::Kind::Impossible, below.name + " is not there to mount on");
  using Kind = world::Feature::Kind;
  const world::Feature &seat = feature_named(below, for_part(below, "seat", thing), Kind::Plane,
                                             "mounting on it"),
                       &face = feature_named(thing, "mount", Kind::Plane, "mounting it"),
                       &entry = feature_named(below, for_part(below, "entry", thing), Kind::Point,
                                              "mounting on it");
  const Transform at = pose_of_object(onto);
  const geom::Vec3 normal = (at.linear * seat.direction).normalized();
  const double depth = (at.linear * (entry.point - seat.point)).dot(normal);
  if (!(depth > 0))
    throw Error(
        ErrorCode::InvalidInput,
        "object '" + below.name + "' of the scene: the point 'entry' is not above the seat");
  const geom::Vec3 place =
      at * seat.point +
      normal * (geometry_.options.clearance + thing.outer.epsilon() + below.outer.epsilon());
  const Eigen::Matrix3d facing =
      Eigen::Quaterniond::FromTwoVectors(thing.pose.linear * face.direction, -normal)
          .toRotationMatrix() *
      thing.pose.linear;
  fail(Answer::Kind::NotFound, thing.name + " on " + below.name + " is out of reach");
  for (const double angle : turns()) {
    Transform pose = turned(normal, angle);
    pose.linear = pose.linear * facing;
    pose.translation = place - pose.linear * face.point;
    const Transform link = pose * inverse(held->pose), before = shifted(link, depth * normal);
    Goals goals;
    add_goals(goals, robot, held->link, before);
    for (const std::vector<double>& goal : goals.configurations) {
      if (!is_free_at(robot, goal)) {
        fail(Answer::Kind::NotFound, "no room to slide " + thing.name + " into " + below.name);
        continue;
      }
      auto line = follow_line(model, held->link, goal, link, kStep);
      if (!line) continue;
      line->back() = configuration_of(manipulation::word_of(line->back()), model);
      if (!is_free_at(robot, line->back()) || !is_free(robot, *line)) {
        fail(Answer::Kind::NotFound, thing.name + " does not slide into " + below.name);
        continue;
      }
      Goals one;
      one.configurations = {goal};
      one.all = false;
      if (!go(robot, one)) continue;
      record(robot, *line);
      target_ = Target{object, pose, onto, held->link, depth};
      chosen_ = true;
      return true;
    }
  }
  return false;
}

bool Sequence::withdraw(std::size_t robot) {
  ensure(target_.has_value(), "the tool withdraws from what was mounted");
  const world::RobotModel& model = geometry_.world.robots[robot];
  const Transform link = pose_of_link(robot, target_->link);
  const world::ToolFrame& tool =
      *std::ranges::find(model.tools, target_->link, &world::ToolFrame::link);
  const geom::Vec3 back = -(link.linear * tool.pose.linear.col(2));
  auto line = follow_line(model, target_->link, state_.q[robot],
                          shifted(link, target_->depth * back), kStep);
  if (line) {
    line->back() = configuration_of(manipulation::word_of(line->back()), model);
    if (is_free(robot, *line)) {
      record(robot, *line);
      return true;
    }
  }
  return fail(Answer::Kind::NotFound, "the tool does not withdraw from what was mounted");
}

bool Sequence::lift(std::size_t robot, std::size_t object, double height) {
  const world::RobotModel& model = geometry_.world.robots[robot];
  const auto held = held_by(robot, object);
  const std::string& name = geometry_.world.objects[object].name;
  if (!held) return fail(Answer::Kind::Impossible, model.name + " does not hold " + name);
  const Transform to = shifted(pose_of_link(robot, held->link), height * geom::Vec3::UnitZ());
  auto line = follow_line(model, held->link, state_.q[robot], to, kUprightStep);
  if (!line) return fail(Answer::Kind::NotFound, name + " cannot be lifted straight");
  line->back() = configuration_of(manipulation::word_of(line->back()), model);
  if (!is_free(robot, *line))
    return fail(Answer::Kind::NotFound, name + " is not free to be lifted");
  record(robot, thinned(std::move(*line), [&](const robot::Path& p) { return is_free(robot, p); }));
  chosen_ = true;
  return true;
}

}  // namespace kaboum::manipulation
