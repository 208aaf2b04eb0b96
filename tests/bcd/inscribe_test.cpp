// One inscribed body, one estimate and one bounding mesh at a time, against slow answers.
#include "inscribe.h"

#include <gtest/gtest.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/verify/inclusion.h>

#include <random>

#include "concavity.h"
#include "depths.h"
#include "pre_step.h"
#include "solids.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;

TEST(Inscribe, BodiesHoldTheirSeedAndMeetNoTriangle) {
  std::mt19937 random(11);
  for (const Mesh& mesh : {kaboum::test::torus(1, 0.4, 24, 12),
                           test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1),
                           kaboum::test::icosphere(2)}) {
    const geom::DistanceQuery surface(mesh);
    const geom::Box3 box = geom::bounding_box(mesh);
    std::uniform_real_distribution<double> unit(0, 1);
    int grown = 0;
    for (int i = 0; i < 300 && grown < 12; ++i) {
      const Vec3 seed =
          box.min +
          (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
      const auto w = kaboum::test::winding_number_slow(mesh, seed);
      if (!w || *w < 1) continue;
      const double depth = surface.nearest(seed).lower;
      if (depth < 0.05) continue;
      ++grown;
      const std::size_t most = grown % 2 == 0 ? 64 : 12;
      const auto body = inscribe(mesh, seed, depth, most, 3);
      ASSERT_TRUE(body.has_value());
      EXPECT_LE(body->hull.vertices.size(), most);
      EXPECT_TRUE(geom::is_convex(body->hull));
      EXPECT_TRUE(body->contains(seed, 0.2 * depth));
      EXPECT_GE(body->volume, 0.1 * depth * depth * depth);
      EXPECT_EQ(verify::verify_inclusion(body->hull, mesh).solid.answer, verify::Answer::Verified);
    }
    EXPECT_EQ(grown, 12);
  }
}

TEST(Inscribe, NoneWhereFloat32IsTooCoarse) {
  const Mesh far = kaboum::test::translated(kaboum::test::box({1, 1, 1}, 1), {1e7, 0, 0});
  EXPECT_FALSE(inscribe(far, {1e7 + 0.5, 0.5, 0.5}, 0.5, 64, 1).has_value());
}

TEST(Depths, TheDeepestPointOfABoxIsItsMiddle) {
  const Mesh mesh = kaboum::test::box({2, 4, 6}, 1);
  const geom::WindingNumber winding(mesh);
  const Boundary boundary = boundary_of(mesh, winding, 0.1, {});
  Depths depths(mesh, winding, boundary);
  const Depths::Deepest found = depths.search({}, 0, 0.02, false, 100000);
  EXPECT_LE(found.lower, 1 + 1e-6);
  EXPECT_GE(found.upper, 1);
  EXPECT_GE(found.lower, 0.97);
  EXPECT_LE(found.upper, 1.03);
  EXPECT_NEAR(found.point.x(), 1, 0.05);
  EXPECT_GT(depths.looked(), 0U);
}

