#pragma once

#include <kaboum/robot/path.h>

#include <string>
#include <vector>

namespace kaboum::robot {

/// Options of reading a path.
struct PathOptions {
  bool check_limits = true;  ///< refuse waypoints outside the joints' limits
  bool degrees = false;      ///< angles of the file and of `fixed` are in degrees
  FixedJoints fixed = {};    ///< joints without a column
};

/// Reads a path for a robot, CSV or JSON (docs/formats.md). What could be read in two ways is
/// refused: numbers that are the names of joints, and names of joints in a comment above or beside
/// the first numbers that are in another order than the robot's.
/// @param file  `-` for standard input
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} naming the line, the joint or the waypoint; as arrange.
Path read_path(const std::string& file, const Robot& robot, const PathOptions& options,
               std::vector<std::string>& notes);

/// The largest move of a joint between two waypoints, in words; empty if none moves.
std::string largest_move(const Path& path, const Robot& robot);

}  // namespace kaboum::robot
