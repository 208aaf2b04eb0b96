#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/points_near.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <random>

#include "support/families.h"
#include "support/fan.h"
#include "upper_distances.h"

namespace {

using kaboum::geom::directed_distance;
using kaboum::geom::DistanceQuery;
using kaboum::geom::Mesh;
using kaboum::geom::point_triangle_distance;
using kaboum::geom::Vec3;

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>,
                                           boost::multiprecision::et_off>;
using Vec3l = Eigen::Matrix<Real, 3, 1>;

/// Distance by projection onto the plane, the edges' lines and the corners, in 60 digits.
Real slow_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3l x = p.cast<Real>();
  const std::array<Vec3l, 3> t{a.cast<Real>(), b.cast<Real>(), c.cast<Real>()};
  Real best = std::min({Real((x - t[0]).norm()), Real((x - t[1]).norm()), Real((x - t[2]).norm())});
  for (int k = 0; k < 3; ++k) {
    const Vec3l e = t[(k + 1) % 3] - t[k];
    if (e.squaredNorm() == 0) continue;
    const Real s = (x - t[k]).dot(e) / e.squaredNorm();
    if (s > 0 && s < 1) best = std::min(best, Real((x - t[k] - s * e).norm()));
  }
  const Vec3l n = (t[1] - t[0]).cross(t[2] - t[0]);
  if (n.squaredNorm() == 0) return best;
  bool inside = true;
  for (int k = 0; k < 3; ++k)
    inside = inside && (t[(k + 1) % 3] - t[k]).cross(x - t[k]).dot(n) >= 0;
  return inside ? std::min(best, Real(abs((x - t[0]).dot(n)) / n.norm())) : best;
}

TEST(PointTriangle, BracketsTheDistanceAlsoOfSlivers) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 10000; ++i) {
    const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    const Vec3 a = point();
    const Vec3 b = point();
    Vec3 c = point();
    if (i % 3 == 1)
      c = a + unit(random) * (b - a) + std::pow(10.0, -4 - i % 12) * point();  // sliver
    if (i % 17 == 0) c = b;                                                    // segment
    Vec3 p = point() * (i % 5 == 0 ? 100 : 1);
    if (i % 7 == 0) p = a + 0.3 * (b - a) + 0.2 * (c - a) + 1e-9 * point();
    const auto d = point_triangle_distance(p, a, b, c);
    const Real slow = slow_distance(p, a, b, c);
    ASSERT_LE(Real(d.lower), slow) << i;
    ASSERT_GE(Real(d.upper), slow) << i;
    if (i % 3 != 1) {
      ASSERT_LE(d.upper - d.lower, 1e-9 * d.upper + 1e-12) << i;
    }
  }
}

// Never true where a point is farther, by however little, and true where rounding is no matter.
TEST(PointTriangle, SeveralPointsAreWithinAsEachIs) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  std::array<int, 2> seen{0, 0};
  for (int i = 0; i < 5000; ++i) {
    const Vec3 far = i % 4 == 0 ? Vec3(1000 * point()) : Vec3::Zero();
    const Vec3 a = far + point(), b = far + point();
    const bool sliver = i % 3 == 1;
    const Vec3 c = i % 17 == 0 ? b
                   : sliver
                       ? Vec3(a + unit(random) * (b - a) + std::pow(10.0, -4 - i % 12) * point())
                       : Vec3(far + point());
    std::vector<Vec3> points;
    Real farthest = 0;
    for (int k = 0; k <= i % 8; ++k) {
      points.emplace_back(far + (i % 5 == 0 ? 100 : 1) * point());
      if (i % 7 == 0) points.back() = a + 0.3 * (b - a) + 0.2 * (c - a) + 1e-9 * point();
      farthest = std::max(farthest, slow_distance(points.back(), a, b, c));
    }
    std::vector<double> uppers(points.size());
    kaboum::geom::upper_distances(points, a, b, c, uppers.data());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Real slow = slow_distance(points[k], a, b, c);
      ASSERT_GE(Real(uppers[k]), slow) << i;
      if (!sliver && i % 17 != 0) {
        ASSERT_LE(Real(uppers[k]), slow * (1 + 1e-9) + 1e-10) << i;
      }
    }
    const auto nearest = static_cast<double>(farthest);
    for (const double share : {-1e-9, -1e-13, -1e-14, -1e-15, -1e-16, 0.0, 1e-15, 1e-14, 1e-13}) {
      const double radius = nearest * (1 + share);
      const bool within = kaboum::geom::all_within(points, a, b, c, radius);
      ASSERT_TRUE(!within || farthest <= Real(radius)) << i << ' ' << share;
      ++seen[within ? 1 : 0];
    }
    if (sliver || i % 17 == 0 || i % 7 == 0) continue;
    ASSERT_TRUE(kaboum::geom::all_within(points, a, b, c, nearest * (1 + 1e-9))) << i;
    std::swap(points.front(), points.back());
    ASSERT_FALSE(kaboum::geom::all_within(points, a, b, c, nearest * (1 - 1e-9))) << i;
  }
  EXPECT_GT(seen[0], 1000);
  EXPECT_GT(seen[1], 1000);
}

