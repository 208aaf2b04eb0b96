#include "reference_solid.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/prepare.h>

#include <random>

#include "replay_solid.h"
#include "support/families.h"
#include "support/oracle.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT

using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;

/// Another way, in rational arithmetic: what is left of the triangle inside all four faces has a
/// corner strictly inside each of them.
bool meets_by_clipping(const Tetrahedron& tetrahedron, const std::array<Vec3, 3>& triangle) {
  const auto point = [](const Vec3& p) { return Exact::Point_3(p.x(), p.y(), p.z()); };
  std::vector<Exact::Point_3> polygon;
  for (const Vec3& p : triangle) polygon.push_back(point(p));
  std::vector<Exact::Plane_3> inwards;
  for (std::size_t k = 0; k < 4; ++k) {
    Exact::Plane_3 plane(point(tetrahedron[(k + 1) % 4]), point(tetrahedron[(k + 2) % 4]),
                         point(tetrahedron[(k + 3) % 4]));
    inwards.push_back(plane.has_on_positive_side(point(tetrahedron[k])) ? plane : plane.opposite());
  }
  const auto height = [](const Exact::Plane_3& f, const Exact::Point_3& p) {
    return Exact::FT(f.a() * p.x() + f.b() * p.y() + f.c() * p.z() + f.d());
  };
  for (const auto& f : inwards) {
    std::vector<Exact::Point_3> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const Exact::FT hp = height(f, p), hq = height(f, q);
      if (hp >= 0) out.push_back(p);
      if ((hp > 0 && hq < 0) || (hp < 0 && hq > 0)) out.push_back(p + (q - p) * (hp / (hp - hq)));
    }
    polygon = out;
  }
  if (polygon.empty()) return false;
  return std::all_of(inwards.begin(), inwards.end(), [&](const auto& f) {
    return std::any_of(polygon.begin(), polygon.end(),
                       [&](const auto& p) { return height(f, p) > 0; });
  });
}

bool has_volume(const Tetrahedron& t) {
  return geom::orient3d(t[0], t[1], t[2], t[3]) != geom::Sign::Zero;
}

// Coordinates of few values make touching, coplanar and degenerate cases the rule.
TEST(ReferenceSolid, MeetsInteriorAsClippingSays) {
  std::mt19937_64 random(61);
  int met = 0, missed = 0;
  for (int i = 0; i < 6000; ++i) {
    const int values = 2 + static_cast<int>(random() % 4);
    const auto point = [&] {
      const auto x = [&] { return static_cast<double>(random() % static_cast<unsigned>(values)); };
      return i % 5 == 0 ? Vec3(x() + 1e-3 * x(), x() / 3, x() * 0.7) : Vec3(x(), x(), x());
    };
    const Tetrahedron tetrahedron{point(), point(), point(), point()};
    if (!has_volume(tetrahedron)) continue;
    const std::array<Vec3, 3> triangle{point(), point(), point()};
    const bool meets = meets_interior(tetrahedron, triangle);
    ASSERT_EQ(meets, meets_by_clipping(tetrahedron, triangle)) << i;
    ++(meets ? met : missed);
  }
  EXPECT_GT(met, 300);
  EXPECT_GT(missed, 300);
}

