// Files of spheres: what is read, and texts with other spheres in place of it.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/sphere_file.h>

#include <algorithm>
#include <cmath>

namespace kaboum::robot {
namespace {

geom::ConvexBody ball(const geom::Vec3& center, double radius) {
  geom::ConvexBody out;
  out.core.vertices = {center};
  out.radius = radius;
  return out;
}

void expect_same(const std::vector<LinkSpheres>& wanted, const SphereFile& read) {
  ASSERT_EQ(wanted.size(), read.links.size());
  for (const LinkSpheres& link : wanted) {
    const auto at = std::find_if(read.links.begin(), read.links.end(),
                                 [&](const LinkSpheres& other) { return other.link == link.link; });
    ASSERT_NE(at, read.links.end()) << link.link;
    ASSERT_EQ(at->balls.bodies.size(), link.balls.bodies.size()) << link.link;
    for (const geom::ConvexBody& body : link.balls.bodies)
      EXPECT_TRUE(std::any_of(at->balls.bodies.begin(), at->balls.bodies.end(),
                              [&](const geom::ConvexBody& other) {
                                return other.core.vertices[0] == body.core.vertices[0] &&
                                       std::abs(other.radius - body.radius) < 1e-15;
                              }))
          << link.link << " " << body.radius;
  }
}

/// One sphere changed, one added, and a link that the file does not have.
std::vector<LinkSpheres> changed(const SphereFile& read) {
  std::vector<LinkSpheres> out = read.links;
  out[0].balls.bodies[0] = ball({0.1, -2, 1e-7}, 0.75);
  out[0].balls.bodies.push_back(ball({1, 2, 3}, 0.5));
  LinkSpheres other;
  other.link = "new link";
  other.balls.bodies = {ball({0, 0, 1.0 / 3}, 0.25), ball({4, 5, 6}, 0.125)};
  out.push_back(other);
  return out;
}

constexpr const char* kBlock =
    "# a comment\nrobot_cfg:\n  kinematics:\n    collision_sphere_buffer: {arm: 0.125}\n"
    "    collision_spheres:\n      arm:\n      - center: [0.5, 0, 0]  # here\n        radius: "
    "'0.25'\n"
    "      -   center:\n          - 1\n          - 2.0\n          - 3e-1\n          radius: 1\n"
    "      hand:\n        - {\"center\": [0, 0, 1], \"radius\": 0.5}\n"
    "    self_collision_ignore: {arm: [hand]}\n";

#ifdef KABOUM_HAS_YAML
TEST(SphereFile, YamlIsEditedInPlace) {
  const SphereFile read = parse_spheres("a.yaml", kBlock);
  EXPECT_EQ(edited_spheres("a.yaml", kBlock, read.links), kBlock);
  const std::vector<LinkSpheres> wanted = changed(read);
  const std::string text = edited_spheres("a.yaml", kBlock, wanted);
  expect_same(wanted, parse_spheres("a.yaml", text));
  // A new link before the last one, which gets a sphere as well: both begin at one place.
  std::vector<LinkSpheres> turned = changed(read);
  turned[1].balls.bodies.push_back(ball({7, 8, 9}, 0.5));
  std::ranges::reverse(turned);
  expect_same(turned, parse_spheres("a.yaml", edited_spheres("a.yaml", kBlock, turned)));
  for (const char* kept :
       {"# a comment\n", "# here\n", "{arm: 0.125}", "    self_collision_ignore: {arm: [hand]}\n",
        "- 2.0\n", "{\"center\": [0, 0, 1], \"radius\": 0.5}"})
    EXPECT_NE(text.find(kept), std::string::npos) << kept << text;
  const std::string flow = "{collision_spheres: {arm: [{center: [0, 0, 0], radius: 1}]}}";
  const std::vector<LinkSpheres> more = changed(parse_spheres("a.yml", flow));
  expect_same(more, parse_spheres("a.yml", edited_spheres("a.yml", flow, more)));
  const std::string open = "collision_spheres:\n  arm:\n    - center: [0, 0, 0]\n      radius: 1";
  const std::vector<LinkSpheres> last = changed(parse_spheres("a.yml", open));
  expect_same(last, parse_spheres("a.yml", edited_spheres("a.yml", open, last)));
}

TEST(SphereFile, ANumberThatIsStatedHolds) {
  const std::string text = sphere_count_comment(3) + kBlock;
  const SphereFile read = parse_spheres("a.yaml", text);
  const std::vector<LinkSpheres> wanted = changed(read);  // three more
  const std::string edited = edited_spheres("a.yaml", text, wanted);
  EXPECT_TRUE(edited.starts_with(sphere_count_comment(6))) << edited;
  expect_same(wanted, parse_spheres("a.yaml", edited));
  for (const std::size_t other : {0, 2, 4, 30})
    EXPECT_THROW(parse_spheres("a.yaml", sphere_count_comment(other) + kBlock), Error);
  for (const char* other : {"", "3 or so", "-3", "99999999999999999999999"})
    EXPECT_THROW(
        parse_spheres("a.yaml", std::string("# spheres in this file: ") + other + "\n" + kBlock),
        Error)
        << other;
  EXPECT_NO_THROW(parse_spheres("a.yaml", "# spheres in this file: 3 \r\n" + std::string(kBlock)));
}

TEST(SphereFile, LinksThatGetSpheresAreNamed) {
  const std::string spheres =
      "collision_spheres:\n  arm:\n    - center: [0, 0, 0]\n      radius: 1\n";
  for (const char* names :
       {"collision_link_names: [arm, hand]\n", "collision_link_names: ['arm']  # all\n",
        "collision_link_names:\n  - arm\n", "collision_link_names:\n- arm\nother: 1\n"}) {
    const std::string text = names + spheres;
    const std::vector<LinkSpheres> wanted = changed(parse_spheres("a.yaml", text));
    expect_same(wanted, parse_spheres("a.yaml", edited_spheres("a.yaml", text, wanted)));
  }
}

TEST(SphereFile, WhatCannotBeEditedIsRefused) {
  const std::string shared =
      "collision_spheres:\n  arm: &a\n    - center: [0, 0, 0]\n      radius: 1\n  hand: *a\n";
  std::vector<LinkSpheres> wanted = parse_spheres("a.yaml", shared).links;
  wanted[0].balls.bodies[0].radius = 2;
  wanted[1].balls.bodies[0].radius = 3;
  EXPECT_THROW(edited_spheres("a.yaml", shared, wanted), Error);
  const SphereFile read = parse_spheres("a.yaml", kBlock);
  wanted = read.links;
  wanted[0].balls.bodies[0].radius = 0.1;  // less than its buffer
  EXPECT_THROW(edited_spheres("a.yaml", kBlock, wanted), Error);
}
#endif

TEST(SphereFile, XmlIsEdited) {
  const std::string srdf =
      "<robot name=\"r\"><!-- kept --><group name=\"g\"/><link_sphere_approximation link=\"arm\">"
      "<sphere center=\"0 0 0\" radius=\"1\"/></link_sphere_approximation></robot>";
  const std::vector<LinkSpheres> wanted = changed(parse_spheres("a.srdf", srdf));
  const std::string text = edited_spheres("a.srdf", srdf, wanted);
  expect_same(wanted, parse_spheres("a.srdf", text));
  EXPECT_NE(text.find("<!-- kept -->"), std::string::npos);
  const std::string urdf =
      "<robot name=\"r\"><link name=\"arm\"><collision><geometry><sphere radius=\"1\"/></geometry>"
      "</collision></link><link name=\"new link\"/><joint name=\"j\" type=\"fixed\"><parent "
      "link=\"arm\"/><child link=\"new link\"/></joint></robot>";
  const std::vector<LinkSpheres> other = changed(parse_spheres("a.urdf", urdf));
  expect_same(other, parse_spheres("a.urdf", edited_spheres("a.urdf", urdf, other)));
}

}  // namespace
}  // namespace kaboum::robot
