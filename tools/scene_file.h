#pragma once

#include <kaboum/world/scene.h>

#include <string>

namespace kaboum::tools {

using world::read_scene;
using world::SceneFile;

/// The robot that --robot names; without a name the only one.
/// @throws Error{InvalidArgument} when there is none, or there are several without a name.
std::size_t robot_named(const world::World& world, const std::string& name);

/// @throws Error{InvalidArgument} when the robot has no such tool.
const world::ToolFrame& tool_named(const world::RobotModel& robot, const std::string& name);

}  // namespace kaboum::tools
