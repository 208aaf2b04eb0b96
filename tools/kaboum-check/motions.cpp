#include "motions.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/world/gripper.h>

#include <algorithm>

namespace kaboum::tools {
namespace {

/// Robots that move at once are at their waypoints at the same instants: files that say otherwise
/// mean another motion.
/// @param before  of the path before this one; empty: it has none, or this is the first
void require_same_times(const std::vector<double>& before, const std::vector<double>& times,
                        const std::string& first, const std::string& file) {
  if (before.empty() || times.empty()) return;
  for (std::size_t i = 0; i < std::min(before.size(), times.size()); ++i)
    if (before[i] != times[i]) {
      std::string what = file + ": waypoint " + std::to_string(i + 1) + " is at ";
      what.append(std::to_string(times[i])).append(" s, that of ").append(first);
      what.append(" at ").append(std::to_string(before[i]));
      what.append(
          " s; robots that move at once go from waypoint to waypoint together: give both paths "
          "waypoints at the same times");
      throw Error(ErrorCode::InvalidInput, what);
    }
}

/// What the polynomials of a file are made of.
motion::SplineWaypoints spline_of(const CheckOptions& o, robot::TimedPath read,
                                  const std::string& file, std::vector<std::string>& notes) {
  const bool quintic = o.between == kQuintic;
  const auto is_moving = [](const std::vector<double>& row) {
    return std::ranges::any_of(row, [](double x) { return x != 0; });
  };
  if (!quintic && std::ranges::any_of(read.accelerations, is_moving))
    notes.push_back(
        "WARNING: " + file +
        " states accelerations, which cubic polynomials do not have: a controller that "
        "takes these, as ROS 2's does, moves otherwise; --between quintic decides that");
  const char* missing = read.times.empty()                      ? "times"
                        : read.velocities.empty()               ? "velocities"
                        : quintic && read.accelerations.empty() ? "accelerations"
                                                                : nullptr;
  if (missing != nullptr)
    throw Error(ErrorCode::InvalidInput,
                file + ": --between " + o.between + " needs the " + missing +
                    " of all points, which a JointTrajectory has (.json, .yaml), and times that "
                    "rise");
  return {std::move(read.times), std::move(read.waypoints), std::move(read.velocities),
          quintic ? std::move(read.accelerations) : robot::Path{}};
}

/// The polynomials stay within the limits of joints, as far as the points on them tell.
void require_within_limits(const motion::SplineLines& lines, const robot::Robot& robot,
                           const std::string& file) {
  for (std::size_t i = 0; i < lines.points.size(); ++i)
    if (const auto bad = find_out_of_limits(robot, lines.points[i]))
      throw Error(ErrorCode::InvalidInput,
                  file + ": behind waypoint " + std::to_string(lines.place(i, 0).first + 1) +
                      " the polynomial takes joint '" + robot.variables[*bad].name + "' to " +
                      std::to_string(lines.points[i][*bad]) + ", beyond its limits");
}

/// Fingers that hold something stop where they touch. @param what  of the path, in messages
void add_finger_room(const world::World& world, world::RobotPath& path, const std::string& file,
                     const std::string& what) try {
  const std::vector<double> room =
      world::finger_room_along(world, path.robot, world.attachments, path.path, what);
  if (room.empty()) return;
  path.around.resize(room.size(), 0);
  for (std::size_t j = 0; j < room.size(); ++j) path.around[j] += room[j];
} catch (const Error& error) {
  throw Error(ErrorCode::InvalidInput, file + ": " + error.what());
}

/// Puts lines near the polynomials in place of the waypoints, as many for each robot.
void follow_splines(const CheckOptions& o, const world::World& world,
                    const std::vector<StatedPath>& stated,
                    const std::vector<motion::SplineWaypoints>& splines, StatedMotions& out) {
  for (std::size_t i = 0; i < splines.size(); ++i)
    if (splines[i].positions.size() != out.waypoints)
      throw Error(ErrorCode::InvalidInput, stated[i].file + ": " +
                                               std::to_string(splines[i].positions.size()) +
                                               " waypoints, and " + stated.front().file + " has " +
                                               std::to_string(out.waypoints) +
                                               "; robots that move at once have equally many");
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i < splines.size(); ++i) try {
      const std::vector<std::size_t> own = motion::spline_parts(splines[i], o.motion.resolution);
      parts.resize(std::max(parts.size(), own.size()), 1);
      for (std::size_t k = 0; k < own.size(); ++k) parts[k] = std::max(parts[k], own[k]);
    } catch (const Error& error) {
      throw Error(error.code(), stated[i].file + ": " + error.what());
    }
  for (std::size_t i = 0; i < splines.size(); ++i) {
    world::RobotPath& path = out.paths[i];
    motion::SplineLines lines = motion::spline_lines(splines[i], parts);
    if (o.reading.check_limits)
      require_within_limits(lines, world.robots[path.robot].kinematics, stated[i].file);
    path.path = lines.points;
    path.around = lines.around;
    add_finger_room(world, path, stated[i].file, "point of the polynomials");
    if (i == 0) out.curve = std::move(lines);
  }
}

}  // namespace

std::vector<StatedPath> stated_paths(const CheckOptions& o, const world::World& world) {
  std::vector<StatedPath> out;
  for (const std::string& text : o.paths) {
    const std::size_t equals = text.find('=');
    const auto robot =
        equals == std::string::npos ? std::nullopt : world.find_robot(text.substr(0, equals));
    out.push_back(robot ? StatedPath{robot, text.substr(equals + 1)} : StatedPath{{}, text});
    if (o.paths.size() == 1) continue;
    if (!robot)
      throw Error(ErrorCode::InvalidArgument,
                  "--path " + text +
                      ": of several paths each names its robot, as in --path left=left.csv --path "
                      "right=right.csv");
    for (std::size_t i = 0; i + 1 < out.size(); ++i)
      if (out[i].robot == robot)
        throw Error(ErrorCode::InvalidArgument,
                    "--path: robot '" + text.substr(0, equals) + "' has two paths");
  }
  if (out.size() > 1 && (!o.robot.empty() || !o.inside.empty() || !o.keep.keep.empty()))
    throw Error(ErrorCode::InvalidArgument,
                "--robot, --inside and --keep are for one robot that moves, not for several");
  return out;
}

void StatedMotions::place(std::size_t& segment, double& share) const {
  if (curve) std::tie(segment, share) = curve->place(segment, share);
}

StatedMotions read_motions(const CheckOptions& o, const world::World& world,
                           const std::vector<StatedPath>& stated, std::optional<std::size_t> robot,
                           std::vector<std::string>& notes) {
  StatedMotions out;
  std::vector<motion::SplineWaypoints> splines;
  const bool curved = o.between != kStraight;
  for (const StatedPath& path : stated) {
    const std::size_t index = robot ? *robot : *path.robot;
    robot::TimedPath read =
        robot::read_timed_path(path.file, world.robots[index].kinematics, o.reading, notes, curved);
    require_same_times(out.times, read.times, stated.front().file, path.file);
    if (!read.times.empty()) out.times = read.times;
    world::RobotPath& made = out.paths.emplace_back(world::RobotPath{index, read.waypoints, {}});
    if (out.paths.size() == 1) out.waypoints = made.path.size();
    add_finger_room(world, made, path.file, "waypoint");
    if (curved) splines.push_back(spline_of(o, std::move(read), path.file, notes));
  }
  if (curved) follow_splines(o, world, stated, splines, out);
  return out;
}

}  // namespace kaboum::tools