TEST(DistanceQuery, FindsTheNearestTriangle) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-0.5, 1.5);
  for (const auto& family : kaboum::test::closed_families()) {
    const Mesh& mesh = family.mesh;
    if (mesh.triangles.size() > 2000) continue;
    const DistanceQuery query(mesh);
    const auto box = kaboum::geom::bounding_box(mesh);
    for (int i = 0; i < 3; ++i) {
      const Vec3 p =
          box.min + Vec3(unit(random), unit(random), unit(random)).cwiseProduct(box.max - box.min);
      Real slow = 1e300;
      for (const auto& t : mesh.triangles)
        slow = std::min(
            slow, slow_distance(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
      for (const std::uint32_t hint : {DistanceQuery::kNone, std::uint32_t{0}}) {
        const auto n = query.nearest(p, hint);
        EXPECT_LE(Real(n.lower), slow) << family.name;
        EXPECT_GE(Real(n.upper), slow) << family.name;
        EXPECT_LE(n.upper - n.lower, 1e-9 * box.diagonal()) << family.name;
      }
      EXPECT_NE(query.within(p, static_cast<double>(slow) * 1.001 + 1e-9 * box.diagonal()),
                DistanceQuery::kNone);
      EXPECT_EQ(query.within(p, static_cast<double>(slow) * 0.999), DistanceQuery::kNone);
    }
  }
}

// The boxes of needles round a tip, slanted, all hold each other.
TEST(DistanceQuery, LooksAtFewOfManyNeedles) {
  const Mesh mesh = kaboum::test::double_fan(1000);
  const DistanceQuery query(mesh);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  std::uint64_t looked = 0;
  constexpr int kPoints = 100;
  for (int i = 0; i < kPoints; ++i) {
    const auto& at = mesh.triangles[random() % mesh.triangles.size()];
    Vec3 p = mesh.vertices[at[0]];
    p += unit(random) * (mesh.vertices[at[2]] - p);
    p *= 0.97;
    double lower = std::numeric_limits<double>::infinity(), upper = lower;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto d = query.to_triangle(p, t);
      lower = std::min(lower, d.lower);
      upper = std::min(upper, d.upper);
    }
    const auto n = query.nearest(p);
    looked += n.looked;
    EXPECT_EQ(n.upper, upper);
    EXPECT_EQ(n.lower, lower);
    EXPECT_EQ(query.to_triangle(p, n.triangle).upper, upper);
    EXPECT_NE(query.within(p, 1.001 * upper), DistanceQuery::kNone);
    EXPECT_EQ(query.within(p, 0.999 * lower), DistanceQuery::kNone);
  }
  EXPECT_LT(looked, 100U * kPoints);
}

TEST(DistanceQuery, PartsOfTrianglesCoverThem) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  const Mesh mesh = kaboum::test::double_fan(500);
  const auto tree = kaboum::geom::Bvh::of_parts(mesh);
  ASSERT_GT(tree.order().size(), 2 * mesh.triangles.size());
  for (int i = 0; i < 5000; ++i) {
    const auto index = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    const auto& t = mesh.triangles[index];
    double r = unit(random), s = unit(random);
    if (r + s > 1) r = 1 - r, s = 1 - s;
    if (i % 9 == 0) r = 0;
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3 p = a + r * (mesh.vertices[t[1]] - a) + s * (mesh.vertices[t[2]] - a);
    bool found = false;
    tree.traverse(
        [&](const kaboum::geom::Box3& box) {
          return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
        },
        [&](std::uint32_t triangle) { found = found || triangle == index; });
    ASSERT_TRUE(found) << i;
  }
}

Mesh scaled_about_center(Mesh mesh, double factor) {
  const Vec3 c = kaboum::geom::bounding_box(mesh).center();
  for (Vec3& v : mesh.vertices) v = c + factor * (v - c);
  return mesh;
}

