// A robot of a scene by itself.

#include "scene_robot.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/world/scene.h>

#include <filesystem>

#include "common/report.h"

namespace kaboum::tools {

SceneRobot read_scene_robot(const std::string& scene, const std::string& name) {
  const world::World world = world::read_scene(scene).world;
  const std::size_t robot = world::robot_named(world, name);
  const std::vector<char> bytes = io::read_file(scene);
  const Json json = Json::parse(world::scene_as_json({bytes.data(), bytes.size()}, scene));
  const std::string file = json.at("robots").at(robot).at("urdf").at("file");
  const world::RobotModel& model = world.robots[robot];
  return {(std::filesystem::path(scene).parent_path() / file).string(), model.base,
          model.kinematics.variables};
}

}  // namespace kaboum::tools
