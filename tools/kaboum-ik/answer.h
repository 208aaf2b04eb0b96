#pragma once

#include <kaboum/kinematics/inverse.h>

#include <numbers>
#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

inline constexpr double kDegree = std::numbers::pi / 180;

/// What kaboum-ik has found, and for which arm.
struct IkAnswer : kinematics::InverseAnswer {
  kinematics::Arm arm;
  std::vector<std::string> joints;
  kinematics::Transform target;
};

/// For reports and --json; angles in degrees or radians.
Json answer_json(const IkAnswer& answer, bool degrees);
/// Which joints of a family are free, and their ranges.
std::string family_text(const IkAnswer& answer, const kinematics::SolutionFamily& family,
                        bool degrees);
/// A line of joint values for each configuration.
void print_answer(const IkAnswer& answer, bool degrees);

}  // namespace kaboum::tools
