#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/motion/spline_lines.h>
#include <kaboum/world/motion_check.h>

#include <optional>
#include <string>
#include <vector>

#include "options.h"

/// The motions that kaboum-check decides, as files state them.
namespace kaboum::tools {

/// A path's file, and the robot whose it is where that is stated: "left=path.csv".
struct StatedPath {
  std::optional<std::size_t> robot;
  std::string file;
};

/// @throws Error{InvalidArgument} for several paths that do not name a robot each
std::vector<StatedPath> stated_paths(const CheckOptions& o, const world::World& world);

/// Robots' paths of equally many waypoints: those of files, or straight lines near the polynomials
/// between these.
struct StatedMotions {
  std::vector<world::RobotPath> paths;
  std::vector<double> times;                 ///< of the files' waypoints; empty: none are known [s]
  std::size_t waypoints = 0;                 ///< of each file
  std::optional<motion::SplineLines> curve;  ///< of the first robot: places are those of all

  /// A place on the paths as the waypoint of the files before it, and a share of the way, or of the
  /// time, to the next one.
  void place(std::size_t& segment, double& share) const;
};

/// @param robot  the only one that moves; nullopt: each path states its own
/// @throws Error{InvalidInput} for files that cannot be read, or whose times or derivatives do not
///   go together; as motion::spline_lines
StatedMotions read_motions(const CheckOptions& o, const world::World& world,
                           const std::vector<StatedPath>& stated, std::optional<std::size_t> robot,
                           std::vector<std::string>& notes);

}  // namespace kaboum::tools
