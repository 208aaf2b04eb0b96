#pragma once

#include <kaboum/robot/robot_file.h>

#include <string>

namespace kaboum::tools {

/// Where a robot of a scene stands, and its file.
struct SceneRobot {
  std::string file;  ///< URDF
  robot::Transform base;
  std::vector<robot::Variable> variables;  ///< with the limits that the scene states
};

/// @param name  empty: the only one.
/// @throws Error{InvalidArgument} when the scene has no such robot; as read_scene.
SceneRobot read_scene_robot(const std::string& scene, const std::string& name);

}  // namespace kaboum::tools
