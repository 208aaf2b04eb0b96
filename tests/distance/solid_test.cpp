#include <kaboum/base/error.h>
#include <kaboum/distance/search.h>
#include <kaboum/distance/solid.h>
#include <kaboum/geom/convex_hull.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "support/families.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace {

using kaboum::distance::Boundary;
using kaboum::distance::make_search;
using kaboum::distance::Solid;
using kaboum::distance::solid_boundary;
using kaboum::distance::SolidDistance;
using kaboum::geom::ConvexSet;
using kaboum::geom::DistanceOptions;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;
using kaboum::test::flipped;
using kaboum::test::merged;

Mesh divided_block(const Vec3& low, const Vec3& high, int n = 1) {
  return kaboum::test::translated(kaboum::test::box(high - low, n), low);
}

SolidDistance distance(const Solid& a, const Solid& b, const DistanceOptions& options = {}) {
  const auto search_a = make_search(a.boundary().mesh, kaboum::distance::Backend::Embree),
             search_b = make_search(b.boundary().mesh, kaboum::distance::Backend::Embree);
  return solid_distance(a, b, *search_a, *search_b, options);
}
SolidDistance distance(const Mesh& a, const Mesh& b, const DistanceOptions& options = {}) {
  return distance(Solid(a), Solid(b), options);
}

void expect_value(const SolidDistance& d, double value, double tolerance = 0) {
  EXPECT_LE(d.max_lower, value + tolerance + 1e-14);
  EXPECT_GE(d.max_upper, value - tolerance - 1e-14);
  EXPECT_LE(d.max_upper, std::max(d.max_lower * 1.001, d.max_lower + 1e-8) + 1e-14);
  EXPECT_TRUE(d.within_gap);
}

ConvexSet set_of(const std::vector<Mesh>& bodies, double margin = 0) {
  ConvexSet set;
  for (const Mesh& body : bodies)
    set.bodies.push_back({"body " + std::to_string(set.bodies.size()), body});
  set_margin(set, margin);
  return set;
}

// -- boundary ------------------------------------------------------------------------------------

double area_of(const Mesh& mesh) { return kaboum::geom::area(solid_boundary(mesh).mesh); }

TEST(SolidBoundary, OfBoxesThatMeet) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1}, 2);
  const auto at = [&](double x, double y, double z) {
    return kaboum::test::translated(cube, {x, y, z});
  };
  EXPECT_NEAR(area_of(cube), 6, 1e-12);
  EXPECT_EQ(solid_boundary(cube).error, 0);
  EXPECT_NEAR(area_of(merged({cube, cube})), 6, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, at(0.5, 0, 0)})), 8, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, at(0.25, 0.125, 0.375)})),
              12 - 2 * (0.875 * 0.625 + 0.75 * 0.625 + 0.75 * 0.875), 1e-12);
  EXPECT_NEAR(area_of(merged({cube, at(1, 0, 0)})), 10, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, at(1, 0.25, 0)})), 10.5, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, at(1, 1, 0)})), 12, 1e-12);
  // A fold inside, a cavity, a box that sticks out, a pocket cut by an inverted box, a sheet.
  EXPECT_NEAR(area_of(merged({cube, divided_block({.25, .25, .25}, {.75, .75, .75})})), 6, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, flipped(divided_block({.25, .25, .25}, {.75, .75, .75}))})),
              7.5, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, divided_block({.5, .25, .25}, {1.5, .75, .75})})), 7, 1e-12);
  EXPECT_NEAR(area_of(merged({cube, flipped(divided_block({.5, .25, .25}, {1.5, .75, .75}))})), 7,
              1e-12);
  const Mesh sheet{{{2, 0, 0}, {3, 0, 0}, {2, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_NEAR(area_of(merged({cube, sheet})), 6, 1e-12);
}

TEST(SolidBoundary, RefusesWhatHasNoSolid) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(solid_boundary(flipped(cube)), kaboum::Error);
  Mesh open = cube;
  open.triangles.pop_back();
  EXPECT_THROW(solid_boundary(open), kaboum::Error);
}

/// Winding number by solid angles, rounded.
double solid_angle(const Mesh& mesh, const Vec3& p) {
  double sum = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.vertices[i] - p, b = mesh.vertices[j] - p, c = mesh.vertices[k] - p;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    sum +=
        2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return sum / (4 * M_PI);
}

/// A closed chain that crosses itself: blocks and hulls on a coarse grid, some inside out, so that
/// faces, edges and corners coincide often.
Mesh tangle(std::mt19937_64& random, int parts, bool grid) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] {
    Vec3 p(unit(random), unit(random), unit(random));
    if (grid) p = (4 * p).array().floor() / 4;
    return p;
  };
  std::vector<Mesh> meshes{divided_block({0, 0, 0}, {0.75, 0.75, 0.75})};
  for (int i = 0; i < parts; ++i) {
    Mesh part;
    if (random() % 2 == 0) {
      const Vec3 low = point();
      part = divided_block(low, low + (grid ? Vec3(Vec3::Constant(0.25) + point())
                                            : Vec3(Vec3::Constant(0.1) + 0.7 * point())));
    } else {
      std::vector<Vec3> points;
      while (points.size() < 5) points.push_back(point());
      const auto hull = kaboum::geom::convex_hull(points);
      if (!hull) continue;
      part = *hull;
    }
    meshes.push_back(random() % 3 == 0 ? flipped(part) : part);
  }
  return merged(meshes);
}

