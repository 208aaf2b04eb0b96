#pragma once

#include <kaboum/certify/convex_set.h>

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "holes_option.h"
#include "preparation_option.h"
#include "robot_options.h"

namespace CLI {
class App;
}  // namespace CLI

/// The command line of bcd-decompose.
namespace kaboum::tools {

struct DecomposeOptions {
  std::string input, output, input_format, output_format, epsilon, direction = "outer";
  std::string effort = "normal", method = "planes", pre_step = "auto";
  std::string unit = "m", frame, preview, depfile;
  std::size_t max_bodies = 0, max_vertices = 64, max_total = 0;  ///< 0: not given
  double explode = 0.5, min_thickness = 0, scale = 1;
  std::optional<double> simplify, max_work, improve_work;
  std::size_t robot_bodies = 0, robot_vertices = 0;  ///< 0: not given
  bool no_cache = false, srdf = false;
  geom::PrepareOptions prepare;
  HolesOption holes;
  PreparationOption preparation;
  RobotOptions robot;
  CommonOptions common;
};

void describe(CLI::App& app, DecomposeOptions& options);

/// Refuses options that mean nothing for the input, or beside others.
/// @throws Error{InvalidArgument}
void require_meaning(const CLI::App& app, const DecomposeOptions& options);

/// Of robots: what --for sets, where nothing else does.
void apply_preset(const CLI::App& app, DecomposeOptions& options);

/// What the options ask for.
certify::SetRequest request_of(const DecomposeOptions& options);

}  // namespace kaboum::tools
