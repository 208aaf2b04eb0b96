// Contacts of an object with the hand that holds it: at a pose, and at all members of a family.

#include "hand.h"

#include <kaboum/robot/kinematics.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/margins.h>

#include <algorithm>
#include <cmath>

namespace kaboum::scene {
namespace {

using geom::Transform;
using geom::Vec3;

/// More than products of lengths lose.
constexpr double kUp = 1 + 1e-9;
/// Share of the object's size: parts of a family in which nothing moves farther are not divided.
constexpr double kSmallest = 1e-4;
/// Share of the lengths that placing points loses by far.
constexpr double kRounding = 1e-12;
/// Half of the largest turn whose arcs are held by their chords. [rad]
constexpr double kMostHalf = 1;

/// What moves with a link: the links fixed to it, and all that they carry.
/// @param only_fixed  without what joints move
std::vector<bool> moving_with(const robot::Robot& robot, std::uint32_t link, bool only_fixed) {
  const auto is_fixed = [&](std::size_t joint) {
    return robot.joints[joint].type == robot::JointType::Fixed;
  };
  while (link > 0 && is_fixed(link - 1)) link = robot.joints[link - 1].parent;
  std::vector<bool> out(robot.links.size(), false);
  out[link] = true;
  for (std::size_t i = link; i < robot.joints.size(); ++i)
    out[i + 1] = out[i + 1] || (out[robot.joints[i].parent] && (!only_fixed || is_fixed(i)));
  return out;
}

}  // namespace

std::vector<bool> links_of_hand(const world::RobotModel& robot, const world::ToolFrame& tool) {
  return moving_with(robot.kinematics, tool.link, false);
}

double epsilon_at(const world::RobotModel& robot, std::uint32_t link) {
  const std::vector<bool> fixed = moving_with(robot.kinematics, link, true);
  double out = 0;
  for (const world::LinkShape& shape : robot.shapes)
    if (fixed[shape.link]) out = std::max(out, shape.outer.epsilon());
  return out;
}

Hand::Hand(const world::World& world, std::size_t object, std::size_t robot,
           const world::ToolFrame& tool)
    : world_(world),
      object_(object),
      robot_(robot),
      checker_(world),
      state_(initial_state(world)),
      hand_(links_of_hand(world.robots[robot], tool)) {
  state_.absent.assign(world.objects.size(), true);
  state_.absent[object] = false;
  state_.absent_robots.assign(world.robots.size(), true);
  state_.absent_robots[robot] = false;
  for (auto& attachment : state_.attachments) attachment.reset();
  const world::RobotModel& model = world.robots[robot];
  tool_ = model.base * robot::forward(model.kinematics, model.home)[tool.link] * tool.pose;
  std::vector<world::Item> items;
  for (std::size_t s = 0; s < model.shapes.size(); ++s)
    if (hand_[model.shapes[s].link] && !is_allowed(s)) items.push_back({robot, s});
  parts_.reserve(items.size());
  for (const world::Checker::PosedItem& one : checker_.places(state_, items, scratch_))
    parts_.push_back(
        {one.place, margin_between(world, state_, {world::Item::kObject, object}, one.item)});
  const collide::BoundingSet& set = world.objects[object].outer;
  balls_.reserve(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const collide::Polytope& body = set.polytope(i);
    collide::BoundingSet::Ball ball{body.center(), 0};
    for (std::uint32_t k = 0; k < body.size(); ++k)
      ball.radius = std::max(ball.radius, (body.point(k) - ball.center).norm() * kUp);
    balls_.push_back(ball);
  }
}

std::optional<std::string> Hand::contact_at(const Transform& grasp) {
  state_.poses[object_] = tool_ * grasp;
  for (const world::Contact& contact :
       checker_.find_contacts(state_, scratch_, world::Checker::Options{})) {
    for (const auto& [a, b] : {std::pair(contact.items[0], contact.items[1]),
                               std::pair(contact.items[1], contact.items[0])}) {
      if (a != world::Item{world::Item::kObject, object_} || b.robot != robot_) continue;
      if (hand_[world_.robots[robot_].shapes[b.index].link]) return world_.name_of(b);
    }
  }
  return std::nullopt;
}

bool Hand::is_free(const world::Grasp& grasp, const MemberBox& box, std::size_t most) {
  std::size_t left = most;
  return is_free_within(grasp, box, left);
}

// Seen from the hand, a point x of the object is at T^-1 (x - s) for slides s and a turn T. For one
// turn, all slides of the box have it in the parallelogram between those of its corners. For one s
// it goes along an arc, which is nowhere farther from its chord than (1 - cos(half the angle))
// times its distance from the axis. So all of it stays within that of the hull of the places that
// it has at the box's corners.
bool Hand::may_meet(const world::Grasp& grasp, const MemberBox& box) {
  const collide::BoundingSet& set = world_.objects[object_].outer;
  std::vector<std::vector<double>> corners{{}};
  for (const Range& range : box) {
    const std::size_t n = corners.size();
    for (std::size_t c = 0; c < n; ++c) {
      if (range.from < range.to) {
        corners.push_back(corners[c]);
        corners.back().push_back(range.to);
      }
      corners[c].push_back(range.from);
    }
  }
  std::vector<Transform> places;
  places.reserve(corners.size());
  double farthest = set.ball().center.norm() + set.ball().radius;
  for (const std::vector<double>& values : corners) {
    places.push_back(tool_ * world::member_of(grasp, values));
    farthest = std::max(farthest, places.back().translation.norm());
  }
  double bulge = kRounding * farthest;
  if (grasp.turn) {
    const double half = 0.5 * (box.back().to - box.back().from) * kUp;
    if (half > kMostHalf) return true;
    bulge += (1 - std::cos(half)) * reach_of(grasp, box) * kUp;
  }
  const Transform here;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const collide::Polytope& body = set.polytope(i);
    geom::Box3 centers;
    for (const Transform& place : places) centers.extend(place * balls_[i].center);
    std::vector<Vec3> points;
    std::optional<collide::Polytope> swept;
    for (const Part& part : parts_) {
      const double near = (bulge + set.body(i).radius + part.place.error() + part.margin) * kUp;
      // The boxes of the hand have its radii and errors.
      const auto is_beside = [&](const geom::Box3& other) {
        const double reach = near + balls_[i].radius;
        return ((other.min - centers.max).array() > reach).any() ||
               ((centers.min - other.max).array() > reach).any();
      };
      if (is_beside(part.place.box())) continue;
      for (std::size_t j = 0; j < part.place.set().size(); ++j) {
        if (is_beside(part.place.box(j))) continue;
        if (!swept) {
          points.reserve(places.size() * body.size());
          for (const Transform& place : places)
            for (std::uint32_t k = 0; k < body.size(); ++k)
              points.emplace_back(place * body.point(k));
          swept.emplace(points);
        }
        const double reach = (near + part.place.radius_above(j)) * kUp;
        if (collide::are_within(collide::Posed(*swept, here), part.place.body(j), reach))
          return true;
      }
    }
  }
  return false;
}

