#pragma once

#include <kaboum/base/option.h>
#include <kaboum/scene/scene_maker.h>

namespace kaboum::scene {

/// The options of making a scene.
const std::vector<Option<SceneMaker>>& scene_options();

/// Those of them that bringing a scene up to date has, too: package-path.
const std::vector<Option<SceneMaker>>& update_options();

}  // namespace kaboum::scene
