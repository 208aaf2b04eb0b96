#pragma once

#include <kaboum/kinematics/closed_form.h>

#include <cmath>

// What an arm with a closed form can reach at most. Internal to kaboum_kinematics.
namespace kaboum::kinematics {

/// A ball that holds a point of the tool whatever the joints are.
struct ReachBall {
  Vec3 point = Vec3::Zero();   ///< in the tool's frame
  Vec3 centre = Vec3::Zero();  ///< in the base's, or the world
  double radius = 0;           ///< [length]
};

/// The last frame's origin of a closed form, which its first joints place; in the base's frame.
/// Source: docs/algorithms/constraint-sampling.md#closed-form.
inline ReachBall reach_ball(const ClosedForm& form) {
  const double links = form.family == Family::SphericalWrist
                           ? form.forearm
                           : std::abs(form.a3) + std::abs(form.a4) + std::abs(form.d5);
  return {form.tool_inverse.translation, inverse(form.base_inverse).translation,
          std::hypot(std::abs(form.a1) + form.a2 + links, form.lateral)};
}

/// Lengths by which a point may move along a line and be in a ball: middle ± half.
struct Chord {
  double middle = 0;
  double half = -1;  ///< below 0: the line misses the ball
};

/// @param from  the point, seen from the ball's centre.
/// @param direction  of unit length.
inline Chord chord(const Vec3& from, const Vec3& direction, double radius) {
  const double along = from.dot(direction);
  const double rest = along * along - from.squaredNorm() + radius * radius;
  return {-along, rest > 0 ? std::sqrt(rest) : -1};
}

}  // namespace kaboum::kinematics
