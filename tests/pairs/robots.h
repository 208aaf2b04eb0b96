#pragma once

#include <kaboum/base/random.h>
#include <kaboum/pairs/decide.h>

#include <cmath>
#include <vector>

/// Robots of boxes, for tests of pairs.
namespace kaboum::test {

inline geom::Mesh box_mesh(const geom::Vec3& low, const geom::Vec3& high, bool inside_out = false) {
  geom::Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  if (inside_out)
    for (geom::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline void append(geom::Mesh& all, const geom::Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const geom::Triangle& t : mesh.triangles)
    all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

inline geom::Vec3 random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

inline Eigen::Matrix3d random_turn(Random& random) {
  const geom::Vec3 axis = (random_vector(random, 1) + geom::Vec3(0, 0, 1e-3)).normalized();
  return Eigen::AngleAxisd(random.between(-3, 3), axis).toRotationMatrix();
}

struct TestRobot {
  robot::Robot robot;
  std::vector<pairs::LinkSurface> surfaces;
};

/// A tree of links with one or two boxes each; some joints slide, are fixed, or mimic others.
inline TestRobot random_robot(std::uint64_t seed, std::uint32_t links = 6) {
  Random random(seed);
  TestRobot out;
  out.robot.name = "test";
  for (std::uint32_t l = 0; l < links; ++l) {
    out.robot.links.push_back({"l" + std::to_string(l), {}, {}});
    geom::Mesh mesh;
    for (std::size_t i = random.index(3) == 0 ? 2 : 1; i > 0; --i) {
      const geom::Vec3 middle = random_vector(random, 0.15);
      const geom::Vec3 half(random.between(0.03, 0.2), random.between(0.03, 0.1),
                            random.between(0.02, 0.1));
      append(mesh, box_mesh(middle - half, middle + half));
    }
    out.surfaces.push_back({l, std::move(mesh), {}});
    if (l == 0) continue;
    robot::Joint joint;
    joint.name = "j" + std::to_string(l);
    joint.parent = static_cast<std::uint32_t>(random.index(4) == 0 ? random.index(l) : l - 1);
    joint.origin = {random_turn(random), random_vector(random, 0.4)};
    joint.axis = (random_vector(random, 1) + geom::Vec3(1e-3, 0, 0)).normalized();
    const std::size_t kind = random.index(8);
    joint.type = kind == 0   ? robot::JointType::Fixed
                 : kind == 1 ? robot::JointType::Prismatic
                             : robot::JointType::Revolute;
    if (joint.type != robot::JointType::Fixed) {
      const bool mimics = random.index(6) == 0 && !out.robot.variables.empty();
      joint.variable = static_cast<std::uint32_t>(mimics ? random.index(out.robot.variables.size())
                                                         : out.robot.variables.size());
      joint.multiplier = mimics ? random.between(-1, 1) : 1;
      joint.offset = random.index(3) == 0 ? random.between(-0.2, 0.2) : 0;
      if (!mimics) {
        const double most =
            joint.type == robot::JointType::Prismatic ? 0.2 : random.between(0.2, 3);
        out.robot.variables.push_back(
            {joint.name, -random.between(0, most), random.between(0, most)});
      }
    }
    out.robot.joints.push_back(joint);
  }
  robot::require_valid(out.robot);
  return out;
}

inline std::vector<double> random_configuration(const robot::Robot& robot, Random& random) {
  std::vector<double> q;
  for (const robot::Variable& v : robot.variables) {
    // At the limits as often as not: the worst is often there.
    const std::size_t where = random.index(4);
    q.push_back(where == 0 ? *v.lower : where == 1 ? *v.upper : random.between(*v.lower, *v.upper));
  }
  return q;
}

}  // namespace kaboum::test
