#pragma once

#include <kaboum/world/scene.h>

namespace kaboum::tools {

using world::read_scene;
using world::robot_named;
using world::SceneFile;
using world::tool_named;

}  // namespace kaboum::tools