// The boundary goes once round every point inside, and not at all round one outside.
TEST(SolidBoundary, GoesRoundTheSolidOnce) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-0.3, 2);
  for (int i = 0; i < 40; ++i) {
    const Mesh mesh = tangle(random, 1 + i % 5, i % 3 != 0);
    const Boundary boundary = solid_boundary(mesh);
    ASSERT_EQ(boundary.mesh.triangles.size(), boundary.facet.size());
    for (int k = 0; k < 60; ++k) {
      const Vec3 p(unit(random), unit(random), unit(random));
      const auto w = kaboum::test::winding_number_slow(mesh, p);
      if (!w) continue;
      EXPECT_NEAR(solid_angle(boundary.mesh, p), *w >= 1 ? 1 : 0, 1e-6) << i;
    }
    for (std::size_t t = 0; t < boundary.facet.size(); ++t) {
      const auto normal = [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return (b - a).cross(c - a);
      };
      const auto& v = boundary.mesh.triangles[t];
      const auto& x = boundary.mesh.vertices;
      const auto& f = boundary.facet[t];
      EXPECT_GE(normal(x[v[0]], x[v[1]], x[v[2]]).dot(normal(f[0], f[1], f[2])), -1e-15) << i;
    }
  }
}

// -- known distances -----------------------------------------------------------------------------

TEST(SolidDistance, IsLargestInsideCavities) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1});
  const auto with = [&](const std::vector<std::pair<Vec3, Vec3>>& cavities) {
    std::vector<Mesh> parts{cube};
    for (const auto& [low, high] : cavities) parts.push_back(flipped(divided_block(low, high)));
    return merged(parts);
  };
  const Mesh cubic = with({{{.3, .3, .3}, {.7, .7, .7}}});
  const SolidDistance d = distance(cube, cubic);
  expect_value(d, 0.2);
  EXPECT_TRUE(d.inside);
  EXPECT_LT((d.at - Vec3(.5, .5, .5)).norm(), 1e-3);
  expect_value(distance(cubic, cube), 0);
  expect_value(distance(cube, with({{{.1, .1, .4}, {.9, .9, .5}}})), 0.05);
  expect_value(distance(cube, with({{{.1, .1, .1}, {.2, .2, .2}}, {{.5, .5, .5}, {.9, .8, .7}}})),
               0.1);
  // The same cavity in both counts for neither.
  expect_value(distance(with({{{.1, .1, .1}, {.2, .2, .2}}, {{.5, .5, .5}, {.9, .8, .7}}}),
                        with({{{.5, .5, .5}, {.9, .8, .7}}})),
               0);
  // A shell: B's inner sphere, finely tessellated.
  const Mesh ball = kaboum::test::icosphere(3);
  const Mesh inner = kaboum::test::scaled(ball, {.5, .5, .5});
  const SolidDistance shell = distance(ball, merged({ball, flipped(inner)}));
  expect_value(shell, make_search(inner, kaboum::distance::Backend::Own)->nearest({0, 0, 0}).upper,
               1e-3);
}

