#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// What kaboum-scene is asked for.
namespace kaboum::tools {

struct SceneOptions {
  std::string scene, robot, srdf, epsilon = "1%", effort = "normal", unit = "m", cache;
  std::vector<std::string> robots, objects, primitives, regions, places, scales, packages;
  bool inner = false, inner_links = false, visual = false, no_cache = false, drop_sheets = false,
       force = false;
  std::size_t most_boxes = 20'000;
  double timeout = 0;
  CommonOptions common;
};

CLI::App* describe_make(CLI::App& app, SceneOptions& o);
CLI::App* describe_update(CLI::App& app, SceneOptions& o);
CLI::App* describe_pairs(CLI::App& app, SceneOptions& o);

}  // namespace kaboum::tools
