// Motions of an action: putting down, mounting, lifting.
#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sequence.h"
#include "standing.h"

namespace kaboum::manipulation {
namespace {

using kinematics::inverse;
using plan::Answer;
using world::Transform;

/// Between two waypoints of a line on which something slides, and of one on which it is lifted. [m]
constexpr double kStep = 0.01, kLiftStep = 0.02;
/// How far above or below a face a point may be that is meant to be on it. [m]
constexpr double kOfFace = 0.01;
/// Places on a face that are drawn, in each attempt more.
constexpr std::size_t kPlaces = 64;
/// Choices of a place beside the points 'top…', each with draws of its own.
constexpr std::size_t kChosenPlaces = 8;

/// Points of an object on which things are put.
std::vector<geom::Vec3> tops_of(const world::Object& below) {
  std::vector<geom::Vec3> out;
  for (const world::Feature& feature : below.features)
    if (feature.kind == world::Feature::Kind::Point && feature.name.starts_with("top"))
      out.push_back(feature.point);
  return out;
}

/// "seat/pipe" where there is one, else "seat".
std::string for_part(const world::Object& below, const std::string& name,
                     const world::Object& part) {
  std::string special = name + "/" + part.name;
  for (const world::Feature& feature : below.features)
    if (feature.name == special) return special;
  return name;
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

bool Sequence::place(std::size_t robot, std::size_t object, std::size_t support, bool upright) {
  const world::World& world = geometry_.world;
  const world::Object &thing = world.objects[object], &below = world.objects[support];
  const auto held = held_by(robot, object);
  if (!held)
    return fail(Answer::Kind::Impossible,
                world.robots[robot].name + " does not hold " + thing.name);
  if (support == object || state_.absent[support])
    return fail(Answer::Kind::Impossible, below.name + " is not there to stand on");
  feature_named(below, "top", world::Feature::Kind::Point, "putting something on it");
  const double gap = geometry_.options.clearance + thing.outer.epsilon() + below.outer.epsilon();
  const geom::Vec3 bottom =
      feature_named(thing, "bottom", world::Feature::Kind::Point, "putting it down").point;
  // One after the other: an object that is put to the same place again is likely to be in the same
  // state again.
  fail(Answer::Kind::NotFound, "nothing was found to be in reach");
  const std::vector<double> angles = turns();
  std::vector<motion::PathConstraint> kept;
  if (upright)
    kept.push_back(motion::upright_constraint(world, *held, object, geometry_.options.upright));
  const auto stands = [&](const geom::Vec3& point, double angle) {
    Transform pose = turned(geom::Vec3::UnitZ(), angle);
    pose.linear = pose.linear * thing.pose.linear;
    pose.translation = pose_of_object(support) * point + gap * geom::Vec3::UnitZ();
    pose.translation -= pose.linear * bottom;
    const Transform link = pose * inverse(held->pose);
    Goals goals;
    add_goals(goals, robot, held->link, link);
    goals.all = false;  // there are other turns
    if (goals.configurations.empty()) return false;
    if (!go(robot, goals, kept)) return false;
    target_ = Target{object, pose, std::nullopt, held->link, 0};
    chosen_ = true;
    return true;
  };
  const auto stands_on = [&](const geom::Vec3& top) {
    return std::ranges::any_of(angles, [&](double angle) { return stands(top, angle); });
  };
  const auto stands_at = [&](const Footing& footing) {
    return stands(footing.point, footing.angle);
  };
  std::vector<geom::Vec3> tops = tops_of(below);
  const std::vector<Footing> more = footings(object, support, tops.size());
  // Of the choices 1, 2, … the first ones prefer the points but the first, the others no point.
  const std::size_t choice = question_.choice;
  choices_ = std::max(choices_, static_cast<unsigned>(tops.size() - 1 + kChosenPlaces));
  if (choice < tops.size())
    std::rotate(tops.begin(), tops.begin() + static_cast<std::ptrdiff_t>(choice),
                tops.begin() + static_cast<std::ptrdiff_t>(choice) + 1);
  const bool points_first = choice < tops.size();
  if ((points_first && std::ranges::any_of(tops, stands_on)) ||
      std::ranges::any_of(more, stands_at) ||
      (!points_first && std::ranges::any_of(tops, stands_on)))
    return true;
  if (failed_ == Answer::Kind::NotFound)
    reason_ = name_with_grasp(object, *held) + " on " + below.name + ": " +
              std::to_string(tops.size()) +
              (tops.size() == 1 ? " point 'top…'" : " points 'top…'") + " of the scene, " +
              std::to_string(angles.size()) + " turns" +
              (more.empty() ? std::string()
                            : " and " + std::to_string(more.size()) + " other places there") +
              " were tried; the last: " + reason_;
  return false;
}

/// Places on the upper faces that the points 'top…' are on, evenly spread, on which an object
/// stands with all of its base. The first attempt tries the points alone, unless the choice is to
/// prefer none of them.
std::vector<Sequence::Footing> Sequence::footings(std::size_t object, std::size_t support,
                                                  std::size_t points) {
  const world::Object &thing = geometry_.world.objects[object],
                      &below = geometry_.world.objects[support];
  std::vector<Footing> out;
  const std::size_t draws = kPlaces * (question_.attempt + (question_.choice < points ? 0U : 1U));
  if (draws == 0) return out;
  const Eigen::Matrix3d lies = pose_of_object(support).linear;
  if (!is_level(lies)) return out;
  const geom::Vec3 bottom =
      feature_named(thing, "bottom", world::Feature::Kind::Point, "putting it down").point;
  const std::vector<geom::Vec3> tops = tops_of(below);
  const double close = thing.outer.epsilon() + below.outer.epsilon() + kFlat;
  // Its base as it stands, about the point 'bottom'.
  const std::vector<geom::Vec3> base = base_of(thing, thing.pose.linear, bottom, close);
  if (!bridges_slots(foot_of(thing, thing.pose.linear, bottom), thing, below)) return out;
  for (std::size_t i = 0; i < below.outer.size(); ++i) {
    const UpperFace face(below.outer.body(i), below.outer.epsilon());
    const bool meant = std::ranges::any_of(tops, [&](const geom::Vec3& point) {
      return face.holds(point) && std::abs(point.z() - face.height()) <= kOfFace;
    });
    if (!meant) continue;
    for (std::size_t n = 0; n < draws; ++n) {
      Footing f;
      f.point = face.at(random_.between(0, 1), random_.between(0, 1));
      f.angle = random_.between(0, 2 * std::numbers::pi);
      const Eigen::Matrix3d turn = lies.transpose() * turned(geom::Vec3::UnitZ(), f.angle).linear;
      if (std::ranges::all_of(base,
                              [&](const geom::Vec3& v) { return face.holds(f.point + turn * v); }))
        out.push_back(f);
    }
  }
  return out;
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
      line->back() =
          with_fingers(robot, configuration_of(manipulation::word_of(line->back()), model));
      if (!is_free_at(robot, line->back()) || !may_follow(robot, *line)) {
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
    line->back() =
        with_fingers(robot, configuration_of(manipulation::word_of(line->back()), model));
    if (may_follow(robot, *line)) {
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
  auto line = follow_line(model, held->link, state_.q[robot], to, kLiftStep);
  if (!line) return fail(Answer::Kind::NotFound, name + " cannot be lifted straight");
  line->back() = with_fingers(robot, configuration_of(manipulation::word_of(line->back()), model));
  if (!may_follow(robot, *line))
    return fail(Answer::Kind::NotFound, name + " is not free to be lifted");
  record(robot,
         thinned(std::move(*line), [&](const robot::Path& p) { return may_follow(robot, p); }));
  chosen_ = true;
  return true;
}

}  // namespace kaboum::manipulation
