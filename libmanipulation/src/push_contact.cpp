// Straight pushes, quasi-static: where a link touches an object, and how far that may be pushed.
#include "push_contact.h"

#include <kaboum/kinematics/arm.h>
#include <kaboum/robot/kinematics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "standing.h"

namespace kaboum::manipulation {
namespace {

using geom::Vec3;
using kinematics::inverse;
using world::Transform;

/// The centre of mass is at least so far inside the edges of what it is above. [m]
constexpr double kBalance = 0.01;
/// Contact reaches at least so far, and both ε, to both sides of the line of the push. [m]
constexpr double kHalfContact = 3e-3;
/// How far beyond its gap an object may be above what it stands on. [m]
constexpr double kAbove = 1e-3;
/// How far from upright a plane may be that is pushed. [1]
constexpr double kUpright = 1e-4;
/// So much nearer than allowed, that the rounding of words leaves what was pushed where it may be
/// pushed again. [m]
constexpr double kRounded = 1e-5;
/// Halvings of a length.
constexpr int kHalvings = 40;

const world::Feature* find_point(const world::Object& object, const char* name) {
  for (const world::Feature& f : object.features)
    if (f.kind == world::Feature::Kind::Point && f.name == name) return &f;
  return nullptr;
}

/// What of a body is at a plane, seen along its normal: `across` and `up` are the coordinates.
geom::Polygon2 outline_at(const geom::ConvexBody& body, const Transform& pose, const Vec3& on,
                          const Vec3& normal, double depth, const Vec3& across) {
  std::vector<geom::Vec2> points;
  for (const Vec3& v : body.core.vertices) {
    const Vec3 p = pose * v;
    if (normal.dot(p - on) >= -(depth + body.radius)) points.emplace_back(across.dot(p), p.z());
  }
  return geom::convex_hull(std::move(points));
}

/// How far contact reaches to both sides of a line, seen from above.
struct Reach {
  double least = 0, most = 0;
};

Reach reach_of(const world::BoundingSet& front, const Transform& front_pose, const Vec3& front_on,
               const world::BoundingSet& side, const Transform& side_pose, const Vec3& side_on,
               const Vec3& normal, const Vec3& center) {
  const Vec3 across = Vec3::UnitZ().cross(normal);
  Reach out;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const geom::Polygon2 a =
        outline_at(front.body(i), front_pose, front_on, -normal, front.epsilon() + kFlat, across);
    if (a.size() < 3) continue;
    for (std::size_t j = 0; j < side.size(); ++j) {
      const geom::Polygon2 b =
          outline_at(side.body(j), side_pose, side_on, normal, side.epsilon() + kFlat, across);
      for (const geom::Vec2& p : geom::common_part(a, b)) {
        out.least = std::min(out.least, p.x() - across.dot(center));
        out.most = std::max(out.most, p.x() - across.dot(center));
      }
    }
  }
  return out;
}

/// Axes of which the third is `along`, and the first as near to `first` as may be.
Eigen::Matrix3d axes_of(const Vec3& along, const Vec3& first) {
  Eigen::Matrix3d out;
  out.col(2) = along;
  out.col(0) = (first - first.dot(along) * along).normalized();
  out.col(1) = along.cross(out.col(0));
  return out;
}

/// Where the tool at a link looks, or some direction across the plane's normal.
Vec3 look_of(const world::RobotModel& robot, std::uint32_t link, const Vec3& normal) {
  constexpr double kAcross = 0.1;  // sine of the angle
  for (const world::ToolFrame& tool : robot.tools)
    if (tool.link == link && tool.pose.linear.col(2).cross(normal).norm() > kAcross)
      return tool.pose.linear.col(2);
  return normal.unitOrthogonal();
}

}  // namespace

bool is_for_pushing(const world::Feature& feature) {
  return feature.kind == world::Feature::Kind::Plane && feature.name.starts_with("push");
}

