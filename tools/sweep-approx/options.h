#pragma once

#include <kaboum/certify/sweep_options.h>
#include <kaboum/io/convex_io.h>

#include <set>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// The command line of sweep-approx.
namespace kaboum::tools {

struct SweepApproxOptions {
  certify::SweptSetOptions sweep;
  std::set<std::string> stated;  ///< names of the set's options that were stated
  std::string robot, scene, robot_name, path, output, output_format, preview, depfile, prefix,
      cache;
  std::vector<std::string> xacro_arguments;
  bool no_cache = false;
  CommonOptions common;

  /// Whether a URDF is written, with a folder of bodies beside it.
  [[nodiscard]] bool urdf() const;
};

void describe(CLI::App& app, SweepApproxOptions& options);

/// The format of the result.
/// @throws Error{InvalidArgument} when there is none, or another option does not go with it.
io::SetFormat output_format(const SweepApproxOptions& options);

}  // namespace kaboum::tools
