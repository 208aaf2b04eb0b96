// The meshes behind a scene's sets.

#include <kaboum/base/error.h>
#include <kaboum/execution/exact_cell.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/scene.h>

#include <nlohmann/json.hpp>

namespace kaboum::execution {
namespace fs = std::filesystem;
using nlohmann::json;

std::vector<ExactMesh> exact_meshes(const world::World& world, const fs::path& scene,
                                    const std::vector<std::string>& packages) {
  const std::vector<char> bytes = io::read_file(scene.string());
  const json description =
      json::parse(world::scene_as_json({bytes.data(), bytes.size()}, scene.string()));
  const fs::path folder = scene.parent_path();
  std::vector<ExactMesh> out;
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const json& stated = description.at("robots").at(r);
    const robot::RobotFile file =
        robot::read_robot((folder / stated.at("urdf").at("file").get<std::string>()).string());
    const bool visual = stated.value("shapes", "collision") == "visual";
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      const robot::Link& link = file.robot.links.at(world.robots[r].shapes[s].link);
      out.push_back(
          {{r, s}, robot::exact_shapes(visual ? link.visual : link.collision, file, packages)});
    }
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    if (world.objects[o].primitive) {
      out.push_back({{world::Item::kObject, o}, world::mesh_of(*world.objects[o].primitive)});
      continue;
    }
    const json& outer = description.at("objects").at(o).at("outer");
    if (!outer.contains("made_from") || outer["made_from"].empty())
      throw Error(ErrorCode::InvalidInput,
                  scene.string() + ": object '" + world.objects[o].name +
                      "' does not say in 'made_from' which mesh its set was made from: there is no "
                      "exact mesh to judge by");
    const std::string file =
        (folder / outer["made_from"][0].at("file").get<std::string>()).string();
    io::ReadResult read = io::read_mesh(file);
    const fs::path set = folder / outer.at("file").get<std::string>();
    io::scale(read,
              io::recorded_scale(io::read_convex_set(set).provenance.parameters, set.string()),
              file);
    out.push_back({{world::Item::kObject, o}, std::move(read.mesh)});
  }
  return out;
}

judge::Cell exact_cell(const world::World& world, const fs::path& scene,
                       const std::vector<std::string>& packages, Notes& notes) {
  judge::Cell cell;
  for (const world::RobotModel& robot : world.robots)
    cell.add_robot(robot.name, robot.kinematics, robot.base);
  for (const ExactMesh& exact : exact_meshes(world, scene, packages)) {
    const auto [robot, index] = exact.item;
    if (robot == world::Item::kObject)
      cell.add_object(world.objects[index].name, exact.mesh);
    else
      cell.add_link(robot, world.robots[robot].shapes[index].link, exact.mesh);
  }
  for (const world::RobotModel& robot : world.robots)
    for (const world::AllowedPair& pair : robot.allowed)
      if (pair.reason == world::AllowedPair::Reason::Stated)
        cell.allow(robot.name + "/" + robot.kinematics.links[pair.a].name,
                   robot.name + "/" + robot.kinematics.links[pair.b].name);
  for (const auto& pair : world.allowed) cell.allow(world.name_of(pair[0]), world.name_of(pair[1]));
  if (cell.open() > 0)
    notes.push_back(std::to_string(cell.open()) +
                    " of the exact meshes are not closed: what lies wholly inside of them is not "
                    "seen to touch them");
  return cell;
}

}  // namespace kaboum::execution
