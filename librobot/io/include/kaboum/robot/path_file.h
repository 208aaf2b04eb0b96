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

/// A path, and when its waypoints are reached where its file says so.
struct TimedPath {
  Path waypoints;
  std::vector<double> times = {};  ///< of the waypoints, not falling; empty: none are stated [s]
  /// Derivatives by time at the waypoints; empty: none are stated, or they are not asked for.
  Path velocities = {}, accelerations = {};
};

/// Reads a path for a robot: CSV, JSON, YAML or an array of NumPy, also such as MoveIt, VAMP and
/// cuRobo have them (docs/formats.md). What could be read in two ways is refused: numbers that are
/// the names of joints, and names of joints in a comment above or beside the first numbers that are
/// in another order than the robot's.
/// @param file  `-` for standard input
/// @param notes  gets what a user should know; one sentence each
/// @param derivatives  whether velocities and accelerations are used; else a note says that those
///   that are not 0 are passed over
/// @throws Error{InvalidInput} naming the line, the joint or the waypoint; as arrange; for
///   derivatives that only some waypoints have; Error{NotBuilt} for YAML in a build without
///   yaml-cpp.
TimedPath read_timed_path(const std::string& file, const Robot& robot, const PathOptions& options,
                          std::vector<std::string>& notes, bool derivatives = false);

/// The same without times, which a note says where there are some.
/// @throws as read_timed_path
Path read_path(const std::string& file, const Robot& robot, const PathOptions& options,
               std::vector<std::string>& notes);

/// The waypoint that an option of a program states, "0,1.5,-2": a value per variable.
/// @param name  the option's, for messages
/// @throws Error{InvalidArgument} for another number of values, and as arrange
Path parse_configuration(const std::string& text, const std::string& name, const Robot& robot,
                         const PathOptions& options);

/// The largest move of a joint between two waypoints, in words; empty if none moves.
std::string largest_move(const Path& path, const Robot& robot);

}  // namespace kaboum::robot
