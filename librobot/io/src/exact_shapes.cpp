// The meshes that a link's shapes stand for.

#include <kaboum/robot/exact_shapes.h>

#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>

namespace kaboum::robot {
namespace {

void append(geom::Mesh& all, const geom::Mesh& mesh, const Geometry& g) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  for (const geom::Vec3& v : mesh.vertices)
    all.vertices.emplace_back(g.origin * v.cwiseProduct(g.size));
  const bool mirrored = g.size.prod() < 0;
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back(mirrored ? geom::Triangle{first + t[0], first + t[2], first + t[1]}
                                     : geom::Triangle{first + t[0], first + t[1], first + t[2]});
}

}  // namespace

geom::Mesh exact_shapes(const std::vector<Geometry>& shapes, const RobotFile& robot,
                        const std::vector<std::string>& packages) {
  geom::Mesh all;
  for (const Geometry& g : shapes) {
    if (g.shape == Geometry::Shape::Mesh) {
      append(all, io::read_mesh(resolve_mesh(g.mesh, robot.path, packages)).mesh, g);
    } else if (!is_point(g)) {
      append(all, *geom::convex_hull(bounding_points(g)), Geometry{});
    }
  }
  return all;
}

}  // namespace kaboum::robot
