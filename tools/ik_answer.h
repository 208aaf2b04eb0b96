#pragma once

#include <kaboum/kinematics/numeric.h>
#include <kaboum/kinematics/solution_set.h>

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
    unsigned free = 0;           ///< joints as bits, that may have other values
  };
  /// Configurations that reach a pose and hang together.
  struct Family {
    kinematics::SolutionFamily family;
    kinematics::Transform pose;
  };
  kinematics::Arm arm;
  std::vector<std::string> joints;
  kinematics::Transform target;
  std::optional<kinematics::ClosedForm> form;
  std::size_t found = 0;  ///< isolated ones, whatever the limits
  std::vector<Family> families;
  bool outside = false;  ///< there are families, outside the limits
  std::vector<Row> rows;
  /// Why these need not be all; empty: they are, up to the accuracy of closed forms.
  std::string incomplete;
};

/// For reports and --json; angles in degrees or radians.
Json answer_json(const IkAnswer& answer, bool degrees);
/// Which joints of a family are free, and their ranges.
std::string family_text(const IkAnswer& answer, const kinematics::SolutionFamily& family,
                        bool degrees);
/// A line of joint values for each configuration.
void print_answer(const IkAnswer& answer, bool degrees);

}  // namespace kaboum::tools