// An estimate, but never more than the distance of a point of the hull.
TEST(Concavity, IsTheDistanceOfAPointOfTheHull) {
  const Mesh l = test::prism({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 1);
  const SolidField solid(l, 20000, 0);
  geom::HullBuilder builder;
  for (const bool perturbed : {false, true}) {
    const Concavity c = estimate_concavity(l.vertices, solid, builder, perturbed);
    EXPECT_FALSE(c.flat);
    EXPECT_NEAR(c.volume, 7, 1e-6);
    EXPECT_NEAR(c.worst, 1, 0.1);  // at the middle of the facet across the notch
    EXPECT_NEAR(solid.surface().nearest(c.at).lower, c.worst, 0.05);
  }
  EXPECT_TRUE(spans_beyond(l.vertices, solid, 0.5));
  EXPECT_FALSE(spans_beyond(l.vertices, solid, 1.1));
}

// What cuts are scored by is part of the whole estimate, as far as it is asked for.
TEST(Concavity, ItsFourthPowerAloneIsTheSameUpToALimit) {
  const Mesh mesh = kaboum::test::torus(1, 0.35, 24, 12);
  const SolidField solid(mesh, 20000, 0);
  geom::HullBuilder builder;
  const Concavity all = estimate_concavity(mesh.vertices, solid, builder, true);
  ASSERT_GT(all.fourth, 0);
  for (const double share : {0.0, 0.3, 0.9, 1.0, 1.1}) {
    double volume = 0;
    const double limit = share * all.fourth;
    const Concavity part = estimate_fourth(mesh.vertices, solid, builder, [&](double v) {
      volume = v;
      return limit;
    });
    EXPECT_EQ(part.volume, all.volume);
    EXPECT_EQ(volume, all.volume);
    if (share < 1)
      EXPECT_GT(part.fourth, limit);
    else
      EXPECT_EQ(part.fourth, all.fourth);
  }
}

// A slot in a long bar, between the samples of an estimate: some place of it is found, and is where
// it is said to be.
TEST(Concavity, PlacesBetweenSamplesAreFarWhereLookedAtDensely) {
  geom::HullBuilder builder;
  std::size_t missed = 0;
  for (int i = 0; i < 8; ++i) {
    const double at = 3 + 0.13 * i, half = 0.2;
    const Mesh bar = test::prism({{0, 0},
                                  {10, 0},
                                  {10, 1},
                                  {at + half, 1},
                                  {at + half, 0.3},
                                  {at - half, 0.3},
                                  {at - half, 1},
                                  {0, 1}},
                                 1);
    const SolidField solid(bar, 20000, 0);
    const double limit = 0.8 * half;
    missed += estimate_concavity(bar.vertices, solid, builder).worst < limit ? 1 : 0;
    ASSERT_TRUE(builder.build(bar.vertices));
    EXPECT_FALSE(far_point(bar.vertices, solid, builder, 1.05 * half));
    const auto far = far_point(bar.vertices, solid, builder, limit);
    ASSERT_TRUE(far) << at;
    EXPECT_GT(far->distance, limit);
    EXPECT_NEAR(solid.surface().nearest(far->point).lower, far->distance, 1e-6);
    EXPECT_FALSE(solid.contains(far->point));
    EXPECT_TRUE((far->point.array() >= solid.box().min.array() - 1e-9).all());
    EXPECT_TRUE((far->point.array() <= solid.box().max.array() + 1e-9).all());
  }
  EXPECT_GT(missed, 0U);
}

TEST(Concavity, OfConvexSolidsIsNothing) {
  const Mesh cube = kaboum::test::box({1, 1, 1}, 1);
  const SolidField solid(cube, 20000, 0);
  geom::HullBuilder builder;
  const Concavity c = estimate_concavity(cube.vertices, solid, builder);
  EXPECT_LT(c.worst, 1e-6);
  EXPECT_NEAR(c.volume, 1, 1e-9);
  const std::vector<Vec3> face{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_TRUE(estimate_concavity(face, solid, builder).flat);
}

TEST(PreStep, EnclosesAndStaysWithinItsShare) {
  const geom::SolidMesh sphere = geom::prepare(kaboum::test::icosphere(4)).solid;
  CoverOptions options;
  options.pre_step = PreStep::On;
  options.epsilon = 0.1;
  const auto simpler = pre_step(sphere, options);
  ASSERT_TRUE(simpler.has_value());
  EXPECT_LE(simpler->mesh.vertices.size(), sphere.mesh().vertices.size() / 2);
  EXPECT_LE(simpler->distance, 0.01);
  EXPECT_EQ(verify::verify_inclusion(sphere.mesh(), simpler->mesh).solid.answer,
            verify::Answer::Verified);
  EXPECT_LE(geom::directed_distance(simpler->mesh, geom::DistanceQuery(sphere.mesh())).max_lower,
            simpler->distance);
  options.epsilon = 1e-7;  // nothing is that near
  EXPECT_FALSE(pre_step(sphere, options).has_value());
  options.epsilon = 0.1;
  for (const PreStep off : {PreStep::Off, PreStep::Auto}) {  // too small to be worth it
    options.pre_step = off;
    EXPECT_FALSE(pre_step(sphere, options).has_value());
  }
}

}  // namespace
}  // namespace kaboum::bcd