TEST(SolidDistance, OfConcaveAndDisconnectedSolids) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1});
  expect_value(distance(divided_block({0, 0, 0}, {3, 1, 1}),
                        merged({cube, kaboum::test::translated(cube, {2, 0, 0})})),
               0.5);
  // A pocket, cut by an inverted box of which the rest, w = −1, is no part of the solid; a box.
  const Mesh pocket = merged({cube, flipped(divided_block({.5, .25, .25}, {1.5, .75, .75}))});
  expect_value(distance(cube, pocket), 0.25);
  expect_value(distance(pocket, cube), 0);
  const Mesh nose = merged({cube, divided_block({.5, .25, .25}, {1.5, .75, .75})});
  expect_value(distance(nose, cube), 0.5);
  expect_value(distance(cube, nose), 0);
  const Mesh ring = kaboum::test::torus(1, 0.25, 96, 48);
  const auto hull = kaboum::geom::convex_hull(ring.vertices);
  const SolidDistance d = distance(*hull, ring);
  expect_value(d, std::sqrt(1 + 0.0625) - 0.25, 2e-3);
  expect_value(distance(ring, *hull), 0);
  // Cubes that share an edge, and a corner.
  for (const Vec3& by : {Vec3(1, 1, 0), Vec3(1, 1, 1)}) {
    const Mesh two = merged({cube, kaboum::test::translated(cube, by)});
    expect_value(distance(two, two), 0);
  }
}

// Only the tip is outside; every triangle has its first corner and its centroid inside.
TEST(SolidDistance, OfATipThatSticksOut) {
  const Mesh tip{{{.3, .3, .2}, {.7, .3, .2}, {.5, .7, .2}, {.5, .5, 1.3}},
                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  expect_value(distance(tip, divided_block({0, 0, 0}, {1, 1, 1})), 0.3);
}

TEST(SolidDistance, DoesNotSeeInteriorFolds) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1}, 3);
  const Mesh folded = merged({cube, divided_block({.25, .25, .25}, {.75, .75, .75}), cube});
  expect_value(distance(cube, folded), 0);
  expect_value(distance(folded, cube), 0);
  const Mesh hollow = merged({cube, flipped(divided_block({.25, .25, .25}, {.75, .75, .75}))});
  expect_value(distance(folded, hollow), 0.25);
  // w = −1 all over a far box: no part of either solid.
  const Mesh ghost = merged({cube, flipped(divided_block({5, 5, 5}, {6, 6, 6}))});
  expect_value(distance(ghost, cube), 0);
  expect_value(distance(cube, ghost), 0);
}

// -- random solids against brute force ------------------------------------------------------------

/// A solid for the oracle: membership by an independent winding number.
struct GridShape {
  std::vector<Mesh> parts;  ///< a point is inside if some part winds round it
  [[nodiscard]] bool contains(const Vec3& p) const {
    return std::any_of(parts.begin(), parts.end(), [&](const Mesh& m) {
      return kaboum::test::winding_number_slow(m, p).value_or(0) >= 1;
    });
  }
  /// Lower bound of the distance of a point outside.
  [[nodiscard]] double to_triangles(const Vec3& p) const {
    double least = 1e300;
    for (const Mesh& m : parts)
      for (const auto& [i, j, k] : m.triangles)
        least = std::min(least, kaboum::geom::point_triangle_distance(p, m.vertices[i],
                                                                      m.vertices[j], m.vertices[k])
                                    .lower);
    return least;
  }
};

