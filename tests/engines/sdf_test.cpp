// libsdformat loads the SDF files: its frames and axes, put together, move links as our kinematics
// does, with the limits, masses and bodies of the robot.

#include <gtest/gtest.h>
#include <sdf/sdf.hh>

#include "expected.h"
#include "models.h"
#include "sdf_collision.h"

namespace engines {
namespace {

using kaboum::robot::Transform;

Transform transform(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  return {Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).toRotationMatrix(), vector(pose.Pos())};
}

struct Loaded {
  sdf::Root root;
  const sdf::Model* model = nullptr;
  std::vector<std::string> links, joints;  ///< names in SDF, by index
};

/// The names that outputs.sh has for what SDF keeps for itself, as they are written.
std::string name_in_sdf(const kaboum::robot::Link& link) {
  if (link.name == "__flange__") return "__flange__link";
  if (link.name == "tool::tip") return "tool_tip";
  return link.name == "world" && !link.collision.empty() ? "world-2" : link.name;
}

void load(const WrittenRobot& w, Loaded& out) {
  const std::string file = std::filesystem::path(w.urdf).replace_extension(".sdf").string();
  for (const sdf::Error& error : out.root.Load(file)) ADD_FAILURE() << file << ": " << error;
  out.model = out.root.Model();
  ASSERT_NE(out.model, nullptr) << file;
  for (const kaboum::robot::Link& link : w.robot.links) out.links.push_back(name_in_sdf(link));
  for (const kaboum::robot::Joint& joint : w.robot.joints)
    out.joints.push_back(joint.name == "arm" ? "arm-2" : joint.name);
}

/// Poses from what libsdformat says of frames and axes.
std::vector<Transform> forward(const WrittenRobot& w, const Loaded& loaded,
                               const std::vector<double>& q) {
  std::vector<Transform> poses(w.robot.links.size());
  for (std::size_t j = 0; j < w.robot.joints.size(); ++j) {
    const kaboum::robot::Joint& joint = w.robot.joints[j];
    const sdf::Joint* there = loaded.model->JointByName(loaded.joints[j]);
    const sdf::Link* child = loaded.model->LinkByName(loaded.links[j + 1]);
    if (there == nullptr || child == nullptr) {
      ADD_FAILURE() << loaded.joints[j] << " or " << loaded.links[j + 1] << " is not there";
      continue;
    }
    EXPECT_EQ(there->ParentLinkName(), loaded.links[joint.parent]);
    EXPECT_EQ(there->ChildLinkName(), loaded.links[j + 1]);
    const std::string& parent = loaded.links[joint.parent];
    ignition::math::Pose3d origin, in_joint;
    EXPECT_TRUE(
        there->SemanticPose().Resolve(origin, parent == "world" ? "__model__" : parent).empty());
    EXPECT_TRUE(child->SemanticPose().Resolve(in_joint, loaded.joints[j]).empty());
    Transform motion;
    if (joint.type != kaboum::robot::JointType::Fixed) {
      ignition::math::Vector3d axis;
      EXPECT_TRUE(there->Axis()->ResolveXyz(axis, loaded.joints[j]).empty());
      const Eigen::Vector3d a = vector(axis);
      const double value = value_of(joint, q);
      if (there->Type() == sdf::JointType::PRISMATIC)
        motion.translation = value * a;
      else
        motion.linear = Eigen::AngleAxisd(value, a.normalized()).toRotationMatrix();
    }
    poses[j + 1] = poses[joint.parent] * transform(origin) * motion * transform(in_joint);
  }
  return poses;
}

TEST(Sdf, LinksAreWhereOurKinematicsPutsThem) {
  for (const WrittenRobot& w : written()) {
    Loaded loaded;
    load(w, loaded);
    if (loaded.model == nullptr) continue;
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const std::vector<double> q = configuration(w.robot, seed);
      const auto ours = kaboum::robot::forward(w.robot, q), theirs = forward(w, loaded, q);
      for (std::size_t l = 0; l < ours.size(); ++l)
        expect_pose(ours[l], theirs[l].linear, theirs[l].translation,
                    w.urdf.string() + ": " + w.robot.links[l].name);
    }
  }
}

