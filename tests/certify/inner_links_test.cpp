// Inner sets of links: what is in the container lies in the link's shapes by the verifier,
// mirrored, scaled and turned as they are; what does not is refused.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/inner_links.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "link_polytopes.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLinks = R"(<robot name="arm">
  <link name="turned">
    <collision><origin xyz="0.7 0.1 -0.3" rpy="0.3 0.1 -1.2"/>
      <geometry><mesh filename="part.off" scale="0.3 -0.3 0.2"/></geometry></collision>
    <collision><geometry><mesh filename="part.off" scale="-0.3 0.3 0.2"/></geometry></collision>
  </link>
  <link name="plain"><collision><geometry><mesh filename="part.off" scale="-0.5 1 2"/></geometry></collision></link>
  <link name="round">
    <collision><origin xyz="1 2 3" rpy="0.4 0.5 0.6"/><geometry><cylinder radius="0.25" length="0.5"/></geometry></collision>
    <collision><origin xyz="1 2 4"/><geometry><sphere radius="0.125"/></geometry></collision>
    <collision><origin xyz="-1 0 0" rpy="0 0 1"/><geometry><box size="0.5 0.25 1"/></geometry></collision>
  </link>
  <link name="sheet"><collision><geometry><mesh filename="sheet.off"/></geometry></collision></link>
  <link name="bare"/>
  <joint name="a" type="fixed"><parent link="turned"/><child link="plain"/></joint>
  <joint name="b" type="fixed"><parent link="turned"/><child link="round"/></joint>
  <joint name="c" type="fixed"><parent link="turned"/><child link="sheet"/></joint>
  <joint name="d" type="fixed"><parent link="turned"/><child link="bare"/></joint>
</robot>)";

/// Without any symmetry, so that a mirror image is another solid.
geom::Mesh part() {
  geom::Mesh out = test::torus(1, 0.4, 12, 8);
  for (geom::Vec3& v : out.vertices) v = {v.x() + 0.3 * v.y() + 0.25, v.y() + 0.5 * v.z(), v.z()};
  return out;
}

geom::Mesh cuboid(double height) {
  std::vector<geom::Vec3> points;
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double z : {0.0, height}) points.emplace_back(x, y, z);
  return *geom::convex_hull(points);
}

class InnerLinksTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto off = *io::format_from_name("off");
    io::write_file(folder_ / "part.off", io::serialise_mesh(part(), off));
    geom::Mesh sheet;
    sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}};
    io::write_file(folder_ / "sheet.off", io::serialise_mesh(sheet, off));
    std::ofstream(folder_ / "arm.urdf") << kLinks;
    robot_ = robot::read_robot((folder_ / "arm.urdf").string());
    RobotRequest request;
    request.set.epsilon = Length{10, true};
    request.set.effort = bcd::Effort::Fast;
    made_ = certify_inner_links(robot_, request);
  }

  const CertifiedInnerLink& link(const std::string& name) const {
    for (const CertifiedInnerLink& l : made_.links)
      if (l.artefact().provenance.frame == name) return l;
    throw Error(ErrorCode::Internal, name);
  }
  /// The mesh of a link as its URDF places it, with outward triangles.
  geom::Mesh posed(std::uint32_t number, std::size_t shape) const {
    const robot::Geometry& g = robot_.robot.links[number].collision[shape];
    geom::Mesh out = part();
    for (geom::Vec3& v : out.vertices) v = g.origin * v.cwiseProduct(g.size);
    if (g.size.prod() < 0)
      for (geom::Triangle& t : out.triangles) std::swap(t[1], t[2]);
    return out;
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  robot::RobotFile robot_;
  InnerLinks made_;
};

/// Whether a convex body lies in the solid of a closed mesh.
bool lies_in(const geom::ConvexBody& body, const geom::Mesh& solid) {
  return verify::verify_inclusion(body.core, solid).solid.answer == verify::Answer::Verified;
}

