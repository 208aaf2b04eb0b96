// Parts of triangles that satisfy a condition: exact winding numbers beside points of them agree.
#include "pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "cell_sample.h"
#include "nearest.h"
#include "pairs.h"
#include "support/shapes.h"
#include "uncovered_region.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using verify::BoxTree;
using verify::kInside;
using verify::MeshPair;
using verify::Pieces;

Mesh block(const Vec3& low, const Vec3& high) { return translated(box(high - low, 1), low); }

bool bounds_the_solid(int inner, int outer) { return std::min(inner, outer) <= 0; }

Pieces bounding(const MeshPair& meshes, const verify::InclusionOptions& options = {}) {
  return verify::pieces_with(meshes, kInside, options, bounds_the_solid);
}

double area_of(const MeshPair& meshes, const Pieces& pieces, const BoxTree& tree) {
  const verify::Triangles triangles(meshes, pieces.parts);
  double area = 0;
  tree.query([](const verify::Bounds&) { return true; },
             [&](std::uint32_t t) {
               const Vec3& a = triangles.corner(t, 0);
               area += (triangles.corner(t, 1) - a).cross(triangles.corner(t, 2) - a).norm() / 2;
             });
  return area / (meshes.scale() * meshes.scale());
}

double area_of(const Mesh& mesh) {
  const MeshPair meshes(mesh, Mesh{});
  const Pieces pieces = verify::pieces_with(meshes, kInside, {}, [](int, int) { return true; });
  return area_of(meshes, pieces, pieces.surely);
}

TEST(Pieces, OfBlocksThatCrossTouchAndAreFolded) {
  const Mesh unit = block({0, 0, 0}, {1, 1, 1});
  const auto area = [](const Mesh& mesh) {
    const MeshPair meshes(mesh, Mesh{});
    const Pieces pieces = bounding(meshes);
    EXPECT_NEAR(area_of(meshes, pieces, pieces.surely), area_of(meshes, pieces, pieces.perhaps),
                1e-12);
    return area_of(meshes, pieces, pieces.surely);
  };
  EXPECT_NEAR(area_of(unit), 6, 1e-12);
  EXPECT_NEAR(area(unit), 6, 1e-12);
  // A beam through the cube: both lose what is inside the other.
  const Mesh beam = block({-1, 0.25, 0.25}, {2, 0.75, 0.75});
  EXPECT_NEAR(area(merged({unit, beam})), 6 - 2 * 0.25 + 4 * 2 * 0.5 + 2 * 0.25, 1e-12);
  // A smaller cube on a face: the common square bounds nothing on either.
  EXPECT_NEAR(area(merged({unit, block({0.25, 0.25, 1}, {0.75, 0.75, 1.5})})), 6 + 4 * 0.25, 1e-12);
  // One within the other bounds nothing, a cavity does.
  const Mesh within = block(Vec3::Constant(0.25), Vec3::Constant(0.75));
  EXPECT_NEAR(area(merged({unit, within})), 6, 1e-12);
  EXPECT_NEAR(area(merged({unit, flipped(within)})), 6 + 1.5, 1e-12);
  // Across a face inside out: all of both, but what is back to back nowhere.
  const Mesh across = block({0.25, 0.25, 0.5}, {0.75, 0.75, 1.5});
  EXPECT_NEAR(area(merged({unit, across})), 6 - 0.25 + 4 * 0.25 + 0.25, 1e-12);
}