// Products of such coordinates vanish: what rounded arithmetic says of them must not count.
TEST(ReferenceSolid, TinyTrianglesInACornerAreNotBeyondIt) {
  const double u = 5e-324;
  const Vec3 a(-u, u, -2 * u), b(-2 * u, 0, u), c(-u, -2 * u, 0);
  const Tetrahedron tetrahedron{Vec3(0, 0, 0),
                                Vec3(.4482383141361155, -.8563780165188051, -.7388230427502611),
                                Vec3(-.3302976596304097, .27218280275438334, -.39474097649887385),
                                Vec3(-.12444927496493863, .5511205687693266, .46266470608752086)};
  ASSERT_TRUE(meets_by_clipping(tetrahedron, {a, b, c}));
  geom::Mesh mesh;
  mesh.vertices = {a, b, c, Vec3(-1, -1, -1)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  std::vector<std::uint32_t> met;
  EXPECT_FALSE(ReferenceSolid(mesh).contains(tetrahedron, false, &met));
  EXPECT_NE(std::find(met.begin(), met.end(), 0U), met.end());
}

// Four triangles at once, of those gathered near a box, give the same answers and the same
// triangles met as the hierarchy does, one by one.
TEST(ReferenceSolid, SurroundingsChangeNoAnswer) {
  std::mt19937_64 random(63);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  std::size_t accepted = 0, refused = 0;
  for (const auto& f : test::closed_families()) {
    if (f.mesh.triangles.size() > 3000) continue;
    const ReferenceSolid solid(f.mesh);
    const double size = geom::bounding_box(f.mesh).diagonal();
    ReferenceSolid::Surroundings around;
    for (int i = 0; i < 80; ++i) {
      // Corners at vertices of the mesh and near them.
      const auto& tri = f.mesh.triangles[random() % f.mesh.triangles.size()];
      Tetrahedron t;
      for (std::size_t k = 0; k < 4; ++k) {
        t[k] = f.mesh.vertices[tri[k % 3]];
        if (k == 3 || i % 3 == 0)
          t[k] += std::pow(10.0, -1 - static_cast<double>(i % 4)) * size *
                  Vec3(unit(random), unit(random), unit(random));
      }
      if (!has_volume(t)) continue;
      geom::Box3 box;
      for (const Vec3& p : t) box.extend(p);
      if (i % 2 == 0) box.extend(box.min - 0.2 * (box.max - box.min));
      if (!around.hold(box)) solid.look_around(box, around);
      ASSERT_TRUE(around.hold(box));
      for (const bool inside : {false, true}) {
        std::vector<std::uint32_t> met, met_around{7};
        const bool ok = solid.contains(t, inside, &met);
        ASSERT_EQ(solid.contains(t, inside, &met_around, around), ok) << f.name;
        ASSERT_EQ(met_around, met) << f.name;
        ++(ok ? accepted : refused);
      }
    }
  }
  EXPECT_GT(accepted, 300U);
  EXPECT_GT(refused, 300U);
}

// Against the slow oracle, and the checker's own implementation: tetrahedra that are accepted lie
// outside (inside) at every point tried, and both implementations agree.
TEST(ReferenceSolid, AcceptsOnlyWhatLiesOutside) {
  std::mt19937_64 random(62);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t accepted = 0, refused = 0, differ = 0;
  for (const auto& f : test::closed_families()) {
    if (!f.solid || f.mesh.triangles.size() > 1500) continue;
    geom::Prepared p;
    try {
      p = geom::prepare(f.mesh);
    } catch (const Error&) {
      continue;
    }
    ReferenceSolid solid(p.solid.mesh());
    std::vector<verify::ReplaySolid::Point> points;
    for (const Vec3& v : p.solid.mesh().vertices) points.emplace_back(v.x(), v.y(), v.z());
    verify::ReplaySolid checker(points, p.solid.mesh().triangles);
    const geom::WindingNumber winding(p.solid.mesh());
    const geom::Box3 box = geom::bounding_box(p.solid.mesh());
    for (int i = 0; i < 60; ++i) {
      // Corners at vertices of the mesh and near them.
      Tetrahedron t;
      const auto& tri = p.solid.mesh().triangles[random() % p.solid.mesh().triangles.size()];
      for (std::size_t k = 0; k < 4; ++k) {
        t[k] = p.solid.mesh().vertices[tri[k % 3]];
        if (k == 3 || i % 3 == 0)
          t[k] += std::pow(10.0, -1 - static_cast<double>(i % 4)) * box.diagonal() *
                  (Vec3(unit(random), unit(random), unit(random)) - Vec3::Constant(0.5));
      }
      if (!has_volume(t)) continue;
      for (const bool inside : {false, true}) {
        const bool ok = solid.contains(t, inside);
        // The checker goes on where the other finds no double inside.
        const auto checked =
            checker.contains({verify::ReplaySolid::Point(t[0].x(), t[0].y(), t[0].z()),
                              verify::ReplaySolid::Point(t[1].x(), t[1].y(), t[1].z()),
                              verify::ReplaySolid::Point(t[2].x(), t[2].y(), t[2].z()),
                              verify::ReplaySolid::Point(t[3].x(), t[3].y(), t[3].z())},
                             inside);
        ASSERT_GE(checked, ok) << f.name;
        differ += checked != ok;
        ++(ok ? accepted : refused);
        if (!ok) continue;
        for (int j = 0; j < 20; ++j) {
          Eigen::Vector4d w(unit(random), unit(random), unit(random), unit(random));
          w /= w.sum();
          const auto n = winding(w[0] * t[0] + w[1] * t[1] + w[2] * t[2] + w[3] * t[3]);
          if (!n) continue;
          EXPECT_EQ(*n >= 1, inside) << f.name;
        }
      }
    }
  }
  EXPECT_LE(differ, (accepted + refused) / 100);
  EXPECT_GT(accepted, 500U);
  EXPECT_GT(refused, 500U);
}

}  // namespace
