// Poses of a link along a straight joint-space motion in long double, and bounds of its speed,
// acceleration and rounding. docs/algorithms/swept-volumes.md.
#include <kaboum/verify/sweep.h>

#include <algorithm>
#include <cmath>

#include "rounding.h"

namespace kaboum::verify {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, 3, 3>;
using Vector = Eigen::Matrix<Real, 3, 1>;

/// Rotation by an angle about a unit vector: what lies along it stays, what lies across it turns.
Matrix rotation_about(const Vector& a, Real angle) {
  const Real c = std::cos(angle), s = std::sin(angle);
  Matrix r;
  for (int i = 0; i < 3; ++i) {
    const Vector e = Vector::Unit(i), along = a * a[i];
    r.col(i) = along + c * (e - along) + s * a.cross(e);
  }
  return r;
}

}  // namespace

Eigen::Matrix<double, 3, 4> pose_of(const KinematicChain& chain, std::span<const double> q) {
  Matrix rotation = Matrix::Identity();
  Vector translation = Vector::Zero();
  for (const KinematicStage& stage : chain) {
    translation += rotation * stage.translation.cast<Real>();
    rotation = (rotation * stage.rotation.cast<Real>()).eval();
    if (stage.motion == KinematicStage::Motion::None) continue;
    const Real value =
        static_cast<Real>(stage.multiplier) * q[stage.variable] + static_cast<Real>(stage.offset);
    const Vector axis = stage.axis.cast<Real>().normalized();
    if (stage.motion == KinematicStage::Motion::Turn) {
      rotation = (rotation * rotation_about(axis, value)).eval();
    } else {
      translation += value * (rotation * axis);
    }
  }
  Eigen::Matrix<double, 3, 4> pose;
  pose.leftCols<3>() = rotation.cast<double>();
  pose.col(3) = translation.cast<double>();
  return pose;
}

MotionBound bound_motion(const KinematicChain& chain, std::span<const double> from,
                         std::span<const double> to, double radius) {
  MotionBound b;
  b.distance = radius;
  double angles = 0;
  // From the shape to the root; in a joint's moved frame the point has these bounds.
  for (std::size_t i = chain.size(); i-- > 0;) {
    const KinematicStage& stage = chain[i];
    if (stage.motion != KinematicStage::Motion::None) {
      const double rate =
          std::abs(stage.multiplier) * std::abs(to[stage.variable] - from[stage.variable]) * kUp;
      // Not of the sum: its rounding is relative to what it is a sum of.
      const double most = (std::abs(stage.multiplier) * std::max(std::abs(from[stage.variable]),
                                                                 std::abs(to[stage.variable])) +
                           std::abs(stage.offset)) *
                          kUp;
      if (stage.motion == KinematicStage::Motion::Turn) {
        b.acceleration += rate * rate * b.distance + 2 * rate * b.speed;
        b.speed += rate * b.distance;
        angles += most;
      } else {
        b.speed += rate;
        b.distance += most;
      }
    }
    b.distance += stage.translation.norm();
  }
  b.distance *= kUp;
  b.speed *= kUp;
  b.acceleration *= kUp;
  b.rounding = 0x1p-46 * static_cast<double>(chain.size() + 1) * (1 + angles) * b.distance * kUp;
  return b;
}

}  // namespace kaboum::verify
