// MuJoCo loads the outputs as they are, and collides what was written.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "expected.h"

namespace engines {
namespace {

struct Loaded {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model;
  std::unique_ptr<mjData, void (*)(mjData*)> data;
};

Loaded load(const std::filesystem::path& urdf) {
  std::array<char, 1000> error{};
  Loaded out{{mj_loadXML(urdf.c_str(), nullptr, error.data(), error.size()), mj_deleteModel},
             {nullptr, mj_deleteData}};
  EXPECT_TRUE(out.model) << urdf << ": " << error.data();
  if (out.model) {
    out.data.reset(mj_makeData(out.model.get()));
    mj_kinematics(out.model.get(), out.data.get());
  }
  return out;
}

/// Corners of the triangles of the hull that MuJoCo has made for collisions.
std::vector<Eigen::Vector3d> hull_of(const mjModel& m, int mesh, const Eigen::Isometry3d& pose) {
  std::vector<Eigen::Vector3d> corners;
  const int adr = m.mesh_graphadr[mesh];
  if (adr < 0) return corners;
  const int* graph = m.mesh_graph + adr;
  const int vertices = graph[0], faces = graph[1];
  const int* corner = graph + 2 + 3 * vertices + 3 * faces;
  for (int i = 0; i < 3 * faces; ++i) {
    const float* v = m.mesh_vert + 3 * (m.mesh_vertadr[mesh] + corner[i]);
    corners.emplace_back(pose * Eigen::Vector3d(v[0], v[1], v[2]));
  }
  return corners;
}

Measure measure_geom(const mjModel& m, const mjData& d, int geom) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    pose.translation()[i] = d.geom_xpos[3 * geom + i];
    for (int k = 0; k < 3; ++k) pose.linear()(i, k) = d.geom_xmat[9 * geom + 3 * i + k];
  }
  const mjtNum* size = m.geom_size + 3 * geom;
  switch (m.geom_type[geom]) {
    case mjGEOM_BOX:
      return measure_box(pose, 2 * Eigen::Vector3d(size[0], size[1], size[2]));
    case mjGEOM_CYLINDER:
      return measure_cylinder(pose, size[0], 2 * size[1]);
    case mjGEOM_SPHERE:
      return measure_sphere(pose, size[0]);
    default:
      break;
  }
  const int mesh = m.geom_dataid[geom];
  Measure out = measure(mj_id2name(&m, mjOBJ_MESH, mesh), hull_of(m, mesh, pose));
  out.volume = std::abs(out.volume);  // mirrored ones have their hull's triangles turned
  return out;
}

TEST(MuJoCo, HasTheBodiesThatWereWritten) {
  for (const std::filesystem::path& urdf : outputs()) {
    const Robot robot = read_urdf(urdf);
    const Loaded loaded = load(urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    // What no joint moves is the world's.
    std::map<std::string, std::vector<Measure>> bodies;
    for (int g = 0; g < m.ngeom; ++g) {
      const std::string body = mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[g]);
      bodies[body == "world" ? robot.root : body].push_back(measure_geom(m, *loaded.data, g));
    }
    const auto expected = bodies_by(robot, &Link::top);
    EXPECT_EQ(bodies.size(), expected.size()) << urdf;
    for (const auto& [link, measures] : expected)
      expect_same(urdf.string() + ", link '" + link + "'", measures, bodies[link]);
  }
}

TEST(MuJoCo, HasLinksWhereTheJointsPutThem) {
  for (const std::filesystem::path& urdf : outputs()) {
    const Robot robot = read_urdf(urdf);
    const Loaded loaded = load(urdf);
    if (!loaded.model) continue;
    for (const Link& link : robot.links) {
      const int body = mj_name2id(loaded.model.get(), mjOBJ_BODY, link.name.c_str());
      const bool kept = link.name == "world" || (link.top == link.name && link.name != robot.root);
      EXPECT_EQ(body >= 0, kept) << link.name;
      if (body < 0) continue;
      const mjtNum* x = loaded.data->xpos + 3 * body;
      const mjtNum* r = loaded.data->xmat + 9 * body;
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(x[i], link.pose.translation()[i], 1e-6) << urdf << ": " << link.name;
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(r[3 * i + k], link.pose.linear()(i, k), 1e-6) << urdf << ": " << link.name;
      }
    }
  }
}

}  // namespace
}  // namespace engines
