#pragma once

#include <kaboum/robot/robot.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot {

/// A joint-space path: linear between its waypoints, each a value per variable of the robot, in the
/// robot's order. [rad or length]
using Path = std::vector<std::vector<double>>;

/// A path as written in a file, before it is known which robot it is for.
struct NamedPath {
  std::vector<std::string> joints;  ///< of the columns; empty: in the robot's order
  Path waypoints;
  std::vector<std::size_t> lines = {};  ///< of the waypoints, in a file that has lines; else empty
  std::string joints_at = {};           ///< where the joints are named: "line 1"; empty: not known
  std::vector<std::string> notes = {};  ///< things a user should know; one sentence each
};

/// Comma-, semicolon- or blank-separated numbers, one waypoint per line. A first line that is not
/// all numbers names the joints, perhaps in quotation marks. (What is within them on the first line
/// is a name, also a number, and may have separators in it.) A separator may end lines; `#` begins
/// a comment.
/// @throws Error{InvalidInput} naming the line.
NamedPath parse_path_csv(std::string_view text, const std::string& name);

/// A joint's name as it is written on the first line: in quotation marks where it would be read as
/// something else.
std::string csv_field(const std::string& joint);

/// {"joints": ["a", …], "waypoints": [[0, …], …]}, "joints" optional; or the waypoints alone. Or a
/// trajectory as others have it, times and all: ROS's JointTrajectory, alone or in MoveIt's
/// RobotTrajectory, DisplayTrajectory and goals; a JointState with a row for each instant, as
/// cuRobo's. Its times are a column "time_from_start". docs/formats.md.
/// @throws Error{InvalidInput} naming the member; for several trajectories, and for joints of
///   several degrees of freedom that move.
NamedPath parse_path_json(std::string_view text, const std::string& name);

/// The columns that are times, not joints: called time, %time, __time, timestamp, stamp,
/// time_from_start or t, whatever the case, when the robot has no joint of this name.
std::vector<std::size_t> time_columns(const NamedPath& path, const Robot& robot);

/// Times of the waypoints, of the first column of times; empty: there is none, or the last one is
/// not after the first one.
std::vector<double> times_of(const NamedPath& path, const Robot& robot);

/// Values of joints that do not move, by their names. [rad or length]
using FixedJoints = std::map<std::string, double>;

/// The path in the robot's order of variables. Columns of times are left out; times may be equal,
/// but not decrease.
/// @param check_limits  whether waypoints outside the joints' limits are refused.
/// @param fixed  joints without a column.
/// @throws Error{InvalidInput} naming the joint (absent, unknown, named twice), the waypoint
///   or the line and column of a time;
///   Error{InvalidArgument} where a fixed joint is unknown or has a column.
Path arrange(const NamedPath& path, const Robot& robot, const std::string& name,
             bool check_limits = true, const FixedJoints& fixed = {});

/// @throws Error{InvalidInput} naming the first waypoint and joint outside the joint's limits.
void require_within_limits(const Path& path, const Robot& robot, const std::string& name);

/// True if the variable is an angle: it belongs to a joint that turns.
bool is_angle(const Robot& robot, const Variable& variable);

/// The path with its angles, given in degrees, in radians: times pi / 180, as rounded doubles.
Path from_degrees(Path path, const Robot& robot);

/// The path with its angles in degrees: times 180 / pi, rounded so that from_degrees keeps values
/// that are within the robot's limits within them. It may give others than these by a rounding.
Path to_degrees(Path path, const Robot& robot);

/// A value that is hardly meant in radians.
struct LikelyDegrees {
  std::size_t waypoint = 0, variable = 0;
};
/// The first angle of more than two turns either way, if there is one.
std::optional<LikelyDegrees> find_likely_degrees(const Path& path, const Robot& robot);

}  // namespace kaboum::robot
