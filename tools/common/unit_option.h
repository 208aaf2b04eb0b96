#pragma once

#include <kaboum/io/mesh_io.h>

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What a user says about the lengths of a file.
struct UnitOption {
  std::string unit;  ///< of the coordinates as scaled, where the file states none; empty: not said
  double scale = 1;

  /// " --scale 0.001", as a record of what was done; empty where nothing was.
  [[nodiscard]] std::string words() const;
};

/// Adds --scale. @param of  whose coordinates: "INPUT"
void add_scale_option(CLI::App& app, double& scale, const std::string& of);

/// Adds --unit and --scale.
void add_unit_options(CLI::App& app, UnitOption& option, const std::string& of);

/// Scales what was read, and gives it the unit that is said.
/// @throws Error{InvalidInput} as io::scale; where the file states another unit.
void apply(io::ReadResult& read, const UnitOption& option, const std::string& name);

}  // namespace kaboum::tools
