#pragma once

#include <kaboum/robot/path.h>

#include <string>
#include <string_view>

namespace kaboum::robot {

/// Derivatives by time of the joints of a NamedPath, as a JointTrajectory has them: a row for each
/// waypoint, without columns of times; rows without numbers where it has none. Empty: it is none.
struct PathDerivatives {
  Path velocities, accelerations;
  std::string unfit =
      {};  ///< the first list that is not one number for each joint: "point 3, velocities"
};

/// The path of parse_path_json, of which times are the last column, and its derivatives.
/// @throws as parse_path_json
NamedPath parse_path_json(std::string_view text, const std::string& name,
                          PathDerivatives& derivatives);

}  // namespace kaboum::robot
