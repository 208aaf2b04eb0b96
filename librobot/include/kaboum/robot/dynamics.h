#pragma once

#include <kaboum/robot/robot.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kaboum::robot {

/// Mass of a link and its distribution.
struct Inertial {
  Transform origin;             ///< from the frame of centre of mass and inertia to the link's
  double mass = 0;              ///< [kg]
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, in that frame, symmetric [kg·m²]
};

/// Motor limits and friction of a joint.
struct JointDynamics {
  std::optional<double> effort;        ///< most [N or N·m]; none: not stated
  double damping = 0;                  ///< [N·s/m or N·m·s/rad]
  double friction = 0;                 ///< static [N or N·m]
  std::optional<double> lower, upper;  ///< the joint's own limits, also where it mimics another
};

/// A URDF's statements of masses and forces, by the names of links and joints.
struct Dynamics {
  std::map<std::string, Inertial> links;
  std::map<std::string, JointDynamics> joints;
};

/// Reads <inertial>, <dynamics> and <limit> of a URDF, which parse_urdf passes over.
/// @param name  appears in messages.
/// @throws Error{InvalidInput} naming the line: not well-formed, no numbers, a mass below 0, two
///   elements where one is meant.
Dynamics parse_dynamics(std::string_view text, const std::string& name);

}  // namespace kaboum::robot
