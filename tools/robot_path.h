#pragma once

#include <kaboum/sweep/path.h>

#include <string>

namespace kaboum::tools {

/// Reads a path for a robot, CSV or JSON (docs/formats.md). What could be read in two ways is
/// refused: numbers that are the names of joints, and names of joints in a comment above or beside
/// the first numbers that are in another order than the robot's.
/// @param file  `-` for standard input
/// @throws Error{InvalidInput} naming the line, the joint or the waypoint.
sweep::Path read_path(const std::string& file, const sweep::Robot& robot, bool check_limits);

/// The largest move of a joint between two waypoints, in words; empty if none moves.
std::string largest_move(const sweep::Path& path, const sweep::Robot& robot);

}  // namespace kaboum::tools
