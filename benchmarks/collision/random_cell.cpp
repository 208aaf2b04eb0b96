// Random objects, random configurations, and the exact meshes of both.

#include "random_cell.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/link_meshes.h>

#include <algorithm>

namespace kaboum::collide {

std::vector<double> random_values(const robot::Robot& robot, std::mt19937_64& random) {
  std::vector<double> q;
  for (const robot::Variable& v : robot.variables)
    q.push_back(std::uniform_real_distribution<double>(std::max(v.lower.value_or(-3), -3.0),
                                                       std::min(v.upper.value_or(3), 3.0))(random));
  return q;
}

void scatter_objects(world::World& world, std::mt19937_64& random) {
  std::uniform_real_distribution<double> from(-1, 1);
  double reach = 0;
  for (const robot::Joint& joint : world.robots.at(0).kinematics.joints)
    reach += joint.origin.translation.norm();
  for (world::Object& o : world.objects) {
    geom::Vec3 at;
    do {
      at = reach * geom::Vec3(from(random), from(random), from(random));
    } while (at.head<2>().norm() < 0.3 * reach || at.norm() > 1.1 * reach);
    const geom::Vec3 axis = geom::Vec3(from(random), from(random), from(random)).normalized();
    o.pose = {robot::rotation_about(axis, 3 * from(random)), at};
  }
}

Model triangles_of(const world::World& world, const robot::RobotFile& file,
                   const geom::Mesh& object) {
  Model out{"triangles", false, 0, {}, {}};
  const robot::LinkMeshes meshes = link_meshes(file, {});
  for (const robot::LinkShape& shape : meshes.shapes) {
    const robot::Geometry& g = file.robot.links[shape.link].collision[shape.index];
    if (!shape.mesh) continue;
    geom::Mesh mesh = io::read_mesh(meshes.meshes[*shape.mesh].file).mesh;
    for (geom::Vec3& v : mesh.vertices) v = g.origin * v.cwiseProduct(g.size);
    out.robot.push_back({shape.link, std::move(mesh)});
  }
  for (const world::Object& o : world.objects) out.scene.push_back(placed(object, o.pose));
  return out;
}

geom::Mesh placed(geom::Mesh mesh, const geom::Transform& pose) {
  for (geom::Vec3& v : mesh.vertices) v = pose * v;
  return mesh;
}

}  // namespace kaboum::collide