/// What lies on the boundary of {w ≥ 1} by exact winding numbers at points off the surface by so
/// little that nothing else is between.
TEST(Pieces, AgreeWithWindingNumbersBesideThem) {
  std::size_t on = 0, off = 0, parts = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const auto uniform = [&] { return static_cast<double>(random() % 1'000'000) / 1'000'000; };
    std::vector<Mesh> solids;
    for (int i = 0; i < 5; ++i) {
      const Vec3 low(uniform(), uniform(), uniform());
      const Vec3 size(0.2 + uniform(), 0.2 + uniform(), 0.2 + uniform());
      Mesh one = i % 2 == 0
                     ? block(low, low + size)
                     : translated(noisy(icosphere(1), 0.2, static_cast<std::uint32_t>(seed)), low);
      one = rotated(one, 6 * uniform());
      solids.push_back(i == 4 ? flipped(one) : one);
    }
    const Mesh mesh = merged(solids);
    const MeshPair meshes(mesh, Mesh{});
    const Pieces pieces = bounding(meshes);
    parts += pieces.parts.size();
    const verify::Triangles triangles(meshes, pieces.parts);
    const verify::NearestTriangle surely(triangles, pieces.surely),
        perhaps(triangles, pieces.perhaps);
    for (int i = 0; i < 400; ++i) {
      const auto f = static_cast<std::uint32_t>(random() % meshes.faces().size());
      const double u = uniform(), v = (1 - u) * uniform();
      const Vec3 &a = meshes.corner(f, 0), &b = meshes.corner(f, 1), &c = meshes.corner(f, 2);
      const Vec3 p = (1 - u - v) * a + u * b + v * c;
      const Vec3 up = 1e-9 * (b - a).cross(c - a).normalized();
      // Near other triangles, or the border of this one, a step off it may lead elsewhere.
      bool alone = std::min({u, v, 1 - u - v}) > 1e-4;
      for (std::uint32_t g = 0; g < meshes.faces().size() && alone; ++g)
        alone = g == f || (verify::closest_point(p, meshes.corner(g, 0), meshes.corner(g, 1),
                                                 meshes.corner(g, 2)) -
                           p)
                                  .norm() > 1e-7;
      if (!alone) continue;
      const auto inner = winding_at(meshes, kInside, p - up),
                 outer = winding_at(meshes, kInside, p + up);
      ASSERT_TRUE(inner.has_value() && outer.has_value());
      const bool bounds = bounds_the_solid(*inner, *outer);
      ++(bounds ? on : off);
      EXPECT_EQ(surely.distance(p) < 1e-12, bounds) << seed << ' ' << i;
      EXPECT_EQ(perhaps.distance(p) < 1e-12, bounds) << seed << ' ' << i;
    }
  }
  EXPECT_GE(on, 2000U);
  EXPECT_GE(off, 2000U);
  EXPECT_GE(parts, 1000U);
}

// A face cut by more than can be divided may bound the solid, or not.
TEST(Pieces, OfTooManyAreNotKnown) {
  std::vector<Mesh> solids{block({0, 0, 0}, {1, 1, 1})};
  for (int i = 0; i < 35; ++i) {  // the upper side, cut into thousands of squares
    const double at = (i + 0.5) / 36, width = 0.2 / 36;
    solids.push_back(block({at, -0.5, 0.5}, {at + width, 1.5, 1.5}));
    solids.push_back(block({-0.5, at, 0.5}, {1.5, at + width, 1.5}));
  }
  const Mesh mesh = merged(solids);
  const MeshPair meshes(mesh, Mesh{});
  const Pieces pieces = bounding(meshes);
  const verify::Triangles triangles(meshes, pieces.parts);
  const Vec3 p = Vec3(0.25 / 36, 0.25 / 36, 1) * meshes.scale();  // on it, off all walls
  EXPECT_GT(verify::NearestTriangle(triangles, pieces.surely).distance(p), 0);
  EXPECT_EQ(verify::NearestTriangle(triangles, pieces.perhaps).distance(p), 0);
}

// Where the deepest point of a cube is exactly as deep as the limit, no number of boxes tells.
TEST(UncoveredRegion, EndWhenTheWorkIsDone) {
  const MeshPair meshes(block({0, 0, 0}, {1, 1, 1}), Mesh{});
  const BoxTree& faces = meshes.tree(kInside);
  std::vector<std::uint32_t> all(meshes.faces().size());
  std::iota(all.begin(), all.end(), 0U);
  const auto search = [&](double limit, std::size_t boxes, std::size_t work) {
    return verify::search_uncovered(
        meshes, all,
        {meshes, faces, faces, limit * meshes.scale(), boxes, false, true, nullptr, work});
  };
  const std::size_t many = 1'000'000'000;
  EXPECT_EQ(search(0.5, many, many).answer, verify::Answer::Undecided);
  EXPECT_NE(search(0.5, many, many).reason.find("but for rounding"), std::string::npos);
  EXPECT_EQ(search(0.5, 500, many).answer, verify::Answer::Undecided);
  EXPECT_EQ(search(0.51, many, 20'000).answer, verify::Answer::Verified);
  EXPECT_EQ(search(0.49, many, 20'000).answer, verify::Answer::Refuted);
  EXPECT_EQ(search(0.51, many, 10).answer, verify::Answer::Undecided);
  EXPECT_NE(search(0.51, many, 10).reason.find("within the work allowed"), std::string::npos);
}

}  // namespace
