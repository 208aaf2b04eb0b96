// Robots and tools of a scene that options name.

#include "scene_file.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>

#include <string>
#include <vector>

namespace kaboum::tools {

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
