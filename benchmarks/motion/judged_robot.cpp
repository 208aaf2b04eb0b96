// Robots as exact meshes, among the objects of a problem.

#include "judged_robot.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/robot_file.h>

#include <fstream>
#include <string>

namespace kaboum::benchmarks {

using nlohmann::json;

namespace {

geom::Transform pose_of(const json& stated) {
  const json &p = stated["position"], &q = stated["quaternion"];  // x, y, z, w
  const Eigen::Quaterniond turn(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                                q[2].get<double>());
  geom::Transform out;
  out.linear = turn.normalized().toRotationMatrix();
  out.translation = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
  return out;
}

}  // namespace

std::vector<json> read_lines(const char* name) {
  std::ifstream file(name);
  std::vector<json> out;
  for (std::string line; std::getline(file, line);) out.push_back(json::parse(line));
  return out;
}

world::World with_objects(const world::World& robot, const json& objects) {
  world::World out = robot;
  for (const json& stated : objects) {
    const std::string name = stated["name"];
    const world::Primitive shape = world::parse_primitive(stated["shape"].dump(), name);
    world::Object object{name, pose_of(stated), outer_set(shape), inner_set(shape), {}, {}};
    object.primitive = shape;
    out.objects.push_back(std::move(object));
  }
  out.attachments.resize(out.objects.size());
  return out;
}

geom::Mesh mesh_of_link(const robot::Link& link, robot::MeshFiles& files) {
  geom::Mesh all;
  for (const robot::Geometry& g : link.collision) {
    using Shape = robot::Geometry::Shape;
    geom::Mesh mesh;
    geom::Vec3 scale = geom::Vec3::Ones();
    if (g.shape == Shape::Mesh) {
      mesh = io::read_mesh(files.first(g.mesh)).mesh;
      scale = g.size;
    } else {
      using Kind = world::Primitive::Kind;
      world::Primitive shape;
      shape.kind = g.shape == Shape::Box        ? Kind::Box
                   : g.shape == Shape::Cylinder ? Kind::Cylinder
                   : g.shape == Shape::Capsule  ? Kind::Capsule
                                                : Kind::Sphere;
      shape.size = g.size;
      shape.radius = g.shape == Shape::Ellipsoid ? 1 : g.size[0];
      shape.length = g.size[1];
      if (g.shape == Shape::Ellipsoid) scale = g.size;
      mesh = mesh_of(shape);
    }
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (const geom::Vec3& v : mesh.vertices)
      all.vertices.emplace_back(g.origin * v.cwiseProduct(scale));
    const bool is_mirrored = scale.prod() < 0;
    for (const geom::Triangle& t : mesh.triangles)
      all.triangles.push_back(
          {first + t[0], first + t[is_mirrored ? 2 : 1], first + t[is_mirrored ? 1 : 2]});
  }
  return all;
}

JudgedRobot::JudgedRobot(const world::RobotModel& model, const char* urdf) : model_(model) {
  const robot::RobotFile file = robot::read_robot(urdf);
  robot::MeshFiles files(file.path, {});
  for (const world::LinkShape& shape : model.shapes)
    links_.emplace_back(shape.link, mesh_of_link(file.robot.links[shape.link], files));
}

std::unique_ptr<judge::Cell> JudgedRobot::cell(const world::World& world,
                                               judge::CellState& state) const {
  auto out = std::make_unique<judge::Cell>();
  out->add_robot(model_.name, model_.kinematics, model_.base);
  for (const auto& [link, mesh] : links_) out->add_link(0, link, mesh);
  for (const world::AllowedPair& pair : model_.allowed)
    if (pair.reason == world::AllowedPair::Reason::Stated)
      out->allow(model_.name + "/" + model_.kinematics.links[pair.a].name,
                 model_.name + "/" + model_.kinematics.links[pair.b].name);
  state = {{model_.home}, {}};
  for (const world::Object& object : world.objects) {
    out->add_object(object.name, mesh_of(*object.primitive));
    state.objects.push_back({object.pose, {}, false});
  }
  return out;
}

}  // namespace kaboum::benchmarks
