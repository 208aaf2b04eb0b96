#pragma once

#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/numeric.h>

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "cli.h"

namespace kaboum::tools {

inline constexpr double kDegree = std::numbers::pi / 180;

/// What kaboum-ik has found.
struct IkAnswer {
  struct Row {
    std::vector<double> q;
    kinematics::PoseError error;
    unsigned singular = kinematics::kRegular;
    bool within = true;
    kinematics::Transform pose;  ///< that was to be reached
  };
  kinematics::Arm arm;
  std::vector<std::string> joints;
  kinematics::Transform target;
  std::optional<kinematics::ClosedForm> form;
  std::size_t found = 0;  ///< whatever the limits
  std::vector<Row> rows;
};

/// Of the closed form's model: with less, no branch is missed at the borders of what is within
/// reach.
inline constexpr double kExact = 1e-8;

/// Whether these are all configurations: there is a closed form, and the arm is the one that it is
/// of.
bool is_complete(const IkAnswer& answer);
/// For reports and --json; angles in degrees or radians.
Json answer_json(const IkAnswer& answer, bool degrees);
/// A line of joint values for each configuration.
void print_answer(const IkAnswer& answer, bool degrees);

}  // namespace kaboum::tools
