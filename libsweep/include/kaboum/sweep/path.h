#pragma once

#include <kaboum/sweep/robot.h>

#include <string>
#include <string_view>
#include <vector>

namespace kaboum::sweep {

/// A joint-space path: linear between its waypoints, each a value per variable of the robot, in the
/// robot's order. [rad or length]
using Path = std::vector<std::vector<double>>;

/// A path as written in a file, before it is known which robot it is for.
struct NamedPath {
  std::vector<std::string> joints;  ///< of the columns; empty: in the robot's order
  Path waypoints;
};

/// Comma-, semicolon- or blank-separated numbers, one waypoint per line; a first line that is not
/// all numbers names the joints; `#` begins a comment.
/// @throws Error{InvalidInput} naming the line.
NamedPath parse_path_csv(std::string_view text, const std::string& name);

/// {"joints": ["a", …], "waypoints": [[0, …], …]}, "joints" optional; or the waypoints alone.
/// @throws Error{InvalidInput}.
NamedPath parse_path_json(std::string_view text, const std::string& name);

/// The path in the robot's order of variables.
/// @param check_limits  whether waypoints outside the joints' limits are refused.
/// @throws Error{InvalidInput} naming the joint (absent, unknown, named twice) or the waypoint.
Path arrange(const NamedPath& path, const Robot& robot, const std::string& name,
             bool check_limits = true);

}  // namespace kaboum::sweep
