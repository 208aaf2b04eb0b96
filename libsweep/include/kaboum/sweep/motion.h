#pragma once

#include <kaboum/robot/robot.h>

#include <array>
#include <span>

namespace kaboum::sweep {

using geom::Vec3;
using robot::Mat3;
using robot::Robot;
using robot::Transform;

struct Reach;

/// The motion of a link while the variables change linearly, q(s) = from + s · (to − from), s in
/// [0, 1].
class LinkMotion {
 public:
  /// @pre both ends have a finite value per variable; the link exists.
  LinkMotion(const Robot& robot, std::uint32_t link, std::span<const double> from,
             std::span<const double> to);

  /// Pose of the link relative to the root.
  [[nodiscard]] Transform at(double s) const;

  /// Taylor coefficients c of the pose: T(s + t) = Σ c[n] tⁿ + O(t⁶).
  static constexpr int kOrder = 5;
  using Expansion = std::array<Transform, kOrder + 1>;
  [[nodiscard]] Expansion expand(double s) const;

  /// False when the link stays where it is.
  [[nodiscard]] bool moves() const { return moves_; }

 private:
  friend class MotionBounds;
  friend Reach reach_of(const LinkMotion& motion, std::span<const Vec3> points);
  struct Stage {
    Transform before;  // from the joint's frame to the moved frame before it
    double lengths;    // of the fixed transforms that `before` is the product of, summed
    bool revolute;
    Vec3 axis;
    Mat3 cross, across;  // [axis]×, and the projection across the axis
    double from, to, delta;
    double
        magnitude;  // of all that the joint's value is a sum of: what its rounding is relative to
  };
  std::vector<Stage> stages_;
  Transform after_;
  double after_lengths_ = 0;
  bool moves_ = false;
  std::size_t factors_ = 1;  // transforms that rounding enters by
};

/// Reach of a body fixed to a link: all that bounds of the link's motions need of it.
struct Reach {
  double distance = 0;  ///< from the origin of the frame that the last joint moves [length]
  double across = 0;    ///< from that joint's axis [length]
  /// Of the fixed transforms from that frame on, and to the point, summed: what rounding is
  /// relative to, however near the point is in the end. [length]
  double lengths = 0;
};

/// The same for all motions of the link.
/// @param points  whose hull is the body, in the link's frame; not empty.
Reach reach_of(const LinkMotion& motion, std::span<const Vec3> points);

/// Bounds that hold for all points of a body fixed to the link, for the whole motion, whatever the
/// configuration. docs/algorithms/swept-volumes.md, "Derivatives".
class MotionBounds {
 public:
  /// @param points  whose hull is the body, in the link's frame; not empty.
  MotionBounds(const LinkMotion& motion, std::span<const Vec3> points)
      : MotionBounds(motion, reach_of(motion, points)) {}
  MotionBounds(const LinkMotion& motion, const Reach& reach);

  /// Σ_k ρ_k (S_kⁿ − S_{k−1}ⁿ) + n Σ_p |ḋ_p| S_pⁿ⁻¹ ≥ |dⁿx/dsⁿ|, rounded up. n ≥ 1. [length]
  [[nodiscard]] double derivative(int n) const;
  /// The same with one radius, the largest, and all joints before the link: Eq. 4.20.
  [[nodiscard]] double coarse_second_derivative() const;

  /// Bound of the error of the n-th derivative of a point, n ≤ 5, as LinkMotion computes it, the
  /// errors of the robot's transforms and of the points (100 · 2^-53 of their distance) included;
  /// rounded up. [length]
  [[nodiscard]] double error(int n) const;

  /// Largest distance of a point of the body to the first axis' origin, to the root's origin, and
  /// the sum of the turns [rad]; rounded up.
  [[nodiscard]] double radius() const { return radius_; }
  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] double turn() const { return turn_; }
  [[nodiscard]] double slide() const { return slide_; }

 private:
  struct Term {
    bool revolute;
    double radius;  // ρ, of revolute joints
    double delta;   // |change|
  };
  std::vector<Term> terms_;  // of joints that move, from the root on
  double radius_ = 0, extent_ = 0, lengths_ = 0, turn_ = 0, slide_ = 0, relative_error_ = 0;
};

}  // namespace kaboum::sweep