PushedObject::PushedObject(const world::Object& object, const Transform& at,
                           const world::Object& support, const Transform& below, double clearance)
    : support_(support), to_support_(inverse(below)) {
  const Vec3 bottom =
      feature_named(object, "bottom", world::Feature::Kind::Point, "pushing it").point;
  const world::Feature* mass = find_point(object, "mass");
  balanced_ = mass != nullptr;
  center_ = at * (balanced_ ? mass->point : bottom);
  const double own = object.outer.epsilon(), epsilon = own + support.outer.epsilon();
  const std::string stand = object.name + " does not stand ";
  if (!is_level(below.linear)) {
    refusal_ = support.name + " is not level";
    return;
  }
  double radius = 0;
  for (const Vec3& v : base_of(object, at.linear, bottom, epsilon + kFlat)) {
    if (v.z() < -(own + kFlat)) refusal_ = stand + "on its point 'bottom'";
    base_.push_back(at * bottom + v);
    radius = std::max(radius, (base_.back() - center_).norm());
  }
  if (!refusal_.empty()) return;
  const geom::Polygon2 foot = foot_of(object, at.linear, bottom);
  if (!bridges_slots(foot, object, support)) {
    refusal_ = object.name + " has a base too narrow to be pushed on " + support.name;
    return;
  }
  const double turning = 2 * kOffTurn * radius;
  slack_ = std::numbers::sqrt2 * kOffLine + turning;
  if (balanced_ &&
      !geom::holds(foot, (center_ - at * bottom).head<2>(), kBalance + own + turning)) {
    refusal_ = object.name + " has its point 'mass' too near the edge of its base";
    return;
  }
  const double height = (to_support_ * (at * bottom)).z();
  for (std::size_t i = 0; i < support.outer.size(); ++i) {
    const double above = height - UpperFace(support.outer.body(i), 0).height();
    if (above < -epsilon || above > clearance + epsilon + kAbove) continue;
    faces_.push_back(i);
  }
  std::erase_if(faces_, [&](std::size_t face) { return !stands(face, Vec3::Zero()); });
  if (faces_.empty())
    refusal_ = stand +
               (balanced_ ? "with its centre of mass well above " : "with all its base on ") +
               support.name;
}

/// The shifts for which that is true make a convex set.
bool PushedObject::stands(std::size_t face, const Vec3& shift) const {
  const double inside = support_.outer.epsilon() + slack_;
  const UpperFace top(support_.outer.body(face), inside + (balanced_ ? kBalance : 0));
  if (balanced_) return top.holds(to_support_ * (center_ + shift));
  return std::ranges::all_of(base_,
                             [&](const Vec3& v) { return top.holds(to_support_ * (v + shift)); });
}

double PushedObject::farthest(const Vec3& direction) const {
  double out = 0;
  for (const std::size_t face : faces_) {
    double low = 0, high = UpperFace(support_.outer.body(face), 0).extent();
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (stands(face, middle * direction) ? low : high) = middle;
    }
    out = std::max(out, low - kRounded);
  }
  return out;
}

std::optional<Vec3> push_direction(const Transform& at, const world::Feature& side,
                                   const Vec3& center) {
  const Vec3 normal = at.linear * side.direction;
  if (std::abs(normal.z()) > kUpright) return std::nullopt;
  const Vec3 direction = -Vec3(normal.x(), normal.y(), 0).normalized();
  if (direction.dot(center - at * side.point) <= 0) return std::nullopt;
  return direction;
}

std::optional<PushContact> push_contact(const world::RobotModel& robot,
                                        const world::LinkFeature& front,
                                        const world::Object& object, const Transform& at,
                                        const world::Feature& side, const Vec3& direction,
                                        const Vec3& center, double turn, double clearance) {
  PushContact out{front.link, {}, direction};
  const Vec3& own = front.feature.direction;
  out.link_pose.linear = robot::rotation_about(direction, turn) *
                         axes_of(direction, -Vec3::UnitZ()) *
                         axes_of(own, look_of(robot, front.link, own)).transpose();
  const Vec3 touched = at * side.point;
  bool wide = false;
  for (const world::LinkShape& shape : robot.shapes) {
    if (shape.link != front.link) continue;
    const double epsilon = object.outer.epsilon() + shape.outer.epsilon(),
                 gap = clearance + epsilon, least = kHalfContact + epsilon;
    const Vec3 before = touched - gap * direction;
    out.link_pose.translation = before - out.link_pose.linear * front.feature.point;
    const Reach reach =
        reach_of(shape.outer, out.link_pose, before, object.outer, at, touched, -direction, center);
    wide = reach.least <= -least && reach.most >= least;
  }
  if (!wide) return std::nullopt;
  return out;
}

std::vector<motion::PathConstraint> push_constraints(const world::Attachment& held,
                                                     const Transform& object, const Vec3& center,
                                                     const Vec3& direction, double length) {
  using kinematics::Relation;
  const Vec3 own = held.pose * (inverse(object) * center);
  const auto in_link = [&](const Vec3& v) -> Vec3 {
    return (held.pose.linear * (object.linear.transpose() * v)).normalized();
  };
  const auto keeps = [&](const char* name, Relation relation, const kinematics::Feature& moving,
                         const kinematics::Feature& resting, double within) {
    return motion::PathConstraint{name, relation, held.link, moving, resting, 0, within, kOffTurn};
  };
  return {keeps("on its line", Relation::Coincident, kinematics::Point{own},
                kinematics::Line{center, direction}, kOffLine),
          keeps("between the line's ends", Relation::Coincident, kinematics::Point{own},
                kinematics::Point{center + 0.5 * length * direction}, 0.5 * length + kOffLine),
          keeps("level", Relation::Angle, kinematics::Line{own, in_link(Vec3::UnitZ())},
                kinematics::Line{center, Vec3::UnitZ()}, kOffLine),
          keeps("not turned", Relation::Angle, kinematics::Line{own, in_link(direction)},
                kinematics::Line{center, direction}, kOffLine)};
}

}  // namespace kaboum::manipulation
