#pragma once

#include <kaboum/certify/mesh.h>

#include <optional>
#include <string>
#include <vector>

#include "cli.h"
#include "holes_option.h"
#include "preparation_option.h"
#include "robot_options.h"
#include "unit_option.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What bmesh-decimate is asked for, as it is given.
struct DecimationOptions {
  std::string input, output, input_format, output_format;
  std::string direction = "outer", cost = "distance", effort = "normal", precision = "auto";
  std::string vertices, epsilon, progressive, from, log, depfile, preview;
  double ratio = 0;  ///< 0: none
  std::optional<double> max_work;
  std::optional<double> sharp_angle;
  bool effort_given = false, as_printed = false, keep_convex = false, verify = false;
  geom::PrepareOptions prepare;
  HolesOption holes;
  PreparationOption preparation;
  UnitOption unit;
  RobotOptions robot;
  bool no_cache = false;  ///< of robots
  CommonOptions common;

  /// Whether the steps are asked for.
  [[nodiscard]] bool records() const { return !log.empty() || !progressive.empty(); }
};

void describe(CLI::App& app, DecimationOptions& options);

const char* name_of(bmesh::Effort effort);

/// Refuses what contradicts itself, before anything is looked at.
/// @param counts  of --vertices
/// @throws Error{InvalidArgument}
void require_sound(const DecimationOptions& options, const std::vector<std::size_t>& counts);

/// Refuses what the output's format (nullopt: no output) or the direction cannot give.
/// @throws Error{InvalidArgument}
void require_sound_formats(const DecimationOptions& options, std::optional<io::Format> format);

certify::MeshRequest request_of(const DecimationOptions& options, std::vector<std::size_t> counts,
                                std::optional<io::Format> format);

}  // namespace kaboum::tools
