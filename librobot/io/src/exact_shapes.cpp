// The meshes that a link's shapes stand for.

#include <kaboum/robot/exact_shapes.h>

#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>

#include <utility>

namespace kaboum::robot {
namespace {

void append(geom::Mesh& all, const geom::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

}  // namespace

geom::Mesh placed_mesh(const geom::Mesh& file, const Geometry& shape) {
  geom::Mesh out = file;
  for (geom::Vec3& v : out.vertices) v = shape.origin * v.cwiseProduct(shape.size);
  if (shape.size.prod() < 0)
    for (geom::Triangle& t : out.triangles) std::swap(t[1], t[2]);
  return out;
}

geom::Mesh exact_shapes(const std::vector<Geometry>& shapes, MeshFiles& files) {
  geom::Mesh all;
  for (const Geometry& g : shapes) {
    if (g.shape == Geometry::Shape::Mesh) {
      append(all, placed_mesh(io::read_mesh(files.only(g.mesh)).mesh, g));
    } else if (!is_point(g)) {
      append(all, *geom::convex_hull(bounding_points(g)));
    }
  }
  return all;
}

}  // namespace kaboum::robot
