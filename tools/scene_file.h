#pragma once

#include <kaboum/world/scene.h>

#include <string>
#include <vector>

namespace kaboum::tools {

/// A world as read from its scene file, and the files that it was read from.
struct SceneFile {
  world::World world;
  std::string sha256;
  std::vector<std::string> inputs;  ///< the scene first
  std::vector<std::string> notes;
};

/// Files that a scene names are looked for from its folder.
/// @throws Error{InvalidInput}, see world::parse_scene.
SceneFile read_scene(const std::string& path);

/// The robot that --robot names; without a name the only one.
/// @throws Error{InvalidArgument} when there is none, or there are several without a name.
std::size_t robot_named(const world::World& world, const std::string& name);

/// @throws Error{InvalidArgument} when the robot has no such tool.
const world::ToolFrame& tool_named(const world::RobotModel& robot, const std::string& name);

}  // namespace kaboum::tools
