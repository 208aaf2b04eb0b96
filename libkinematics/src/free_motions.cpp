// Motions that constraints leave free; docs/algorithms/constraint-sampling.md.
#include "free_motions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

/// A twist whose part that is independent of others is this short depends on them, but for
/// rounding; twists are 1 or longer, with lengths in parts of the problem's.
constexpr double kIndependent = 1e-6;

struct WorldAxis {
  Vec3 point, direction;
};

Transform turned(const Transform& pose, const WorldAxis& axis, double angle) {
  const Mat3 turn = robot::rotation_about(axis.direction, angle);
  return {turn * pose.linear, axis.point + turn * (pose.translation - axis.point)};
}

/// An angle, uniform among those that turn p about the axis into the ball; among all where there
/// are none.
double random_angle(const WorldAxis& axis, const Vec3& p, const ReachBall& ball, Random& random) {
  const Vec3 arm = p - axis.point, to_centre = ball.centre - axis.point;
  const double height = arm.dot(axis.direction), centre_height = to_centre.dot(axis.direction);
  const Vec3 u = arm - height * axis.direction, c = to_centre - centre_height * axis.direction;
  const double product = u.norm() * c.norm();
  const double rise = height - centre_height;
  const double excess = u.squaredNorm() + c.squaredNorm() + rise * rise - ball.radius * ball.radius;
  if (!(std::abs(excess) < 2 * product)) return random.between(-kPi, kPi);
  const double half = std::acos(excess / (2 * product));
  const double middle = std::atan2(axis.direction.dot(u.cross(c)), u.dot(c));
  return middle + random.between(-half, half);
}

/// A length, uniform among those that move p along the direction into the ball; the one that brings
/// it nearest to the centre where there are none.
double random_length(const Vec3& direction, const Vec3& p, const ReachBall& ball, Random& random) {
  const Chord c = chord(p - ball.centre, direction, ball.radius);
  return c.half > 0 ? c.middle + random.between(-c.half, c.half) : c.middle;
}

std::array<Vec3, 3> directions_of(const Feature& feature) {
  const Vec3* d = nullptr;
  if (const auto* line = std::get_if<Line>(&feature)) d = &line->direction;
  if (const auto* plane = std::get_if<Plane>(&feature)) d = &plane->normal;
  if (const auto* surface = std::get_if<Surface>(&feature)) d = &surface->normal;
  if (d == nullptr) return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const Vec3 side = d->unitOrthogonal();
  return {*d, side, d->cross(side)};
}

Vec3 position_of(const Feature& feature) {
  return std::visit([](const auto& f) { return f.position; }, feature);
}

}  // namespace

FreeMotions::FreeMotions(const std::vector<Constraint>& constraints, const FrameId& tool,
                         double length)
    : tool_(tool), length_(length) {
  for (const Constraint& c : constraints)
    if ((c.first.frame == tool) != (c.second.frame == tool)) constraints_.push_back(c);
  // Those of the tool itself first: they leave its wrist where it is, or near.
  using Kind = Motion::Kind;
  for (const Kind kind : {Kind::Turn, Kind::Slide, Kind::HalfTurn})
    for (const bool own : {true, false})
      for (const Constraint& c : constraints_) {
        const PlacedFeature& f = (c.first.frame == tool) == own ? c.first : c.second;
        add(f.frame, f.feature, kind);
      }
}

void FreeMotions::add(const FrameId& frame, const Feature& feature, Motion::Kind kind) {
  const Vec3 point = position_of(feature);
  for (const Vec3& direction : directions_of(feature)) {
    const bool known = std::any_of(motions_.begin(), motions_.end(), [&](const Motion& m) {
      return m.kind == kind && m.frame == frame && m.point == point && m.direction == direction;
    });
    if (!known) motions_.push_back({kind, frame, point, direction});
  }
}

void FreeMotions::keep_free(const PoseOf& pose_of, double bound, Random& random) {
  const Transform tool = pose_of(tool_);
  std::erase_if(motions_, [&](const Motion& m) {
    const Transform frame = pose_of(m.frame);
    const WorldAxis axis{frame * m.point, frame.linear * m.direction};
    Transform after = tool;
    if (m.kind == Motion::Kind::Slide)
      after.translation += length_ * random.between(0.2, 0.8) * axis.direction;
    else
      after = turned(tool, axis, m.kind == Motion::Kind::Turn ? random.between(0.5, 2.5) : kPi);
    const auto pose = [&](const FrameId& id) { return id == tool_ ? after : pose_of(id); };
    return std::any_of(constraints_.begin(), constraints_.end(), [&](const Constraint& c) {
      const Cost cost = kinematics::cost(c, pose(c.first.frame), pose(c.second.frame), length_);
      return !(cost.value.allFinite() && cost.value.cwiseAbs().maxCoeff() <= bound);
    });
  });
}

void FreeMotions::keep_independent(const PoseOf& pose_of) {
  using Twist = Eigen::Matrix<double, 6, 1>;
  const Vec3 origin = pose_of(tool_).translation;
  std::vector<Twist> basis;
  std::erase_if(motions_, [&](const Motion& m) {
    if (m.kind == Motion::Kind::HalfTurn) return false;
    const Transform frame = pose_of(m.frame);
    const Vec3 point = frame * m.point, direction = frame.linear * m.direction;
    Twist twist = Twist::Zero();
    if (m.kind == Motion::Kind::Slide) {
      twist.head<3>() = direction;
    } else {
      twist.head<3>() = direction.cross(origin - point) / length_;
      twist.tail<3>() = direction;
    }
    for (const Twist& b : basis) twist -= b.dot(twist) * b;
    if (!(twist.norm() > kIndependent)) return true;
    basis.push_back(twist.normalized());
    return false;
  });
}

Transform FreeMotions::moved(const Transform& tool, const PoseOf& pose_of, const ReachBall& ball,
                             Random& random) const {
  Transform pose = tool;
  for (const Motion& m : motions_) {
    const Transform frame = m.frame == tool_ ? pose : pose_of(m.frame);
    const WorldAxis axis{frame * m.point, (frame.linear * m.direction).normalized()};
    switch (m.kind) {
      case Motion::Kind::Turn:
        pose = turned(pose, axis, random_angle(axis, pose * ball.point, ball, random));
        break;
      case Motion::Kind::Slide:
        pose.translation +=
            random_length(axis.direction, pose * ball.point, ball, random) * axis.direction;
        break;
      case Motion::Kind::HalfTurn:
        if (random.index(2) == 1) pose = turned(pose, axis, kPi);
        break;
    }
  }
  // Else rounding would grow from one to the next.
  pose.linear = Eigen::Quaterniond(pose.linear).normalized().toRotationMatrix();
  return pose;
}

}  // namespace kaboum::kinematics