/// Bounds of the largest distance from points of a grid: sampled below; above, by the points of B
/// that are on the grid.
std::pair<double, double> by_grid(const GridShape& a, const GridShape& b) {
  constexpr int kSteps = 12;
  constexpr double kStep = 2.6 / kSteps, kLow = -0.3;
  const double half = 0.5 * std::sqrt(3.0) * kStep;
  std::vector<Vec3> of_a, of_b;
  double lower = 0;
  for (int x = 0; x <= kSteps; ++x)
    for (int y = 0; y <= kSteps; ++y)
      for (int z = 0; z <= kSteps; ++z) {
        // Off the grid of the shapes.
        const Vec3 p = Vec3(kLow + 0.0123, kLow + 0.0071, kLow + 0.0037) + kStep * Vec3(x, y, z);
        const bool in_a = a.contains(p), in_b = b.contains(p);
        if (in_b) of_b.push_back(p);
        if (in_a && !in_b) lower = std::max(lower, b.to_triangles(p));
        if (in_a || a.to_triangles(p) <= half) of_a.push_back(p);
      }
  double upper = 0;
  for (const Vec3& p : of_a) {
    double least = 1e300;
    for (const Vec3& q : of_b) least = std::min(least, (p - q).norm());
    upper = std::max(upper, least + half);
  }
  return {lower, upper};
}

TEST(SolidDistance, OfRandomTanglesIsWhatAGridSays) {
  std::mt19937_64 random(17);
  // Where solids touch themselves along an edge, finer gaps may not be reached.
  DistanceOptions options;
  options.absolute_gap = 1e-3;
  for (int i = 0; i < 8; ++i) {
    const Mesh a = tangle(random, 1 + i % 3, i % 2 == 0), b = tangle(random, 1 + i % 4, i % 2 == 0);
    const SolidDistance d = distance(a, b, options);
    const auto [lower, upper] = by_grid({{a}}, {{b}});
    EXPECT_GE(d.max_upper, lower) << i;
    EXPECT_LE(d.max_lower, upper) << i;
    EXPECT_TRUE(d.within_gap) << i << " " << d.max_lower << " " << d.max_upper;
    const SolidDistance self = distance(a, a, options);
    EXPECT_EQ(self.max_lower, 0) << i;
    EXPECT_TRUE(self.within_gap) << i << " " << self.max_upper;
  }
}

TEST(SolidDistance, OfRandomSetsIsThatOfTheirMeshes) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 3; ++i) {
    const auto bodies = [&] {
      std::vector<Mesh> out;
      for (int k = 0; k < 3; ++k)
        out.push_back(kaboum::test::translated(
            kaboum::test::scaled(kaboum::test::random_hull(12, kaboum::test::Cloud::Sphere,
                                                           static_cast<std::uint32_t>(random())),
                                 Vec3::Constant(0.3)),
            Vec3(0.5 + unit(random), 0.5 + unit(random), 0.5 + unit(random))));
      return out;
    };
    const std::vector<Mesh> a = bodies(), b = bodies();
    const SolidDistance d = distance(Solid(set_of(a)), Solid(set_of(b)));
    const SolidDistance m = distance(merged(a), merged(b));
    EXPECT_TRUE(d.within_gap && m.within_gap);
    EXPECT_LE(d.max_lower, m.max_upper);
    EXPECT_LE(m.max_lower, d.max_upper);
    const auto [lower, upper] = by_grid({a}, {b});
    EXPECT_GE(d.max_upper, lower) << i;
    EXPECT_LE(d.max_lower, upper) << i;
    expect_value(distance(Solid(set_of(a)), Solid(merged(a))), 0);
    expect_value(distance(Solid(merged(a)), Solid(set_of(a))), 0);
  }
}

