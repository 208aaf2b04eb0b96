// MuJoCo loads the MJCF files: links are where our kinematics puts them, with the joints, masses
// and bodies of the robot.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <memory>

#include "expected.h"
#include "models.h"

namespace engines {
namespace {

using kaboum::robot::JointType;
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct Loaded {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data{nullptr, mj_deleteData};
};

Loaded load(const std::filesystem::path& urdf) {
  const std::filesystem::path file = std::filesystem::path(urdf).replace_extension(".xml");
  std::array<char, 1000> error{};
  Loaded out;
  out.model.reset(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
  EXPECT_TRUE(out.model) << file << ": " << error.data();
  if (out.model) out.data.reset(mj_makeData(out.model.get()));
  return out;
}

int body_of(const mjModel& m, const kaboum::robot::Robot& robot, std::size_t link) {
  if (link == 0 && robot.links[0].name == "world") return 0;
  return mj_name2id(&m, mjOBJ_BODY, robot.links[link].name.c_str());
}

Matrix matrix(const mjtNum* m) { return Eigen::Map<const Matrix>(m); }
Eigen::Vector3d vector(const mjtNum* v) { return {v[0], v[1], v[2]}; }

TEST(Mjcf, LinksAreWhereOurKinematicsPutsThem) {
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const std::vector<double> q = configuration(w.robot, seed);
      int set = 0;
      for (const kaboum::robot::Joint& joint : w.robot.joints) {
        const int id = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
        if (id < 0) continue;
        loaded.data->qpos[m.jnt_qposadr[id]] = value_of(joint, q);
        ++set;
      }
      EXPECT_EQ(set, m.njnt) << w.urdf;
      mj_kinematics(&m, loaded.data.get());
      const auto poses = kaboum::robot::forward(w.robot, q);
      for (std::size_t l = 0; l < poses.size(); ++l) {
        const int body = body_of(m, w.robot, l);
        ASSERT_GE(body, 0) << w.urdf << ": " << w.robot.links[l].name;
        expect_pose(poses[l], matrix(loaded.data->xmat + 9 * body),
                    vector(loaded.data->xpos + 3 * body),
                    w.urdf.string() + ": " + w.robot.links[l].name);
      }
    }
  }
}

TEST(Mjcf, JointsHaveTheirLimits) {
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    for (const kaboum::robot::Joint& joint : w.robot.joints) {
      const int id = mj_name2id(&m, mjOBJ_JOINT, joint.name.c_str());
      const bool moves = joint.type != JointType::Fixed;
      const kaboum::robot::Variable* v = moves ? &w.robot.variables[joint.variable] : nullptr;
      const bool one = moves && v->lower && v->upper && *v->lower == *v->upper;
      EXPECT_EQ(id >= 0, moves && !one) << joint.name;
      if (id < 0) continue;
      EXPECT_EQ(m.jnt_type[id], joint.type == JointType::Revolute ? mjJNT_HINGE : mjJNT_SLIDE);
      const auto& dynamics = w.dynamics.joints.at(joint.name);
      EXPECT_EQ(m.dof_damping[m.jnt_dofadr[id]], dynamics.damping);
      EXPECT_EQ(m.dof_frictionloss[m.jnt_dofadr[id]], dynamics.friction);
      const bool leads = v->name == joint.name;
      EXPECT_EQ(m.jnt_limited[id] != 0, leads && v->lower.has_value()) << joint.name;
      if (!leads || !v->lower) continue;
      EXPECT_EQ(m.jnt_range[2 * id], *v->lower);
      EXPECT_EQ(m.jnt_range[2 * id + 1], *v->upper);
    }
  }
}

TEST(Mjcf, JointsMimicThoseThatTheyFollow) {
  int all = 0;
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    int ties = 0;
    for (const kaboum::robot::Joint& joint : w.robot.joints) {
      if (joint.type == JointType::Fixed) continue;
      const std::string& leader = w.robot.variables[joint.variable].name;
      if (leader == joint.name) continue;
      ASSERT_LT(ties, m.neq);
      const int e = ties++;
      EXPECT_EQ(m.eq_type[e], mjEQ_JOINT);
      EXPECT_EQ(mj_id2name(&m, mjOBJ_JOINT, m.eq_obj1id[e]), joint.name);
      EXPECT_EQ(mj_id2name(&m, mjOBJ_JOINT, m.eq_obj2id[e]), leader);
      EXPECT_EQ(m.eq_data[mjNEQDATA * e], joint.offset);
      EXPECT_EQ(m.eq_data[mjNEQDATA * e + 1], joint.multiplier);
    }
    EXPECT_EQ(m.neq, ties) << w.urdf;
    all += ties;
  }
  EXPECT_GT(all, 0);
}