TEST(Sdf, JointsHaveTheirLimits) {
  for (const WrittenRobot& w : written()) {
    Loaded loaded;
    load(w, loaded);
    if (loaded.model == nullptr) continue;
    EXPECT_EQ(loaded.model->JointCount(), w.robot.joints.size());
    for (std::size_t j = 0; j < w.robot.joints.size(); ++j) {
      const kaboum::robot::Joint& joint = w.robot.joints[j];
      const sdf::Joint* there = loaded.model->JointByName(loaded.joints[j]);
      ASSERT_NE(there, nullptr);
      if (joint.type == kaboum::robot::JointType::Fixed) {
        EXPECT_EQ(there->Type(), sdf::JointType::FIXED);
        continue;
      }
      const kaboum::robot::JointDynamics& d = w.dynamics.joints.at(joint.name);
      EXPECT_EQ(there->Axis()->Damping(), d.damping);
      EXPECT_EQ(there->Axis()->Friction(), d.friction);
      if (d.effort) {
        EXPECT_EQ(there->Axis()->Effort(), *d.effort);
      }
      EXPECT_EQ(there->Type() == sdf::JointType::CONTINUOUS, !d.lower) << joint.name;
      if (!d.lower) continue;
      EXPECT_EQ(there->Axis()->Lower(), *d.lower) << joint.name;
      EXPECT_EQ(there->Axis()->Upper(), *d.upper) << joint.name;
    }
  }
}

TEST(Sdf, HasTheBodiesThatWereWritten) {
  for (const WrittenRobot& w : written()) {
    Loaded loaded;
    load(w, loaded);
    if (loaded.model == nullptr) continue;
    const bool prefixed = !w.prefix.empty();
    const auto expected =
        bodies_by(read_urdf(w.urdf, prefixed ? "package://" + w.prefix : ""), &Link::name);
    for (std::size_t l = 0; l < w.robot.links.size(); ++l) {
      const sdf::Link* link = loaded.model->LinkByName(loaded.links[l]);
      EXPECT_EQ(link == nullptr, loaded.links[l] == "world") << w.urdf;
      if (link == nullptr) continue;
      std::vector<Measure> there;
      for (std::uint64_t c = 0; c < link->CollisionCount(); ++c)
        there.push_back(measure_collision(*link->CollisionByIndex(c), w.urdf.parent_path(),
                                          prefixed ? "model://" + w.prefix : ""));
      const auto found = expected.find(w.robot.links[l].name);
      expect_same(w.urdf.string() + ", link '" + w.robot.links[l].name + "'",
                  found == expected.end() ? std::vector<Measure>{} : found->second, there);
    }
  }
}

TEST(Sdf, LinksHaveTheirMasses) {
  std::size_t masses = 0;
  for (const WrittenRobot& w : written()) {
    Loaded loaded;
    load(w, loaded);
    if (loaded.model == nullptr) continue;
    for (std::size_t l = 0; l < w.robot.links.size(); ++l) {
      const sdf::Link* link = loaded.model->LinkByName(loaded.links[l]);
      const auto inertial = w.dynamics.links.find(w.robot.links[l].name);
      if (link == nullptr || inertial == w.dynamics.links.end()) continue;
      const kaboum::robot::Inertial& i = inertial->second;
      if (!(i.mass > 0)) continue;
      EXPECT_EQ(link->Inertial().MassMatrix().Mass(), i.mass);
      const Transform pose = transform(link->Inertial().Pose());
      expect_pose(i.origin, pose.linear, pose.translation, loaded.links[l]);
      const auto moi = link->Inertial().MassMatrix().Moi();
      for (unsigned r = 0; r < 3; ++r)
        for (unsigned c = 0; c < 3; ++c)
          EXPECT_NEAR(moi(r, c), i.inertia(r, c) + (loaded.links[l] == "locked" && r == c ? 1 : 0),
                      1e-6 * i.inertia.norm())
              << loaded.links[l];
      ++masses;
    }
  }
  EXPECT_GE(masses, 8U);
}

}  // namespace
}  // namespace engines