TEST(DirectedDistance, BracketsSamplesAndItselfIsZero) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const auto& family : kaboum::test::closed_families()) {
    const Mesh& a = family.mesh;
    if (a.triangles.size() > 3000) continue;
    const Mesh b = scaled_about_center(a, 1.1);
    const DistanceQuery query(b);
    const auto d = directed_distance(a, query);
    EXPECT_LE(d.max_lower, d.max_upper);
    EXPECT_LE(d.max_upper, std::max(d.max_lower * (1 + 1.1e-3),
                                    d.max_lower + 2e-9 * kaboum::geom::bounding_box(b).diagonal()) +
                               1e-12 * kaboum::geom::bounding_box(b).max.cwiseAbs().maxCoeff())
        << family.name;
    for (int i = 0; i < 300; ++i) {
      const auto& t = a.triangles[static_cast<std::size_t>(
          unit(random) * static_cast<double>(a.triangles.size()))];
      double s = unit(random), r = unit(random);
      if (s + r > 1) s = 1 - s, r = 1 - r;
      const Vec3 p = a.vertices[t[0]] + s * (a.vertices[t[1]] - a.vertices[t[0]]) +
                     r * (a.vertices[t[2]] - a.vertices[t[0]]);
      // p is not quite a point of A: three operations per coordinate are rounded.
      const double off = 2e-15 * p.cwiseAbs().maxCoeff();
      EXPECT_LE(query.nearest(p).lower - off, d.max_upper) << family.name;
    }
    const auto self = directed_distance(a, DistanceQuery(a));
    EXPECT_LE(self.max_upper, 1e-8 * kaboum::geom::bounding_box(a).diagonal() +
                                  1e-12 * kaboum::geom::bounding_box(a).max.cwiseAbs().maxCoeff())
        << family.name;
  }
}

// The maximum of the distance from a big triangle to two small ones at its ends lies in its middle,
// where no vertex is.
// The farthest point is a vertex of A far from the origin, where cuts would move it by more than
// the distance.
TEST(DirectedDistance, IsExactAtVerticesFarFromTheOrigin) {
  for (const double far : {0.0, 1e6, 1e8, 1e9}) {
    const Vec3 o = Vec3::Constant(far);
    const Mesh b{{o, o + Vec3(1, 0, 0), o + Vec3(1, 1, 0), o + Vec3(0, 1, 0)},
                 {{0, 1, 2}, {0, 2, 3}}};
    Mesh a = b;
    const double height = 0x1p-20;
    a.vertices[1][2] += height;
    const double raised = a.vertices[1][2] - far;  // as rounded
    const auto d = directed_distance(a, DistanceQuery(b));
    EXPECT_TRUE(d.within_gap) << far;
    EXPECT_LE(d.max_lower, raised);
    EXPECT_GE(d.max_upper, raised);
    EXPECT_LE(d.max_upper - d.max_lower, 1e-3 * height + 3e-14 * far) << far;
  }
}

TEST(DirectedDistance, FindsMaximaInsideFaces) {
  const Mesh a{{{0, 0, 0}, {10, 0, 0}, {5, 0.001, 0}}, {{0, 1, 2}}};
  const Mesh b{{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {10, 0, 0}, {10, 1, 0}, {10, 0, 1}},
               {{0, 1, 2}, {3, 4, 5}}};
  const auto d = directed_distance(a, DistanceQuery(b));
  EXPECT_NEAR(d.max_lower, 5, 0.006);
  EXPECT_GE(d.max_upper, 5 - 1e-6);
}

