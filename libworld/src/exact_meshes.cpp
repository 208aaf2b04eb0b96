// The meshes behind a scene's sets.

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/exact_meshes.h>
#include <kaboum/world/scene.h>

#include <nlohmann/json.hpp>

namespace kaboum::world {
namespace fs = std::filesystem;

std::vector<ExactMesh> exact_meshes(const World& world, const fs::path& scene,
                                    const std::vector<std::string>& packages) {
  const std::vector<char> bytes = io::read_file(scene.string());
  const nlohmann::json description =
      nlohmann::json::parse(scene_as_json({bytes.data(), bytes.size()}, scene.string()));
  const fs::path folder = scene.parent_path();
  std::vector<ExactMesh> out;
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const nlohmann::json& stated = description.at("robots").at(r);
    const robot::RobotFile file =
        robot::read_robot((folder / stated.at("urdf").at("file").get<std::string>()).string());
    robot::MeshFiles meshes(file.path, packages);
    const bool visual = stated.value("shapes", "collision") == "visual";
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      const robot::Link& link = file.robot.links.at(world.robots[r].shapes[s].link);
      out.push_back({{r, s}, robot::exact_shapes(visual ? link.visual : link.collision, meshes)});
    }
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    if (world.objects[o].primitive) {
      out.push_back({{Item::kObject, o}, mesh_of(*world.objects[o].primitive)});
      continue;
    }
    const nlohmann::json& outer = description.at("objects").at(o).at("outer");
    if (!outer.contains("made_from") || outer["made_from"].empty())
      throw Error(ErrorCode::InvalidInput,
                  scene.string() + ": object '" + world.objects[o].name +
                      "' does not say in 'made_from' which mesh its set was made from: there is no "
                      "exact mesh of it");
    const std::string file =
        (folder / outer["made_from"][0].at("file").get<std::string>()).string();
    io::ReadResult read = io::read_mesh(file);
    const fs::path set = folder / outer.at("file").get<std::string>();
    io::scale(read,
              io::recorded_scale(io::read_convex_set(set).provenance.parameters, set.string()),
              file);
    out.push_back({{Item::kObject, o}, std::move(read.mesh)});
  }
  return out;
}

}  // namespace kaboum::world