double Hand::reach_of(const world::Grasp& grasp, const MemberBox& box) const {
  const auto& ball = world_.objects[object_].outer.ball();
  Vec3 by = Vec3::Zero();
  double slid = 0;
  for (std::size_t i = 0; i < grasp.slides.size(); ++i) {
    by += (0.5 * box[i].from + 0.5 * box[i].to) * grasp.slides[i].direction;
    slid += 0.5 * (box[i].to - box[i].from);
  }
  return (ball.center - by - grasp.turn->point).cross(grasp.turn->axis).norm() + ball.radius + slid;
}

bool Hand::is_free_within(const world::Grasp& grasp, const MemberBox& box, std::size_t& left) {
  if (left == 0) return false;
  --left;
  if (!may_meet(grasp, box)) return true;
  MemberBox middle;
  middle.reserve(box.size());
  for (const Range& range : box) {
    const double at = 0.5 * range.from + 0.5 * range.to;
    middle.push_back({at, at});
  }
  if (may_meet(grasp, middle)) return false;
  // What moves it farthest is halved.
  const double size = world_.objects[object_].outer.ball().radius;
  double farthest = kSmallest * size;
  std::size_t at = box.size();
  for (std::size_t i = 0; i < box.size(); ++i) {
    double moves = 0.5 * (box[i].to - box[i].from);
    if (i == grasp.slides.size()) moves *= reach_of(grasp, box);
    if (moves <= farthest) continue;
    farthest = moves;
    at = i;
  }
  if (at == box.size()) return false;
  MemberBox half = box;
  half[at].to = middle[at].to;
  if (!is_free_within(grasp, half, left)) return false;
  half[at].from = middle[at].from;
  half[at].to = box[at].to;
  return is_free_within(grasp, half, left);
}

bool Hand::is_allowed(std::size_t shape) const {
  const world::Item object{world::Item::kObject, object_}, part{robot_, shape};
  return std::ranges::any_of(world_.allowed, [&](const auto& pair) {
    return pair == std::array{object, part} || pair == std::array{part, object};
  });
}

Hand::Unchecked Hand::unchecked() const {
  Unchecked out;
  const world::RobotModel& model = world_.robots[robot_];
  for (std::uint32_t link = 0; link < hand_.size(); ++link) {
    if (!hand_[link]) continue;
    bool looked_at = false, has_set = false;
    for (std::size_t s = 0; s < model.shapes.size(); ++s) {
      if (model.shapes[s].link != link) continue;
      has_set = true;
      looked_at = looked_at || !is_allowed(s);
    }
    if (looked_at)
      out.all = false;
    else if (has_set || !model.kinematics.links[link].collision.empty())
      out.links.push_back(model.name + "/" + model.kinematics.links[link].name);
  }
  return out;
}

}  // namespace kaboum::scene
