// Primitives of scenes: their sets bound the shape, and scenes say where they are wrong.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/collide/proximity.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/primitive.h>
#include <kaboum/world/scene.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace kaboum::world {
namespace {

using Kind = Primitive::Kind;

World scene_of(const std::string& objects, const std::string& regions = "") {
  return parse_scene(R"({"kaboum_scene": 1, "unit": "m", "objects": [)" + objects +
                         R"(], "regions": [)" + regions + "]}",
                     "scene.json", [](const std::string&) { return std::vector<char>(); });
}

std::string object(const std::string& name, const std::string& shape, const std::string& x) {
  return R"({"name": ")" + name + R"(", "shape": )" + shape + R"(, "pose": {"position": [)" + x +
         ", 0, 0]}}";
}

/// Contacts of two things at rest.
std::vector<Contact> contacts_of(const World& world) {
  const Checker checker(world);
  Scratch scratch;
  const WorldState state = initial_state(world);
  std::vector<Contact> out = checker.find_contacts(state, scratch, {.resting = true});
  for (Contact& contact : out) checker.measure_depth(contact, state, scratch);
  return out;
}

TEST(Primitive, SetsAreConvexAndBoundTheShapeFromBothSides) {
  for (const Kind kind : {Kind::Box, Kind::Sphere, Kind::Cylinder, Kind::Capsule, Kind::Plane}) {
    const Primitive p{.kind = kind, .size = {0.3, 0.7, 1.1}, .radius = 0.37, .length = 0.9};
    for (const BoundingSet& set : {outer_set(p), inner_set(p)})
      for (std::size_t i = 0; i < set.size(); ++i) EXPECT_TRUE(geom::is_convex(set.body(i)));
    EXPECT_EQ(outer_set(p).epsilon() == 0, kind != Kind::Cylinder);
    EXPECT_LE(outer_set(p).epsilon(), 0.0013 * p.radius);
    EXPECT_FALSE(mesh_of(p).triangles.empty());
  }
}

TEST(Primitive, APrismHoldsItsCylinderAndTheInnerOneLiesInIt) {
  const Primitive p{.kind = Kind::Cylinder, .radius = 0.37, .length = 0.9};
  const BoundingSet outer = outer_set(p), inner = inner_set(p);
  const geom::Transform here;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 3000; ++i) {
    // Middles of the sides come nearest to the circle.
    const double angle = i < 128 ? std::numbers::pi * i / 64 : 2 * std::numbers::pi * unit(random);
    const Vec3 rim{p.radius * std::cos(angle), p.radius * std::sin(angle), 0.45};
    const collide::Polytope point(std::vector<Vec3>{rim});
    EXPECT_TRUE(
        are_within(collide::Posed(point, here), collide::Posed(outer.polytope(0), here), 0));
  }
  for (const Vec3& v : outer.body(0).core.vertices)
    EXPECT_LE(v.head<2>().norm() - p.radius, outer.epsilon());
  for (const geom::Mesh& mesh : {inner.body(0).core, mesh_of(p)})
    for (const Vec3& v : mesh.vertices) EXPECT_LT(v.head<2>().norm(), p.radius);
}

TEST(Primitive, MeshesLieInTheirShapes) {
  const Primitive ball{.kind = Kind::Sphere, .radius = 0.5};
  for (const Vec3& v : mesh_of(ball).vertices) EXPECT_LE(v.norm(), 0.5 * (1 + 1e-15));
  const Primitive capsule{.kind = Kind::Capsule, .radius = 0.25, .length = 1};
  double top = 0;
  for (const Vec3& v : mesh_of(capsule).vertices) top = std::max(top, v.z());
  EXPECT_NEAR(top, 0.75, 1e-4);
}

TEST(PrimitivesOfScenes, TouchExactlyWhereTheirShapesDo) {
  const std::string ball = R"({"sphere": {"radius": 0.25}})";
  EXPECT_TRUE(
      contacts_of(scene_of(object("a", ball, "0") + "," + object("b", ball, "0.5000001"))).empty());
  const auto found =
      contacts_of(scene_of(object("a", ball, "0") + "," + object("b", ball, "0.375")));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].certain);
  EXPECT_EQ(found[0].epsilon, 0);
  ASSERT_TRUE(found[0].depth);
  EXPECT_NEAR(found[0].depth->lower, 0.125, 1e-9);
  EXPECT_NEAR(found[0].depth->upper, 0.125, 1e-9);
}

TEST(PrimitivesOfScenes, APlaneIsAPlateBelow) {
  const std::string plane = R"({"plane": {"size": [4, 4, 0.5]}})",
                    box = R"({"box": {"size": [0.5, 0.5, 0.5]}})";
  const World world =
      scene_of(R"({"name": "floor", "shape": )" + plane + R"(}, {"name": "box", "shape": )" + box +
               R"(, "pose": {"position": [0, 0, 0.2500001]}})");
  EXPECT_TRUE(contacts_of(world).empty());
  const World deep =
      scene_of(R"({"name": "floor", "shape": )" + plane + R"(}, {"name": "box", "shape": )" + box +
               R"(, "pose": {"position": [0, 0, 0.125]}})");
  ASSERT_EQ(contacts_of(deep).size(), 1U);
  EXPECT_NEAR(contacts_of(deep)[0].depth->upper, 0.125, 1e-9);
}

TEST(PrimitivesOfScenes, RegionsHoldWhatLiesInThem) {
  const World world = scene_of(object("ball", R"({"sphere": {"radius": 0.2}})", "0"),
                               R"({"name": "tray", "shape": {"box": {"size": [0.5, 0.5, 0.5]}}})");
  ASSERT_EQ(world.regions.size(), 1U);
  EXPECT_EQ(world.regions[0].inner.direction(), collide::Direction::Inner);
}

TEST(PrimitivesOfScenes, SayWhereTheyAreWrong) {
  const auto says = [](const std::string& member, const std::string& what) {
    try {
      scene_of(R"({"name": "a", )" + member + "}");
      ADD_FAILURE() << "accepted: " << member;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("scene.json: line 1"), std::string::npos)
          << error.what();
    }
  };
  says(R"("shape": {"sphere": {"radius": 0}})", "a length above 0");
  says(R"("shape": {"sphere": {"radius": -1}})", "a length above 0");
  says(R"("shape": {"sphere": {}})", "'radius' is missing");
  says(R"("shape": {"spere": {"radius": 1}})", "'spere' is not known here");
  says(R"("shape": {"sphere": {"radius": 1}, "box": {"size": [1, 1, 1]}})", "one of 'box'");
  says(R"("shape": {})", "one of 'box'");
  says(R"("shape": {"box": {"size": [1, 1]}})", "3 numbers are expected");
  says(R"("shape": {"box": {"size": [1, 1, 0]}})", "a length above 0");
  says(R"("shape": {"box": {"size": [1, 1, 1]}}, "outer": {"file": "a.glb", "sha256": "x"})",
       "needs no sets");
}

}  // namespace
}  // namespace kaboum::world
