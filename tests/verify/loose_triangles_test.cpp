// Triangles that are not known to lie in their own mesh's solid: none of the others may stick out,
// by the arrangement of all triangles; and of meshes without folds there are none.

#include <gtest/gtest.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/loose_triangles.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/arrangement_oracle.h"
#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::verify {
namespace {

using geom::Mesh;
using geom::Vec3;

Mesh part_of(const Mesh& mesh, const std::vector<std::uint32_t>& loose, bool chosen) {
  Mesh part;
  part.vertices = mesh.vertices;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::binary_search(loose.begin(), loose.end(), t) == chosen)
      part.triangles.push_back(mesh.triangles[t]);
  return part;
}

/// Those that are not loose lie in the mesh's solid, by the oracle.
void expect_sound(const Mesh& given, const std::string& name) {
  const Mesh mesh = test::welded(given);
  const std::vector<std::uint32_t> loose = find_loose_triangles(mesh);
  const Mesh rest = part_of(mesh, loose, false);
  if (rest.triangles.empty()) return;
  const test::ArrangementVerdict verdict = test::arrangement_verdict(test::with_area(rest), mesh);
  ASSERT_TRUE(verdict.surface) << name;
  EXPECT_TRUE(*verdict.surface) << name << ": " << verdict.surface_faults << " cells of "
                                << rest.triangles.size() << " triangles stick out";
}

/// A prism over a bow tie: the smaller one of its two halves is inside out.
Mesh bow_tie(double at) {
  Mesh mesh;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{-1.0, 1.0}, {8.0, -4.0 + at}, {8.0, 4.0}, {-1.0, -1.0}})
      mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    mesh.triangles.push_back({i, j, 4 + j});
    mesh.triangles.push_back({i, 4 + j, 4 + i});
  }
  return mesh;
}

TEST(LooseTriangles, OthersLieInTheSolid) {
  for (const test::Family& family : test::closed_families())
    if (family.mesh.triangles.size() <= 120) expect_sound(family.mesh, family.name);
}

TEST(LooseTriangles, OthersLieInTheSolidOfFolds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> by(-1, 1);
  for (int round = 0; round < 10; ++round) {
    // A ball of which some vertices are pushed through the other side, or only a little.
    Mesh mesh = test::icosphere(1);
    const int pushed = 1 + round % 5;
    for (int i = 0; i < pushed; ++i) {
      Vec3& v = mesh.vertices[random() % mesh.vertices.size()];
      v = round % 3 == 0 ? Vec3(-1.5 * v)
                         : Vec3(v + 0.6 * Vec3(by(random), by(random), by(random)));
    }
    expect_sound(mesh, "ball " + std::to_string(round));
    const Mesh moved = test::translated(test::flipped(test::icosphere(1)),
                                        1.2 * Vec3(by(random), by(random), by(random)));
    expect_sound(test::merged({mesh, moved}), "balls " + std::to_string(round));
    expect_sound(test::merged({test::box({1, 1, 1}, 1 + round % 3),
                               test::translated(test::box({1, 1, 1}, 2),
                                                {0.5 * (round % 3), 0.25 * (round % 5), 0.5})}),
                 "boxes " + std::to_string(round));
  }
  expect_sound(bow_tie(0), "bow tie");
  expect_sound(bow_tie(0.37), "odd bow tie");
}

TEST(LooseTriangles, ThereAreNoneWithoutFolds) {
  for (const auto& [name, mesh] :
       {std::pair{"ball", test::icosphere(3)},
        {"torus", test::torus(1, 0.3, 40, 20)},
        {"box", test::box({1, 2, 3}, 1)},
        {"fine box", test::box({1, 2, 3}, 7)},
        {"cylinder", test::cylinder(40, 2, 3, 3)},
        {"fan", test::cylinder(300, 2, 1, 0)},
        {"cone", test::cone(400, 1)},
        {"knot", test::torus_knot(2, 3, 0.1, 100, 8)},
        {"rough", test::noisy(test::icosphere(3), 0.01, 3)},
        {"turned", test::rotated(test::box({1, 2, 3}, 5), 0.3)},
        {"cavity", test::merged({test::icosphere(2), test::scaled(test::flipped(test::icosphere(2)),
                                                                  {0.5, 0.5, 0.5})})}})
    EXPECT_TRUE(find_loose_triangles(test::welded(mesh)).empty()) << name;
}

TEST(LooseTriangles, InsideOutAndOpenMeshesAreLoose) {
  const Mesh ball = test::icosphere(2);
  EXPECT_EQ(find_loose_triangles(test::flipped(ball)).size(), ball.triangles.size());
  Mesh open = ball;
  open.triangles.pop_back();
  EXPECT_EQ(find_loose_triangles(open).size(), open.triangles.size());
  // A sheet of two triangulations, beside a ball.
  Mesh sheet;
  sheet.vertices = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const auto loose = find_loose_triangles(test::merged({ball, sheet}));
  EXPECT_EQ(loose.size(), 4U);
}

TEST(LooseTriangles, FoldsAreFoundHoweverFewTheyAre) {
  // One vertex of a fine ball is pushed through its other side.
  Mesh mesh = test::icosphere(4);
  Vec3& v = mesh.vertices[1000];
  v *= -1.05;
  const std::vector<std::uint32_t> loose = find_loose_triangles(mesh);
  EXPECT_FALSE(loose.empty());
  EXPECT_LT(loose.size(), mesh.triangles.size() / 10);
  InclusionOptions options;
  options.surface_only = true;
  EXPECT_EQ(verify_inclusion(part_of(mesh, loose, true), mesh, options).surface.answer,
            verify_inclusion(mesh, mesh, options).surface.answer);
}

}  // namespace
}  // namespace kaboum::verify
