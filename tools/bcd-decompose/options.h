#pragma once

#include <kaboum/certify/set_options.h>
#include <kaboum/certify/sphere_shares.h>
#include <kaboum/picture/bodies.h>

#include <optional>
#include <set>
#include <string>

#include "common/cli.h"
#include "robots/options.h"

namespace CLI {
class App;
}  // namespace CLI

/// The command line of bcd-decompose.
namespace kaboum::tools {

struct DecomposeOptions {
  certify::SetOptions set;
  std::set<std::string> stated;  ///< names of the set's options that were stated
  std::string input, output, output_format, preview, depfile;
  InputFormat input_format;
  double explode = picture::kExplode;
  std::size_t robot_bodies = 0, robot_vertices = 0;  ///< 0: not given
  certify::SphereShare share = certify::SphereShare::Farthest;
  std::optional<std::string> epsilon_map;  ///< file of regions
  std::string repair;   ///< spheres of the robot that are to be changed; empty: none
  std::string pairs;    ///< file of pairs of links that need no check; empty: none
  std::string inertia;  ///< «mass» or a density; empty: what the file says stays
  bool no_cache = false, srdf = false;
  RobotOptions robot;
  CommonOptions common;
};

void describe(CLI::App& app, DecomposeOptions& options);

/// Refuses options that mean nothing for the input, or beside others.
/// @throws Error{InvalidArgument}
void require_meaning(const CLI::App& app, const DecomposeOptions& options);

/// Of robots: what --for sets, where nothing else does.
void apply_preset(const CLI::App& app, DecomposeOptions& options);

}  // namespace kaboum::tools
