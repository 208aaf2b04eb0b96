#pragma once

#include <kaboum/kinematics/closed_form.h>

#include <algorithm>
#include <numbers>

/// What the closed forms and the samplers count as nothing.
namespace kaboum::kinematics {

inline constexpr double kPi = std::numbers::pi;
/// Below this, directions and lengths (in parts of the arm's) say nothing about an angle.
inline constexpr double kNothing = 1e-12;
/// So little out of reach (in parts of the arm's) may be rounding, or the model's error: taken as
/// the border, and whether that reaches the target is what the check of all solutions decides.
inline constexpr double kBorder = 1e-6;
/// So near (in radians, or parts of the reach) to where a joint is free, rounding of the target
/// moves it visibly: what is found then need not be all.
inline constexpr double kNearlySingular = 1e-6;

/// Errors of targets and formulas, in radians or parts of the reach, before singular places near by
/// make them larger.
inline constexpr double kRounding = 1e-14;
/// Where a configuration is known no better than this, rounding decides which is found. [rad]
inline constexpr double kCoarse = 1e-5;

/// So near to where a joint is free it is: with any value of it the target is met within the bound
/// of solutions.
struct FreeWithin {
  double angle = 0, length = 0;

  FreeWithin(const ClosedForm& form, double bound)
      : angle(std::min(bound, 1e-9) / 8 + 4 * form.model_error.rotation),
        length(std::min(bound, 1e-9) / 8 * form.reach + 4 * form.model_error.position) {}
};

/// Angles of joint 1 that turn the wrist's sideways place to `lateral`.
struct ShoulderTurns {
  std::array<double, 2> angle{};  ///< in the formulas
  int count = 0;                  ///< 0: out of reach
  bool free = false;              ///< any will do: `count` is 0
  bool single = false;            ///< two coincide
  bool nearly = false;            ///< nearly free
  double error = kRounding;       ///< how well it is known [rad]
};

/// @param side  joint 1 is to meet side · (c0 ty − s0 tx) = lateral.
/// @param t, z  origin of the target's last frame, direction of its last axis, in the first frame.
ShoulderTurns shoulder_turns(const ClosedForm& form, const FreeWithin& within, double side,
                             const Vec3& t, const Vec3& z);

/// How well joints 2 and 3 are known, whose links end at `distance`. [rad]
/// @param error   of that place, in parts of the reach.
/// @param second  length of the second link.
/// @param folded  the end is on joint 2, which is free.
double error_after_elbow(const ClosedForm& form, double error, double distance, double second,
                         bool folded);

}  // namespace kaboum::kinematics
