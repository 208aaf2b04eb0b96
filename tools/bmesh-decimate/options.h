#pragma once

#include <kaboum/certify/mesh_options.h>

#include <optional>
#include <set>
#include <string>

#include "common/cli.h"
#include "common/unit_option.h"
#include "robots/options.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What bmesh-decimate is asked for, as it is given.
struct DecimationOptions {
  certify::MeshOptions mesh;
  std::set<std::string> stated;  ///< names of the mesh's options that were stated
  std::string input, output, output_format;
  InputFormat input_format;
  std::string progressive, from, log, depfile, preview;
  UnitOption unit;
  RobotOptions robot;
  bool no_cache = false;  ///< of robots
  CommonOptions common;

  /// The value of an option of the mesh, in the option's words.
  [[nodiscard]] std::string value(const char* name) const {
    return value_of(certify::mesh_options(), name, mesh);
  }
  /// Whether the steps are asked for.
  [[nodiscard]] bool records() const { return !log.empty() || !progressive.empty(); }
  [[nodiscard]] bool wraps() const {
    return mesh.preparation.mode == certify::PreparationOptions::Mode::Wrap;
  }
};

void describe(CLI::App& app, DecimationOptions& options);

/// Refuses what contradicts itself, before anything is looked at.
/// @throws Error{InvalidArgument}
void require_sound(const DecimationOptions& options);

/// Refuses what the output's format (nullopt: no output) or the direction cannot give.
/// @throws Error{InvalidArgument}
void require_sound_formats(const DecimationOptions& options, std::optional<io::Format> format);

/// What is asked of a mesh, with what the files that are written need besides.
certify::MeshOptions mesh_options_of(const DecimationOptions& options,
                                     std::optional<io::Format> format);

}  // namespace kaboum::tools
