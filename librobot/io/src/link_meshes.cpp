// The mesh files that a robot's shapes refer to, each scale of them once.

#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/mesh_files.h>

#include <algorithm>

namespace kaboum::robot {

namespace fs = std::filesystem;

bool ShapeChoice::has(const Link& link) const {
  return links.empty() || std::find(links.begin(), links.end(), link.name) != links.end();
}

LinkMeshes link_meshes(const RobotFile& robot, const ShapeChoice& choice) {
  require_links(robot, choice.links);
  LinkMeshes out;
  const auto index_of = [&](const Geometry& g) {
    const fs::path file = resolve_mesh(g.mesh, robot.path, choice.packages);
    if (std::find(out.files.begin(), out.files.end(), file) == out.files.end())
      out.files.push_back(file);
    // By its place, not by its bytes, which may refer to other files.
    std::error_code error;
    fs::path place = fs::canonical(file, error);
    if (error) place = file;
    const Vec3 scale = g.size.cwiseAbs();  // mirrored, bodies are the same
    const auto same = std::find_if(out.meshes.begin(), out.meshes.end(), [&](const LinkMesh& mesh) {
      return mesh.place == place && mesh.scale == scale;
    });
    const auto index = static_cast<std::size_t>(same - out.meshes.begin());
    if (same == out.meshes.end()) out.meshes.push_back({file, place, scale});
    return index;
  };
  for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
    const Link& link = robot.robot.links[l];
    if (!choice.has(link)) continue;
    const std::vector<Geometry>& shapes = choice.shapes_of(link);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      LinkShape shape{l, i, {}};
      if (shapes[i].shape == Geometry::Shape::Mesh) shape.mesh = index_of(shapes[i]);
      out.shapes.push_back(shape);
    }
  }
  return out;
}

}  // namespace kaboum::robot
