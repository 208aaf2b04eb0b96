// Delaunay tetrahedra fill their box, and have no point inside their spheres.
#include "delaunay.h"

#include <gtest/gtest.h>
#include <kaboum/base/random.h>
#include <kaboum/geom/in_sphere.h>

#include <cmath>

namespace kaboum::wrap {
namespace {

void expect_sound(const Delaunay& d, double volume, bool empty_spheres = true) {
  double sum = 0;
  for (std::uint32_t c = 0; c < d.cell_count(); ++c) {
    const Delaunay::Cell& cell = d.cell(c);
    if (cell.gone()) continue;
    const auto& [a, b, e, f] = cell.vertex;
    ASSERT_EQ(geom::orient3d(d.point(a), d.point(b), d.point(e), d.point(f)), geom::Sign::Positive);
    sum +=
        (d.point(b) - d.point(a)).cross(d.point(e) - d.point(a)).dot(d.point(f) - d.point(a)) / 6;
    for (std::uint32_t v = 0; empty_spheres && v < d.point_count(); ++v)
      ASSERT_NE(geom::in_sphere(d.point(a), d.point(b), d.point(e), d.point(f), d.point(v)),
                geom::Sign::Positive);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t n = cell.next[i];
      if (n == Delaunay::kNone) continue;
      ASSERT_FALSE(d.cell(n).gone());
      for (const std::uint8_t k : Delaunay::kFacet[i]) ASSERT_TRUE(d.cell(n).has(cell.vertex[k]));
      ASSERT_FALSE(d.cell(n).has(cell.vertex[i]));
      ASSERT_EQ(std::count(d.cell(n).next.begin(), d.cell(n).next.end(), c), 1);
    }
  }
  EXPECT_NEAR(sum, volume, 1e-9 * volume);
  for (std::uint32_t v = 0; v < d.point_count(); ++v) {
    std::vector<std::uint32_t> round;
    d.cells_round(v, round);
    std::size_t all = 0;
    for (std::uint32_t c = 0; c < d.cell_count(); ++c)
      all += !d.cell(c).gone() && d.cell(c).has(v) ? 1 : 0;
    EXPECT_EQ(round.size(), all);
  }
}

TEST(Delaunay, OfRandomPoints) {
  Random random(7);
  Delaunay d({Vec3(-1, -2, -3), Vec3(2, 2, 2)});
  std::uint32_t near = 0;
  for (int i = 0; i < 250; ++i) {
    const double x = random.between(-1, 2), y = random.between(-2, 2), z = random.between(-3, 2);
    ASSERT_NE(d.insert({x, y, z}, near, 0), Delaunay::kNone);
    near = d.made().front();
  }
  expect_sound(d, 60);
}

/// Points of a lattice: many on one plane, and on one sphere.
TEST(Delaunay, OfALattice) {
  Delaunay d({Vec3::Zero(), Vec3(6, 6, 6)});
  std::uint32_t near = 0;
  for (int x = 1; x < 6; ++x)
    for (int y = 1; y < 6; ++y)
      for (int z = 1; z < 6; ++z) {
        ASSERT_NE(d.insert(Vec3(x, y, z), near, 0), Delaunay::kNone);
        near = d.made().back();
      }
  expect_sound(d, 216);
}

/// Edges that are split in the middle, or nearly, leave tetrahedra that fill the box; others are
/// refused, and change nothing.
TEST(Delaunay, EdgesAreSplit) {
  Random random(5);
  Delaunay d({Vec3(-1, -1, -1), Vec3(1, 1, 1)});
  const auto point = [&](double size) {
    const double x = random.between(-size, size), y = random.between(-size, size),
                 z = random.between(-size, size);
    return Vec3(x, y, z);
  };
  for (std::uint32_t near = 0; d.point_count() < 60;)
    if (d.insert(point(0.9), near, 0) != Delaunay::kNone) near = d.made().front();
  int refused = 0, split = 0;
  std::vector<std::uint32_t> ring, made;
  for (std::uint32_t v = 8; v < 60; ++v) {
    d.cells_round(v, ring);
    const std::uint32_t w =
        d.cell(ring.front()).vertex[d.cell(ring.front()).vertex[0] == v ? 1 : 0];
    std::erase_if(ring, [&](std::uint32_t c) { return !d.cell(c).has(w); });
    const Vec3 middle = 0.5 * (d.point(v) + d.point(w));
    const std::size_t before = d.point_count();
    const std::uint32_t at = d.split(v, w, middle + point(v % 3 == 0 ? 1 : 1e-6), ring, made);
    if (at == Delaunay::kNone) {
      ++refused;
      EXPECT_EQ(d.point_count(), before);
    } else {
      ++split;
      EXPECT_EQ(at, before);
      EXPECT_EQ(made.size(), ring.size());
    }
    expect_sound(d, 8, false);
  }
  EXPECT_GT(refused, 5);
  EXPECT_GT(split, 30);
}

TEST(Delaunay, RefusesWhatIsNotInTheBoxOrTooNear) {
  Delaunay d({Vec3::Zero(), Vec3(1, 1, 1)});
  EXPECT_EQ(d.insert(Vec3(0.5, 0.5, 1), 0, 0), Delaunay::kNone);
  EXPECT_EQ(d.insert(Vec3(0.5, 0.5, 2), 0, 0), Delaunay::kNone);
  EXPECT_EQ(d.insert(Vec3(1, 1, 1), 0, 0), Delaunay::kNone);
  ASSERT_NE(d.insert(Vec3(0.5, 0.5, 0.5), 0, 0), Delaunay::kNone);
  const std::uint32_t near = d.made().front();
  EXPECT_EQ(d.insert(Vec3(0.5, 0.5, 0.5), near, 0), Delaunay::kNone);
  EXPECT_EQ(d.insert(Vec3(0.5, 0.5, 0.55), near, 0.1), Delaunay::kNone);
  EXPECT_NE(d.insert(Vec3(0.5, 0.5, 0.55), near, 0.01), Delaunay::kNone);
  expect_sound(d, 1);
}

}  // namespace
}  // namespace kaboum::wrap
