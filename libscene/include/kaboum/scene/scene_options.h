#pragma once

#include <kaboum/base/option.h>
#include <kaboum/scene/scene_maker.h>

namespace kaboum::scene {

/// The options of making a scene.
const std::vector<Option<SceneMaker>>& scene_options();

}  // namespace kaboum::scene
