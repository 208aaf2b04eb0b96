/// Minimising in half-spaces, and the triangles of a hull while vertices are put in the place of
/// others.

#include "half_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "hull_mesh.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::Triangle;
using geom::Vec3;

double value(const PlaneQuadric& q, const Vec3& v) { return v.dot(q.a * v) - 2 * q.b.dot(v); }

TEST(MinimiseBeyond, NoPointOfTheHalfSpacesIsBetter) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vec3(normal(random), normal(random), normal(random)).normalized();
  };
  int found = 0, active = 0;
  for (int trial = 0; trial < 300; ++trial) {
    PlaneQuadric q;
    for (int i = 0; i < 6; ++i) q.add(HalfSpace{direction(), normal(random)}, 1);
    // A cone of half-spaces round one direction: they meet.
    const Vec3 up = direction();
    std::vector<HalfSpace> half_spaces;
    for (int i = 0; i < 8; ++i) {
      const Vec3 n = direction();
      half_spaces.push_back({n.dot(up) < 0 ? Vec3(-n) : n, normal(random)});
    }
    const auto best = minimise_beyond(q, half_spaces, 1e-11);
    if (!best) continue;
    ++found;
    double nearest = 1;
    for (const HalfSpace& h : half_spaces) {
      EXPECT_GE(h.height(*best), -1e-10);
      nearest = std::min(nearest, h.height(*best));
    }
    active += nearest < 1e-9 ? 1 : 0;
    for (int i = 0; i < 200; ++i) {
      const Vec3 other = *best + 0.3 * normal(random) * direction();
      const bool inside = std::all_of(half_spaces.begin(), half_spaces.end(),
                                      [&](const HalfSpace& h) { return h.height(other) >= 0; });
      if (inside) {
        EXPECT_GE(value(q, other), value(q, *best) - 1e-8);
      }
    }
  }
  EXPECT_GT(found, 250);
  EXPECT_GT(active, 200);
}

TEST(HullMesh, ReplacingAnEdgeKeepsAClosedSurface) {
  const geom::Mesh sphere = kaboum::test::icosphere(1);
  HullMesh mesh(sphere.vertices, sphere.triangles);
  const HullMesh::Index a = sphere.triangles[0][0], b = sphere.triangles[0][1];
  std::vector<HullMesh::Edge> link;
  ASSERT_TRUE(mesh.link(a, b, link));
  std::vector<HullMesh::Index> marked;
  for (const HullMesh::Index v : {a, b})
    for (const HullMesh::Index t : mesh.star(v))
      if (mesh.mark(t)) marked.push_back(t);
  const auto ring = mesh.ring_round(marked);
  ASSERT_TRUE(ring);
  EXPECT_EQ(ring->size(), link.size());
  const std::size_t before = mesh.count();
  std::vector<HullMesh::Index> vanished;
  const HullMesh::Index fresh = mesh.replace(marked, *ring, 0.6 * (mesh[a] + mesh[b]), vanished);
  EXPECT_EQ(mesh.count(), before - 1);
  EXPECT_EQ(vanished, (std::vector<HullMesh::Index>{std::min(a, b), std::max(a, b)}));
  EXPECT_EQ(mesh.star(fresh).size(), ring->size());
  for (HullMesh::Index t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    const Triangle& c = mesh.triangle(t);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NE(mesh.across(c[k], c[(k + 1) % 3]), HullMesh::kNone);
  }
}

TEST(HullMesh, TwoHolesAreNoRing) {
  const geom::Mesh sphere = kaboum::test::icosphere(1);
  HullMesh mesh(sphere.vertices, sphere.triangles);
  std::vector<HullMesh::Index> marked{0};
  ASSERT_TRUE(mesh.mark(0));
  EXPECT_FALSE(mesh.mark(0));
  for (HullMesh::Index t = 1; t < mesh.triangle_slots() && marked.size() < 2; ++t) {
    bool apart = true;
    for (const HullMesh::Index v : mesh.triangle(t))
      apart = apart && std::count(mesh.triangle(0).begin(), mesh.triangle(0).end(), v) == 0;
    if (apart && mesh.mark(t)) marked.push_back(t);
  }
  EXPECT_FALSE(mesh.ring_round(marked));
  mesh.unmark(marked);
  EXPECT_TRUE(mesh.alive(0));
}

}  // namespace
}  // namespace kaboum::bcd
