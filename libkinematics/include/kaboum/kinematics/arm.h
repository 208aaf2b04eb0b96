#pragma once

#include <kaboum/robot/robot.h>

#include <limits>
#include <span>
#include <string_view>
#include <vector>

/// Inverse kinematics, and samples of configurations that meet geometric constraints.
namespace kaboum::kinematics {

using robot::Mat3;
using robot::Transform;
using robot::Vec3;

/// One joint of an arm, as a line that it turns about, or moves along.
struct Axis {
  bool turns = true;
  Vec3 direction = Vec3::UnitZ();  ///< of unit length, at q = 0, in the base's frame
  Vec3 point = Vec3::Zero();       ///< on the axis at q = 0, in the base's frame [length]
  double rate = 1;  ///< above 0; the joint turns (moves) by rate · q [1, or length per unit of q]
  double lower = -std::numeric_limits<double>::infinity();  ///< limits of q [rad or length]
  double upper = std::numeric_limits<double>::infinity();
};

/// A serial chain as the product of exponentials: the tool's pose in the base's frame is
/// motion 1(q₁) · … · motion n(qₙ) · tool.
struct Arm {
  std::vector<Axis> axes;
  Transform tool;                        ///< its pose at q = 0
  std::vector<std::uint32_t> variables;  ///< of the robot, one per axis; 0 … n−1 without a robot
};

/// The joints between two links of a robot. Offsets of joints go into the axes.
/// @throws Error{InvalidArgument} when a link is unknown, `base` is not above `tip`, nothing moves
///   between them; Error{InvalidInput} when a variable moves two joints of the chain, or none.
Arm arm_of(const robot::Robot& robot, std::string_view base, std::string_view tip);

/// A frame fixed to a link of an arm: it moves with the first `axes` joints.
struct ArmFrame {
  std::size_t axes = 0;  ///< 0: it rests with the base; all: it moves with the tool
  Transform pose;        ///< in the base's frame at q = 0
};

/// The frame of a link, for an arm that was made of the same robot and base.
/// @throws Error{InvalidArgument} when a link is unknown, `base` is not above `link`, or the link
///   moves with joints that are not the arm's first ones.
ArmFrame frame_of(const robot::Robot& robot, const Arm& arm, std::string_view base,
                  std::string_view link);

/// The joints that move a frame, with the frame as tool.
/// @pre the frame has no more axes than the arm.
Arm arm_to(const Arm& arm, const ArmFrame& frame);

/// Arm of revolute joints with Denavit–Hartenberg rows; `theta` of a row is the joint's offset.
/// Distal ("standard") convention: Rz(theta) · Tz(d) · Tx(a) · Rx(alpha).
Arm arm_of_distal(std::span<const robot::Dh> rows);
/// Proximal convention (Khalil–Kleinfinger, Craig): Rx(alpha) · Tx(a) · Rz(theta) · Tz(d).
Arm arm_of_proximal(std::span<const robot::Dh> rows);

/// The tool's pose in the base's frame.
/// @pre one value per axis. [rad or length]
Transform forward(const Arm& arm, std::span<const double> q);

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// 6 × n: rows 0–2 the velocity of the tool's origin, rows 3–5 its angular velocity, both in the
/// base's frame. `pose` receives the tool's pose when it is not null.
/// @pre one value per axis.
Jacobian jacobian(const Arm& arm, std::span<const double> q, Transform* pose = nullptr);
/// The same in a frame where the base has a pose, into what is given, whose memory is used again.
void jacobian(const Arm& arm, const Transform& base, std::span<const double> q, Jacobian& out,
              Transform& pose);

/// No point of the arm's axes at the tool is farther from an axis: the sum of the distances from
/// axis to axis and to the tool's origin, with the ranges of joints that move along. [length]
double reach(const Arm& arm);

/// True if all values are within the limits.
bool within_limits(const Arm& arm, std::span<const double> q);

/// Distance of a pose from another one.
struct PoseError {
  double position = 0;  ///< of the origins [length]
  double rotation = 0;  ///< Frobenius norm of the difference of the rotations, √8 sin(angle / 2)
};
PoseError difference(const Transform& a, const Transform& b);

/// The inverse of a rotation and translation.
inline Transform inverse(const Transform& t) {
  return {t.linear.transpose(), -(t.linear.transpose() * t.translation)};
}

}  // namespace kaboum::kinematics
