// Scenes from the file system.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <filesystem>

namespace kaboum::world {

SceneFile read_scene(const std::string& path) {
  SceneFile out;
  out.inputs.push_back(path);
  const std::vector<char> bytes = io::read_file(path);
  out.sha256 = io::sha256(bytes);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  SceneNotes notes;
  out.world = parse_scene(
      {bytes.data(), bytes.size()}, path,
      [&](const std::string& file) {
        out.inputs.push_back((folder / file).string());
        return io::read_file(folder / file);
      },
      &notes);
  out.notes = std::move(notes.notes);
  return out;
}

std::size_t robot_named(const World& world, const std::string& name) {
  std::vector<std::string> names;
  for (const RobotModel& robot : world.robots) names.push_back(robot.name);
  if (name.empty()) {
    if (names.size() == 1) return 0;
    throw Error(ErrorCode::InvalidArgument,
                names.empty() ? "the scene has no robot"
                              : "the scene has several robots: name one («robot»)");
  }
  if (const auto robot = world.find_robot(name)) return *robot;
  throw Error(ErrorCode::InvalidArgument,
              "«robot»: the scene has no robot '" + name + "'" + did_you_mean(name, names));
}

const ToolFrame& tool_named(const RobotModel& robot, const std::string& name) {
  if (robot.tools.empty())
    throw Error(ErrorCode::InvalidArgument, "«tool»: robot '" + robot.name +
                                                "' has no tools; the scene states them as " +
                                                std::string(kToolExample));
  if (name.empty() && robot.tools.size() == 1) return robot.tools.front();
  std::vector<std::string> names;
  std::string all;
  for (const ToolFrame& tool : robot.tools) {
    if (tool.name == name) return tool;
    names.push_back(tool.name);
    all += (all.empty() ? "" : ", ") + tool.name;
  }
  throw Error(ErrorCode::InvalidArgument,
              "«tool»: robot '" + robot.name +
                  (name.empty() ? "' has several tools: name one of " + all
                                : "' has no tool '" + name + "'" + did_you_mean(name, names)));
}

}  // namespace kaboum::world