TEST_F(InnerLinksTest, LieInTheShapesMirroredAndTurned) {
  ASSERT_EQ(made_.links.size(), 3U);
  for (const CertifiedInnerLink& l : made_.links) {
    const geom::Provenance& p = l.artefact().provenance;
    EXPECT_EQ(p.direction, "inner");
    EXPECT_EQ(p.source_sha256, robot_.sha256);
    EXPECT_EQ(p.epsilon, l.certificate().depth);
    EXPECT_EQ(margin_of(l.artefact()), 0);
    const geom::ConvexSet back = io::parse_convex_set(l.bytes(), io::Format::Glb, "it");
    EXPECT_EQ(verify::verify_convexity(back).convex.answer, verify::Answer::Verified);
  }
  for (const geom::ConvexBody& body : link("turned").artefact().bodies)
    EXPECT_TRUE(lies_in(body, posed(0, 0)) || lies_in(body, posed(0, 1))) << body.name;
  EXPECT_EQ(link("turned").certificate().shapes, 2U);
  // Powers of two are exact, so the bodies and their depth are the mesh's own.
  for (const geom::ConvexBody& body : link("plain").artefact().bodies)
    EXPECT_TRUE(lies_in(body, posed(1, 0))) << body.name;
  const double own = made_.meshes.at(1).made.found.set.artefact().provenance.epsilon.value();
  EXPECT_LE(link("plain").certificate().depth, 2 * own);
  // Not in the mirror image.
  geom::Mesh mirrored = posed(1, 0);
  for (geom::Vec3& v : mirrored.vertices) v.x() = -v.x();
  for (geom::Triangle& t : mirrored.triangles) std::swap(t[1], t[2]);
  std::size_t outside = 0;
  for (const geom::ConvexBody& body : link("plain").artefact().bodies)
    outside += lies_in(body, mirrored) ? 0 : 1;
  EXPECT_GT(outside, 0U);
}

TEST_F(InnerLinksTest, ArePolytopes) {
  RobotRequest request;
  request.set.epsilon = Length{5, true};
  request.set.body_kind = SetRequest::BodyKind::Spheres;
  EXPECT_THROW(certify_inner_links(robot_, request), Error);
}

TEST_F(InnerLinksTest, OfBoxesCylindersAndSpheresAreInscribed) {
  const geom::ConvexSet& set = link("round").artefact();
  ASSERT_EQ(set.bodies.size(), 3U);
  const auto& shapes = robot_.robot.links[2].collision;
  for (std::size_t i = 0; i < 3; ++i) {
    double nearest = 1e9;
    for (const geom::Vec3& v : set.bodies[i].core.vertices) {
      const geom::Vec3 p = shapes[i].origin.linear.transpose() * (v - shapes[i].origin.translation);
      const geom::Vec3& size = shapes[i].size;
      double inside = 0;
      if (i == 0)
        inside = std::min(size.x() - p.head<2>().norm(), 0.5 * size.y() - std::abs(p.z()));
      else if (i == 1)
        inside = size.x() - p.norm();
      else
        inside = (0.5 * size - p.cwiseAbs()).minCoeff();
      EXPECT_GT(inside, 0) << i;
      nearest = std::min(nearest, inside);
    }
    EXPECT_LT(nearest, 1e-3) << i;
  }
}

TEST_F(InnerLinksTest, LinksWithoutOneAreNamed) {
  ASSERT_EQ(made_.without.size(), 1U);
  EXPECT_EQ(robot_.robot.links[made_.without[0].first].name, "sheet");
  EXPECT_FALSE(made_.without[0].second.empty());
}

TEST_F(InnerLinksTest, PolytopesThatReachOutAreRefused) {
  const geom::Mesh cube = cuboid(1);
  const robot::LinkBody body{"body", 0, cube.vertices, 1e-9};
  const auto made = inner_polytopes({body}, 1);
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->is_exact);
  EXPECT_EQ(inner_objection(made->set, {body}), "");
  geom::ConvexSet bad = made->set;
  set_margin(bad, 1e-12);
  EXPECT_NE(inner_objection(bad, {body}), "");
  // The body itself: within the margin of its own planes.
  bad = made->set;
  bad.bodies[0].core = cube;
  EXPECT_NE(inner_objection(bad, {body}), "");
  EXPECT_EQ(inner_objection(bad, {{"body", 0, cube.vertices, 0}}), "");
  // Nearer to the planes than the margin by a tenth of it, and farther.
  const auto shrunk = [&](double by) {
    geom::ConvexSet out = made->set;
    out.bodies[0].core = cube;
    for (geom::Vec3& v : out.bodies[0].core.vertices)
      v = geom::Vec3::Constant(0.5) + (1 - 2 * by) * (v - geom::Vec3::Constant(0.5));
    return out;
  };
  EXPECT_NE(inner_objection(shrunk(0.9e-9), {body}), "");
  EXPECT_EQ(inner_objection(shrunk(1.1e-9), {body}), "");
  bad = made->set;
  bad.bodies.push_back(bad.bodies[0]);
  EXPECT_NE(inner_objection(bad, {body}), "");
  EXPECT_FALSE(inner_polytopes({{"thin", 0, cuboid(1e-9).vertices, 1e-9}}, 1));
}

}  // namespace
}  // namespace kaboum::certify