TEST(SolidDistance, DoesNotDependOnThreads) {
  std::mt19937_64 random(29);
  const Mesh a = tangle(random, 3, false), b = tangle(random, 3, false);
  const SolidDistance many = distance(a, b);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SolidDistance single = distance(a, b);
  EXPECT_EQ(many.max_lower, single.max_lower);
  EXPECT_EQ(many.max_upper, single.max_upper);
  EXPECT_EQ(many.cells, single.cells);
  EXPECT_EQ(many.queries, single.queries);
}

// -- margins -------------------------------------------------------------------------------------

TEST(SolidDistance, TakesMarginsIntoAccount) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1});
  const Mesh far = kaboum::test::translated(cube, {3, 0, 0});
  const Solid a(set_of({cube}, 0.1)), b(set_of({far}, 0.25)), plain(cube);
  expect_value(distance(a, b), 3 + 0.1 - 0.25);
  expect_value(distance(b, a), 3 + 0.25 - 0.1);
  expect_value(distance(a, plain), 0.1);
  expect_value(distance(plain, a), 0);
  expect_value(distance(a, a), 0);
  expect_value(distance(Solid(set_of({cube}, 0.25)), a), 0.15);
  // Between two bodies: the margin reaches into the middle of the gap, not beyond it.
  const Solid gap(set_of({cube, kaboum::test::translated(cube, {2, 0, 0})}, 0.125));
  const Mesh plate = divided_block({1.4, 0.25, 0.25}, {1.6, 0.75, 0.75});
  expect_value(distance(Solid(set_of({plate}, 0.2)), gap), 0.5 - 0.125);
  expect_value(distance(Solid(set_of({plate}, 0.2)),
                        Solid(merged({cube, kaboum::test::translated(cube, {2, 0, 0})}))),
               0.5);
  // Along an edge the farthest point is on the rounded part: from (1, 1, z) away from a cube at the
  // origin that is cut off by its own margin.
  const Solid corner(set_of({divided_block({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75})}));
  expect_value(distance(a, corner), std::sqrt(3.0) * 0.25 + 0.1);
  expect_value(distance(Solid(set_of({plate, cube}, 0.05)), Solid(set_of({plate, cube}))), 0.05);
}

// Random points of bodies with a margin are never farther than the upper bound.
TEST(SolidDistance, WithMarginsBoundsSampledPoints) {
  std::mt19937_64 random(31);
  std::normal_distribution<double> normal;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const Mesh body = kaboum::test::random_hull(10, kaboum::test::Cloud::Sphere, 40 + i);
    const Mesh other = kaboum::test::torus(1.2, 0.3, 16, 8);
    const double margin = 0.05 * (1 + i);
    const Solid a(set_of({body}, margin)), b(other);
    const SolidDistance d = distance(a, b);
    EXPECT_TRUE(d.within_gap) << d.max_lower << " " << d.max_upper;
    const auto search = make_search(b.boundary().mesh, kaboum::distance::Backend::Own);
    double largest = 0;
    for (int k = 0; k < 4000; ++k) {
      const auto& t = body.triangles[random() % body.triangles.size()];
      const Vec3 w = Vec3(normal(random), normal(random), normal(random)).cwiseAbs();
      const Vec3 p =
          (w[0] * body.vertices[t[0]] + w[1] * body.vertices[t[1]] + w[2] * body.vertices[t[2]]) /
          w.sum();
      const Vec3 x = p + margin * Vec3(normal(random), normal(random), normal(random)).normalized();
      largest = std::max(largest, b.distance(x, search->nearest(x).lower));
    }
    EXPECT_GE(d.max_upper, largest - 1e-12);
    EXPECT_LE(d.max_lower, largest * 1.2) << "far above anything sampled";
  }
}