// One big triangle over a fine triangulation of itself with one triangle left out: the largest
// distance is the radius of the hole's inscribed circle, and no vertex shows it. Whoever loses a
// piece of the big triangle may lose the hole.
TEST(DirectedDistance, FindsAHoleInACoplanarTriangulation) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr int kRows = 9;
  for (int run = 0; run < 60; ++run) {
    const Vec3 o(unit(random), unit(random), unit(random));
    const Vec3 u(1 + unit(random), unit(random), unit(random)),
        v(unit(random), 1 + unit(random), -unit(random));
    const Mesh a{{o, o + u, o + v}, {{0, 1, 2}}};
    Mesh b;
    const auto index = [](int i, int j) {
      return static_cast<std::uint32_t>(i * (kRows + 1) - i * (i - 1) / 2 + j);
    };
    for (int i = 0; i <= kRows; ++i)
      for (int j = 0; j <= kRows - i; ++j) b.vertices.push_back(o + (i * u + j * v) / kRows);
    for (int i = 0; i < kRows; ++i)
      for (int j = 0; j < kRows - i; ++j) {
        b.triangles.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
        if (j + 1 < kRows - i)
          b.triangles.push_back({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
      }
    const auto hole = static_cast<std::ptrdiff_t>(random() % b.triangles.size());
    const auto t = b.triangles[static_cast<std::size_t>(hole)];
    b.triangles.erase(b.triangles.begin() + hole);
    // A side of the hole on the big triangle's border has nothing beyond it.
    const Vec3 &p = b.vertices[t[0]], &q = b.vertices[t[1]], &r = b.vertices[t[2]];
    const auto d = directed_distance(a, DistanceQuery(b));
    const double radius =
        (q - p).cross(r - p).norm() / ((q - p).norm() + (r - q).norm() + (p - r).norm());
    EXPECT_GE(d.max_upper, radius * (1 - 1e-12)) << run;
    EXPECT_LE(d.max_upper, d.max_lower * (1 + 1.1e-3)) << run;
    EXPECT_GE(d.max_lower, radius * (1 - 2e-3)) << run;
    // And it is the distance at that point.
    EXPECT_LE(d.max_lower, DistanceQuery(b).nearest(d.at).upper) << run;
  }
}

// Against a plane the largest distance is at a vertex of A, whatever the clusters of A look like;
// a wide gap lets them settle early.
TEST(DirectedDistance, ClustersNeverHideAVertex) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int run = 0; run < 120; ++run) {
    const Vec3 n = Vec3(unit(random), unit(random), unit(random)).normalized();
    const Vec3 x = n.unitOrthogonal(), y = n.cross(x);
    const Mesh b{{-50 * x - 50 * y, 90 * x - 10 * y, -10 * x + 90 * y}, {{0, 1, 2}}};
    Mesh a;
    constexpr int kSide = 30;
    const double base = run % 2 == 0 ? 1.0 : 0.3;
    for (int i = 0; i <= kSide; ++i)
      for (int j = 0; j <= kSide; ++j)
        a.vertices.push_back(0.01 * i * x + 0.01 * j * y + (base + 0.001 * unit(random)) * n);
    a.vertices[random() % a.vertices.size()] += 0.3 * base * n;
    for (std::uint32_t i = 0; i < kSide; ++i)
      for (std::uint32_t j = 0; j < kSide; ++j) {
        const std::uint32_t v = i * (kSide + 1) + j;
        a.triangles.push_back({v, v + kSide + 1, v + 1});
        a.triangles.push_back({v + kSide + 1, v + kSide + 2, v + 1});
      }
    double largest = 0;
    for (const Vec3& v : a.vertices) largest = std::max(largest, n.dot(v));
    for (const double gap : {1e-3, 0.05, 0.25, 0.5}) {
      const auto d = directed_distance(a, DistanceQuery(b), {gap, 0});
      EXPECT_GE(d.max_upper, largest * (1 - 1e-12)) << run << " " << gap;
      EXPECT_LE(d.max_lower, largest * (1 + 1e-12)) << run << " " << gap;
      EXPECT_LE(d.max_upper, d.max_lower * (1 + gap) + 1e-12) << run << " " << gap;
    }
  }
}

/// A floor with a hundred dents: the deepest one is found, whatever lies open beside it.
TEST(DirectedDistance, FindsTheDeepestOfManyDents) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int run = 0; run < 20; ++run) {
    Mesh floor{{{-1, -1, 0}, {11, -1, 0}, {11, 11, 0}, {-1, 11, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    Mesh dents;
    double deepest = 0;
    for (int i = 0; i < 100; ++i) {
      const double x = i % 10, y = i / 10;
      const double depth = 0.1 + 0.2 * unit(random);
      deepest = std::max(deepest, depth);
      const auto first = static_cast<std::uint32_t>(dents.vertices.size());
      for (const Vec3& v : {Vec3(x, y, 0), Vec3(x + 1, y, 0), Vec3(x + 1, y + 1, 0),
                            Vec3(x, y + 1, 0), Vec3(x + 0.5, y + 0.5, -depth)})
        dents.vertices.push_back(v);
      for (std::uint32_t k = 0; k < 4; ++k)
        dents.triangles.push_back({first + k, first + (k + 1) % 4, first + 4});
    }
    const auto d = directed_distance(dents, DistanceQuery(floor), {1e-6, 0});
    EXPECT_LE(d.max_lower, deepest) << run;
    EXPECT_GE(d.max_upper, deepest) << run;
    EXPECT_LE(d.max_upper, deepest * (1 + 2e-6)) << run;
    // From the floor it is nearer to a dent's walls than its tip is deep.
    const auto back = directed_distance(floor, DistanceQuery(dents), {1e-3, 0});
    EXPECT_TRUE(back.within_gap) << run;
    double sampled = 0;
    const DistanceQuery query(dents);
    for (int i = 0; i < 2000; ++i)
      sampled =
          std::max(sampled, query.nearest({12 * unit(random) - 1, 12 * unit(random) - 1, 0}).lower);
    EXPECT_GE(back.max_upper, sampled) << run;
  }
}

TEST(DirectedDistance, DoesNotDependOnTheNumberOfThreads) {
  const auto families = kaboum::test::closed_families();
  const Mesh& a = families.front().mesh;
  const Mesh b = scaled_about_center(a, 1.07);
  const DistanceQuery query(b);
  const auto many = directed_distance(a, query);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = directed_distance(a, query);
  EXPECT_EQ(many.max_lower, single.max_lower);
  EXPECT_EQ(many.max_upper, single.max_upper);
  EXPECT_EQ(many.queries, single.queries);
  EXPECT_EQ(many.at, single.at);
}

}  // namespace
