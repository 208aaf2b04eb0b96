#pragma once

#include <kaboum/world/scene.h>

#include <string>

namespace kaboum::tools {

using world::read_scene;
using world::robot_named;
using world::SceneFile;

/// @throws Error{InvalidArgument} when the robot has no such tool.
const world::ToolFrame& tool_named(const world::RobotModel& robot, const std::string& name);

}  // namespace kaboum::tools
