#pragma once

#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_maker.h>
#include <kaboum/world/allowed_pairs.h>

#include <set>
#include <string>
#include <vector>

#include "common/cli.h"

namespace CLI {
class App;
}  // namespace CLI

/// What kaboum-scene is asked for.
namespace kaboum::tools {

struct SceneOptions {
  std::string scene, robot, srdf, cache, preview;
  std::vector<std::string> robots, objects, primitives, regions, places, scales;
  scene::SceneMaker make;  ///< but for what these name; of update, its packages
  bool no_cache = false;
  world::PairOptions pairs;
  scene::GraspRequest derived_grasps;
  scene::PlaceRequest derived_places;
  std::set<std::string> stated;  ///< names of options of requests that were stated
  CommonOptions common;
};

CLI::App* describe_make(CLI::App& app, SceneOptions& o);
CLI::App* describe_update(CLI::App& app, SceneOptions& o);
CLI::App* describe_pairs(CLI::App& app, SceneOptions& o);
CLI::App* describe_grasps(CLI::App& app, SceneOptions& o);
CLI::App* describe_places(CLI::App& app, SceneOptions& o);

}  // namespace kaboum::tools
