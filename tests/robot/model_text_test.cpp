// Masses and forces of URDFs; what formats of simulators cannot say is said. That they are right,
// the simulators tell: tests/engines.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/model_text.h>

namespace kaboum::robot {
namespace {

std::string message(const std::string& inside) {
  try {
    parse_dynamics("<robot name='r'>\n" + inside + "</robot>", "r.urdf");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

constexpr const char* kArm = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0 0.2"/></geometry></collision></link>
  <link name="tip"><inertial><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><mass value="2"/>
    <inertia ixx="1" ixy="0.1" ixz="0.2" iyy="2" iyz="0.3" izz="2.5"/></inertial>
    <collision><geometry><sphere radius="0"/></geometry></collision></link>
  <joint name="j" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="5" velocity="0"/><dynamics damping="0.5" friction="0.25"/></joint>
</robot>)";

TEST(Dynamics, MassesAndForces) {
  const Dynamics d = parse_dynamics(kArm, "arm.urdf");
  ASSERT_EQ(d.links.size(), 1U);
  const Inertial& i = d.links.at("tip");
  EXPECT_EQ(i.mass, 2);
  EXPECT_EQ(i.origin.translation, Vec3(1, 2, 3));
  EXPECT_NEAR(i.origin.linear(1, 0), 1, 1e-15);
  Mat3 inertia;
  inertia << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5;
  EXPECT_EQ(i.inertia, inertia);
  const JointDynamics& j = d.joints.at("j");
  EXPECT_EQ(j.effort, 5);
  EXPECT_EQ(j.damping, 0.5);
  EXPECT_EQ(j.friction, 0.25);
  EXPECT_EQ(j.lower, -1);
  EXPECT_EQ(j.upper, 2);
}

TEST(Dynamics, SaysWhatIsWrongAndWhere) {
  const auto inertial = [](const std::string& inside) {
    return "<link name='a'>\n<inertial>" + inside + "</inertial></link>";
  };
  const std::string inertia = "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>";
  EXPECT_NE(message(inertial(inertia)).find("r.urdf:3: <inertial>: no <mass"), std::string::npos);
  EXPECT_NE(message(inertial("<mass value='-1'/>" + inertia)).find("r.urdf:3"), std::string::npos);
  EXPECT_NE(message(inertial("<mass value='x'/>" + inertia)).find("'x'"), std::string::npos);
  EXPECT_NE(message(inertial("<mass value='1'/>")).find("no <inertia"), std::string::npos);
  EXPECT_NE(message(inertial("<mass value='1'/><mass value='2'/>" + inertia)).find("second"),
            std::string::npos);
  EXPECT_NE(message(inertial("<mass value='1'/><inertia ixx='1'/>")).find("ixy"),
            std::string::npos);
  EXPECT_EQ(message(inertial("<mass value='1'/>" + inertia)), "no error");
}

TEST(ModelText, FlatShapesHaveVolumeAndPointsAreNotThere) {
  const Model arm{parse_urdf(kArm, "arm.urdf"), parse_dynamics(kArm, "arm.urdf")};
  const ModelText mjcf = to_mjcf(arm), sdf = to_sdf(arm);
  EXPECT_NE(mjcf.text.find("size=\"0.05 5e-04 0.1\""), std::string::npos) << mjcf.text;
  EXPECT_NE(sdf.text.find("<size>0.1 0.001 0.2</size>"), std::string::npos) << sdf.text;
  EXPECT_EQ(mjcf.text.find("sphere"), std::string::npos);
  EXPECT_EQ(sdf.text.find("sphere"), std::string::npos);
  EXPECT_TRUE(mjcf.notes.empty());
  EXPECT_TRUE(sdf.notes.empty());
}

TEST(ModelText, NamesOfFilesAreEscapedAndMeshesTakenOnce) {
  Model arm{parse_urdf(kArm, "arm.urdf"), {}};
  Geometry g;
  g.shape = Geometry::Shape::Mesh;
  g.mesh = "bodies/a&b \"c\".stl";
  arm.robot.links[0].collision = {g, g};
  g.size = Vec3(1, -1, 1);
  arm.robot.links[1].collision = {g};
  const std::string text = to_mjcf(arm).text;
  EXPECT_NE(text.find("file=\"bodies/a&amp;b &quot;c&quot;.stl\""), std::string::npos) << text;
  std::size_t meshes = 0;
  for (std::size_t at = text.find("<mesh "); at != std::string::npos;
       at = text.find("<mesh ", at + 1))
    ++meshes;
  EXPECT_EQ(meshes, 2U);
  EXPECT_NE(to_sdf(arm).text.find("<uri>bodies/a&amp;b"), std::string::npos);
}

TEST(ModelText, SaysWhatIsLeftOut) {
  Model arm{parse_urdf(kArm, "arm.urdf"), parse_dynamics(kArm, "arm.urdf")};
  arm.dynamics.links.at("tip").mass = 0;
  for (const ModelText& text : {to_mjcf(arm), to_sdf(arm)}) {
    ASSERT_EQ(text.notes.size(), 1U);
    EXPECT_NE(text.notes[0].find("'tip' is not positive"), std::string::npos);
  }
  arm.dynamics.links.at("tip").mass = 1;
  arm.dynamics.links.at("tip").inertia = Vec3(1, 1, 3).asDiagonal();
  for (const ModelText& text : {to_mjcf(arm), to_sdf(arm)}) {
    ASSERT_EQ(text.notes.size(), 1U);
    EXPECT_NE(text.notes[0].find("of no body"), std::string::npos);
  }
  arm.robot.joints[0].axis = Vec3::Zero();
  EXPECT_THROW(to_mjcf(arm), Error);
  EXPECT_THROW(to_sdf(arm), Error);
}

}  // namespace
}  // namespace kaboum::robot