TEST(SolidMinimum, IsZeroWhereSolidsMeet) {
  const Mesh cube = divided_block({0, 0, 0}, {1, 1, 1});
  const auto minimum = [](const Mesh& a, const Mesh& b) {
    return solid_minimum(Solid(a), Solid(b));
  };
  EXPECT_EQ(minimum(cube, divided_block({.25, .25, .25}, {.5, .5, .5})).upper, 0);
  EXPECT_EQ(minimum(divided_block({.25, .25, .25}, {.5, .5, .5}), cube).upper, 0);
  EXPECT_EQ(minimum(cube, divided_block({1, 0, 0}, {2, 1, 1})).upper, 0);
  // In a cavity.
  const Mesh hollow = merged({cube, flipped(divided_block({.25, .25, .25}, {.75, .75, .75}))});
  EXPECT_NEAR(minimum(hollow, divided_block({.5, .5, .5}, {.625, .625, .625})).lower, 0.125, 1e-12);
  const auto m = solid_minimum(Solid(set_of({cube}, 0.25)),
                               Solid(set_of({kaboum::test::translated(cube, {3, 0, 0})}, 0.5)));
  EXPECT_NEAR(m.lower, 1.25, 1e-12);
  EXPECT_NEAR(m.upper, 1.25, 1e-12);
}

// A corner on a fold inside the other solid has no winding number there; it is inside all the same.
TEST(SolidMinimum, CornersOnFolds) {
  const Solid b(kaboum::test::merged(
      {divided_block({0, 0, 0}, {4, 4, 4}), divided_block({2, 0, 0}, {6, 4, 4})}));
  const Solid a(divided_block({2, 1, 1}, {2.5, 2, 2}));
  for (const auto& m : {solid_minimum(a, b), solid_minimum(b, a)}) {
    EXPECT_EQ(m.lower, 0);
    EXPECT_EQ(m.upper, 0);
  }
}

// A body's triangle without area has no plane; the body is what it is without it.
TEST(UnionBoundary, TrianglesWithoutArea) {
  const Mesh without = divided_block({0, 0, 0}, {2, 1, 1});
  Mesh with = without;
  const auto middle = static_cast<std::uint32_t>(with.vertices.size());
  const auto [i, j, k] = with.triangles[0];
  with.vertices.emplace_back(0.5 * with.vertices[i] + 0.5 * with.vertices[j]);
  with.triangles[0] = {middle, j, k};
  with.triangles.insert(with.triangles.begin(), {{i, j, middle}, {i, middle, k}});
  const Mesh second = divided_block({1, 0, 0.5}, {3, 1, 2});
  const auto boundary = [&](const Mesh& mesh) {
    return kaboum::geom::area(kaboum::distance::union_boundary(set_of({mesh, second})).mesh);
  };
  EXPECT_DOUBLE_EQ(boundary(with), boundary(without));
}

// Bodies with radii of their own: brackets hold what is known, and are as narrow as a ball's
// polytope lets them.
TEST(SolidDistance, OfBallsAndCapsules) {
  const auto set = [](std::vector<kaboum::geom::ConvexBody> bodies) {
    ConvexSet out;
    out.bodies = std::move(bodies);
    return Solid(out);
  };
  const auto expect = [](double lower, double upper, double truth, double width) {
    EXPECT_LE(lower, truth + 1e-14);
    EXPECT_GE(upper, truth - 1e-14);
    EXPECT_LE(upper - lower, width);
  };
  const Solid cube(divided_block({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Solid ball = set({{"ball", {{{0, 0, 0}}, {}}, 1}});
  const SolidDistance out = distance(ball, cube), back = distance(cube, ball);
  expect(out.max_lower, out.max_upper, 0.5, 0.006);
  expect(back.max_lower, back.max_upper, 0, 0.002);
  const Solid far =
      set({{"capsule", {{{0, 0, 3}, {0, 1, 3}}, {}}, 0.25},
           {"box", kaboum::geom::convex_hull(divided_block({4, 4, 4}, {5, 5, 5}).vertices).value(),
            0.125}});
  const kaboum::distance::Minimum least = solid_minimum(ball, far);
  expect(least.lower, least.upper, 1.75, 0.006);
  const SolidDistance reach = distance(far, ball);  // the box's corner, enlarged
  expect(reach.max_lower, reach.max_upper, std::sqrt(75) + 0.125 - 1, 0.03);
  EXPECT_EQ(solid_minimum(ball, cube).upper, 0);
}

}  // namespace
