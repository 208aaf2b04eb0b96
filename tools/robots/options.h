#pragma once

#include <kaboum/certify/preparation_options.h>
#include <kaboum/certify/wanted_meshes.h>
#include <kaboum/robot/link_meshes.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// The options of tools that make robots with other shapes.
namespace kaboum::tools {

struct RobotOptions {
  robot::ShapeChoice shapes;
  std::set<std::string> stated;  ///< names of the options of shapes that were stated
  std::string prefix, epsilons, html, preset;
  std::vector<std::string> formats;  ///< that are written besides URDF
  std::vector<std::string> xacro_arguments;
  std::string bodies = "stl";   ///< format of convex bodies' files
  bool declare_convex = false;  ///< in the URDF, as Drake asks for
  bool verbose = false;         ///< a line for each mesh, and all notes

  [[nodiscard]] bool writes(const std::string& format) const;
};

/// Whether the name is that of a robot.
bool is_robot(const std::string& path);

/// @param from  whether --from collision|visual is one of the options here
void add_robot_options(CLI::App& app, RobotOptions& options, bool from);

/// Adds --require-closed, the same as --holes refuse under the name that it had.
void add_require_closed(CLI::App& app, certify::PreparationOptions& options);

/// Options that a plain mesh has no use for are mistakes.
/// @throws Error{InvalidArgument}
void require_options_of_meshes(const CLI::App& app, const std::string& input);

/// What --for sets, where it is not set by options.
/// @param folder  the output
/// @param thickness  --min-thickness, where the tool has it
void apply_preset(const CLI::App& app, const std::string& folder, RobotOptions& options,
                  std::optional<Length>* thickness);

/// What the file of --epsilons says; nothing where the option is not given.
/// @throws Error as parse_epsilons (link_epsilons.h); Error{InvalidInput} when it cannot be read.
certify::LinkEpsilons read_epsilons(const std::string& file, const robot::Robot& robot);

}  // namespace kaboum::tools
