#pragma once

#include <kaboum/robot/path.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace kaboum::tools {

/// How a path is read.
struct PathOptions {
  bool check_limits = true;  ///< refuse waypoints outside the joints' limits
  bool degrees = false;      ///< angles of the file and of `fixed` are in degrees
  robot::FixedJoints fixed;  ///< joints without a column
};

/// Reads a path for a robot, CSV or JSON (docs/formats.md). What could be read in two ways is
/// refused: numbers that are the names of joints, and names of joints in a comment above or beside
/// the first numbers that are in another order than the robot's.
/// @param file  `-` for standard input
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} naming the line, the joint or the waypoint; as robot::arrange.
robot::Path read_path(const std::string& file, const robot::Robot& robot,
                      const PathOptions& options, std::vector<std::string>& notes);

/// Adds the option --joint NAME=VALUE, which may be repeated.
CLI::Option* add_joint_option(CLI::App& app, std::vector<std::string>& values);
/// Adds the flag --degrees.
CLI::Option* add_degrees_option(CLI::App& app, bool& degrees);
/// @throws Error{InvalidArgument} on what is not NAME=VALUE, and on joints given twice.
robot::FixedJoints fixed_joints(const std::vector<std::string>& values);

/// The largest move of a joint between two waypoints, in words; empty if none moves.
std::string largest_move(const robot::Path& path, const robot::Robot& robot);

}  // namespace kaboum::tools
