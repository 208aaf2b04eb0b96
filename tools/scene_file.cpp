// Robots and tools of a scene that options name.

#include "scene_file.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>

#include <string>
#include <vector>

namespace kaboum::tools {

std::size_t robot_named(const world::World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const world::RobotModel& robot : world.robots) names.push_back(robot.name);
  if (name.empty()) {
    if (names.size() == 1) return 0;
    throw Error(ErrorCode::InvalidArgument, names.empty()
                                                ? "the scene has no robot"
                                                : "the scene has several robots: give --robot");
  }
  if (const auto robot = world.find_robot(name)) return *robot;
  throw Error(ErrorCode::InvalidArgument,
              "--robot: the scene has no robot '" + name + "'" + did_you_mean(name, names));
}

const world::ToolFrame& tool_named(const world::RobotModel& robot, const std::string& name) {
  std::vector<std::string> names;
  for (const world::ToolFrame& tool : robot.tools) {
    if (tool.name == name) return tool;
    names.push_back(tool.name);
  }
  throw Error(ErrorCode::InvalidArgument, "--tool: robot '" + robot.name + "' has no tool '" +
                                              name + "'" + did_you_mean(name, names));
}

}  // namespace kaboum::tools
