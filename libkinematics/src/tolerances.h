#pragma once

#include <numbers>

/// What the closed forms and the samplers count as nothing.
namespace kaboum::kinematics {

inline constexpr double kPi = std::numbers::pi;
/// Below this, directions and lengths (in parts of the arm's) say nothing about an angle.
inline constexpr double kNothing = 1e-12;
/// So little out of reach (in parts of the arm's) may be rounding, or the model's error: taken as
/// the border, and whether that reaches the target is what the check of all solutions decides.
inline constexpr double kBorder = 1e-6;

}  // namespace kaboum::kinematics
