#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// What kaboum-check is asked for.
namespace kaboum::tools {

struct CheckOptions {
  std::string scene, robot, path, configuration, configurations, resolution = "1e-5", preview;
  std::vector<std::string> joints, inside;
  bool degrees = false, ignore_limits = false, resting = false, distance = false;
  std::size_t most_intervals = 1'000'000;
  CommonOptions common;
};

void describe(CLI::App& app, CheckOptions& o);

}  // namespace kaboum::tools