TEST(Mjcf, LinksHaveTheirMasses) {
  std::size_t compared = 0;
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    for (std::size_t l = 0; l < w.robot.links.size(); ++l) {
      const auto found = w.dynamics.links.find(w.robot.links[l].name);
      const int body = body_of(m, w.robot, l);
      if (found == w.dynamics.links.end() || body <= 0 || !(found->second.mass > 0)) continue;
      const kaboum::robot::Inertial& i = found->second;
      EXPECT_EQ(m.body_mass[body], i.mass);
      EXPECT_LT((vector(m.body_ipos + 3 * body) - i.origin.translation).norm(), 1e-12);
      if (w.robot.links[l].name == "locked") {  // its inertia, of 1, 1 and 3, is that of no body
        EXPECT_NEAR(vector(m.body_inertia + 3 * body).maxCoeff(), 4, 1e-6);
        continue;
      }
      std::array<mjtNum, 9> rotation{};
      mju_quat2Mat(rotation.data(), m.body_iquat + 4 * body);
      const Eigen::Matrix3d r = matrix(rotation.data());
      const Eigen::Matrix3d there =
          r * vector(m.body_inertia + 3 * body).asDiagonal() * r.transpose();
      const Eigen::Matrix3d here = i.origin.linear * i.inertia * i.origin.linear.transpose();
      EXPECT_LT((there - here).cwiseAbs().maxCoeff(),
                1e-7 * here.norm())  // its eigenvectors end there
          << w.urdf << ": " << w.robot.links[l].name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 8U);
}

Measure measured(const mjModel& m, const mjData& d, int geom) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = vector(d.geom_xpos + 3 * geom);
  pose.linear() = matrix(d.geom_xmat + 9 * geom);
  const mjtNum* size = m.geom_size + 3 * geom;
  if (m.geom_type[geom] == mjGEOM_BOX) return measure_box(pose, 2 * vector(size));
  if (m.geom_type[geom] == mjGEOM_CYLINDER) return measure_cylinder(pose, size[0], 2 * size[1]);
  if (m.geom_type[geom] == mjGEOM_SPHERE) return measure_sphere(pose, size[0]);
  const int mesh = m.geom_dataid[geom];
  std::vector<Eigen::Vector3d> corners;
  for (int f = 0; f < 3 * m.mesh_facenum[mesh]; ++f) {
    const int v = m.mesh_vertadr[mesh] + m.mesh_face[3 * m.mesh_faceadr[mesh] + f];
    corners.emplace_back(
        pose * Eigen::Vector3d(m.mesh_vert[3 * v], m.mesh_vert[3 * v + 1], m.mesh_vert[3 * v + 2]));
  }
  Measure out = measure(mj_id2name(&m, mjOBJ_MESH, mesh), corners);
  out.volume = std::abs(out.volume);
  return out;
}

TEST(Mjcf, HasTheBodiesThatWereWritten) {
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    const Robot robot = read_urdf(w.urdf, w.prefix.empty() ? "" : "package://" + w.prefix);
    mj_kinematics(&m, loaded.data.get());  // all joints at zero
    std::map<std::string, std::vector<Measure>> there;
    for (int g = 0; g < m.ngeom; ++g) {
      const int body = m.geom_bodyid[g];
      there[body == 0 ? robot.root : mj_id2name(&m, mjOBJ_BODY, body)].push_back(
          measured(m, *loaded.data, g));
    }
    for (const auto& [link, measures] : bodies_by(robot, &Link::name)) {
      if (link == "locked" || link == "right") continue;  // zero is elsewhere, not allowed
      expect_same(w.urdf.string() + ", link '" + link + "'", measures, there[link]);
    }
  }
}

TEST(Mjcf, NeighboursDoNotCollide) {
  for (const WrittenRobot& w : written()) {
    const Loaded loaded = load(w.urdf);
    if (!loaded.model) continue;
    const mjModel& m = *loaded.model;
    mj_forward(&m, loaded.data.get());
    for (int c = 0; c < loaded.data->ncon; ++c) {
      const mjContact& contact = loaded.data->contact[c];
      const int a = m.body_weldid[m.geom_bodyid[contact.geom1]],
                b = m.body_weldid[m.geom_bodyid[contact.geom2]];
      const int above_a = m.body_weldid[m.body_parentid[a]],
                above_b = m.body_weldid[m.body_parentid[b]];
      EXPECT_FALSE(a == b || above_a == b || above_b == a)
          << w.urdf << ": " << mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[contact.geom1]) << " and "
          << mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[contact.geom2]);
    }
  }
}

}  // namespace
}  // namespace engines
