// Winding numbers at points in the planes of triangles, which only those on the surface have not.
#include <gtest/gtest.h>

#include <optional>

#include "cell_sample.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test

TEST(WindingAt, OnlyPointsOfTheSurfaceHaveNone) {
  // Walls' planes run through the other box.
  const geom::Box3 large{geom::Vec3(0, 0, 0), geom::Vec3(4, 4, 4)},
      small{geom::Vec3(1, 1, 5), geom::Vec3(3, 3, 7)};
  const auto expected = [&](const geom::Vec3& p) -> std::optional<int> {
    int sum = 0;
    for (const geom::Box3& box : {large, small}) {
      if ((p.array() < box.min.array()).any() || (p.array() > box.max.array()).any()) continue;
      if ((p.array() == box.min.array()).any() || (p.array() == box.max.array()).any())
        return std::nullopt;
      ++sum;
    }
    return sum;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto turned = [&](const geom::Vec3& p) {
      return geom::Vec3(p[(3 - axis) % 3], p[(4 - axis) % 3], p[(5 - axis) % 3]);
    };
    geom::Mesh mesh;
    for (const geom::Box3& b : {large, small}) {
      geom::Mesh part = box(b.max - b.min, 2);
      for (geom::Vec3& v : part.vertices) v = turned(geom::Vec3(v + b.min));
      mesh = merged({mesh, part});
    }
    const verify::MeshPair meshes(mesh, mesh);
    int none = 0;
    for (int x = -1; x <= 18; ++x)
      for (int y = -1; y <= 18; ++y)
        for (int z = -1; z <= 30; ++z) {
          const geom::Vec3 p = geom::Vec3(x, y, z) / 4;
          const std::optional<int> w =
              verify::winding_at(meshes, verify::kOutside, turned(p) * meshes.scale());
          EXPECT_EQ(w, expected(p)) << axis << ": " << p.transpose();
          none += w ? 0 : 1;
        }
    EXPECT_GT(none, 1000);
  }
}

}  // namespace
