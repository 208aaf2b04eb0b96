#pragma once

#include <kaboum/certify/sweep.h>
#include <kaboum/io/convex_io.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// The command line of sweep-approx.
namespace kaboum::tools {

struct SweepApproxOptions {
  std::string robot, scene, robot_name, base_pose, path, output, output_format,
      epsilon = "0.005", bound = "balanced", reach;
  std::string links, geometry = "collision", unit = "m", preview, depfile, prefix;
  std::vector<std::string> joints, packages;
  double simplify = 0;
  bool implicit_margin = false, no_merge = false, ignore_limits = false, degrees = false;
  std::string body_epsilon, body_effort = "normal", cache;
  std::size_t max_vertices = 64;
  bool drop_sheets = false, no_cache = false;
  CommonOptions common;

  /// Whether a URDF is written, with a folder of bodies beside it.
  [[nodiscard]] bool urdf() const;
};

void describe(CLI::App& app, SweepApproxOptions& options);

/// The bodies of links that are asked for.
certify::RobotRequest bodies_request(const SweepApproxOptions& options);
/// The swept set that is asked for, with the options as its record.
/// @param base  where the robot stands, as --base-pose; empty: at the origin
certify::SweepRequest sweep_request(const SweepApproxOptions& options, const std::string& base);

/// The format of the result.
/// @throws Error{InvalidArgument} when there is none, or another option does not go with it.
io::SetFormat output_format(const SweepApproxOptions& options);

}  // namespace kaboum::tools
