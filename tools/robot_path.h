#pragma once

#include <kaboum/sweep/path.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace kaboum::tools {

/// Reads a path for a robot, CSV or JSON (docs/formats.md). What could be read in two ways is
/// refused: numbers that are the names of joints, and names of joints in a comment above or beside
/// the first numbers that are in another order than the robot's.
/// @param file  `-` for standard input
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} naming the line, the joint or the waypoint; as sweep::arrange.
sweep::Path read_path(const std::string& file, const sweep::Robot& robot, bool check_limits,
                      const sweep::FixedJoints& fixed, std::vector<std::string>& notes);

/// Adds the option --joint NAME=VALUE, which may be repeated.
CLI::Option* add_joint_option(CLI::App& app, std::vector<std::string>& values);
/// @throws Error{InvalidArgument} on what is not NAME=VALUE, and on joints given twice.
sweep::FixedJoints fixed_joints(const std::vector<std::string>& values);

/// The largest move of a joint between two waypoints, in words; empty if none moves.
std::string largest_move(const sweep::Path& path, const sweep::Robot& robot);

}  // namespace kaboum::tools
