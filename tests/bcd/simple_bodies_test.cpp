// Capsules and boxes: numbers of them that shapes are known to need, what they hold, how far they
// reach.
#include <gtest/gtest.h>
#include <kaboum/base/random.h>
#include <kaboum/bcd/simple_bodies.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/cover.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "fitting.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace simple_bodies_test {
namespace {

using geom::Mesh;

/// A prism of many sides along z.
Mesh rod(double radius, double length) {
  std::vector<Vec3> points;
  constexpr int kSides = 40;
  for (int i = 0; i < kSides; ++i)
    for (const double z : {0.0, length})
      points.emplace_back(radius * std::cos(2 * std::numbers::pi * i / kSides),
                          radius * std::sin(2 * std::numbers::pi * i / kSides), z);
  return *geom::convex_hull(points);
}

Mesh bar(const Vec3& size) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back((i & 1) != 0 ? size.x() : 0, (i & 2) != 0 ? size.y() : 0,
                        (i & 4) != 0 ? size.z() : 0);
  return *geom::convex_hull(points);
}

CoverCandidate cover(const Mesh& mesh, const SimpleKinds& kinds, double epsilon) {
  SimpleBodyOptions options;
  options.kinds = kinds;
  options.epsilon = epsilon;
  options.effort = Effort::Fast;
  const geom::Prepared solid = geom::prepare(mesh, {});
  CoverCandidate out = SimpleBodySearch(solid.solid, options).find();
  geom::ConvexSet set;
  set.bodies = out.bodies;
  const verify::Cover found = verify::verify_cover(mesh, set);
  EXPECT_EQ(found.convexity.convex.answer, verify::Answer::Verified)
      << found.convexity.convex.reason;
  EXPECT_EQ(found.inclusion.solid.answer, verify::Answer::Verified) << found.inclusion.solid.reason;
  EXPECT_EQ(found.inclusion.surface.answer, verify::Answer::Verified)
      << found.inclusion.surface.reason;
  EXPECT_EQ(verify::verify_excess(set, mesh, epsilon, true).answer, verify::Answer::Verified);
  EXPECT_LE(out.excess_lower, out.excess_upper);
  EXPECT_LE(out.excess_upper, epsilon);
  for (const geom::ConvexBody& body : out.bodies)
    for (const Vec3& v : body.core.vertices) EXPECT_TRUE(geom::is_float32(v));
  return out;
}

TEST(SimpleBodies, ARodIsOneCapsule) {
  // The rim of its end is √2 r = 1.41 r from the end of its axis; the capsule's tip goes 0.45 out.
  EXPECT_EQ(cover(rod(1, 10), {.capsules = true}, 0.47).bodies.size(), 1U);
}

TEST(SimpleBodies, ABarIsOneBox) {
  EXPECT_EQ(cover(bar({4, 1, 2}), {.boxes = true}, 0.1).bodies.size(), 1U);
}

TEST(SimpleBodies, AnLIsTwoBoxes) {
  const Mesh l = kaboum::test::merged({bar({4, 1, 1}), bar({1, 4, 1})});
  EXPECT_EQ(cover(l, {.boxes = true}, 0.1).bodies.size(), 2U);
}

TEST(SimpleBodies, MixedTakesCheapKinds) {
  const CoverCandidate found =
      cover(rod(1, 10), {.balls = true, .capsules = true, .boxes = true}, 0.47);
  ASSERT_EQ(found.bodies.size(), 1U);
  EXPECT_EQ(found.bodies[0].core.vertices.size(), 2U);
}

// A point that no body holds, within epsilon beside the solid: one body more at most, and the rest
// is still held.
TEST(SimpleBodies, PointsThatWereLeftOutAreHeld) {
  const Mesh l = kaboum::test::merged({bar({4, 1, 1}), bar({1, 4, 1})});
  const geom::Prepared solid = geom::prepare(l, {});
  SimpleBodyOptions options;
  options.kinds.boxes = true;
  options.epsilon = 0.3;
  options.effort = Effort::Fast;
  SimpleBodySearch search(solid.solid, options);
  const CoverCandidate before = search.find();
  const auto holds = [](const CoverCandidate& found, const Vec3& p) {
    // The hull of a box and a point of it has no other corner.
    return std::ranges::any_of(found.bodies, [&](const geom::ConvexBody& body) {
      std::vector<Vec3> with = body.core.vertices;
      with.push_back(p);
      return geom::convex_hull(with)->vertices.size() == body.core.vertices.size();
    });
  };
  std::vector<Vec3> beside;
  for (double t = 0.05; t < 4; t += 0.05)
    for (const Vec3& p : {Vec3(t, 0.5, 1.27), Vec3(0.5, t, -0.27), Vec3(4.27, 0.5, 0.5)})
      if (!holds(before, p)) beside.push_back(p);
  ASSERT_FALSE(beside.empty());
  const Vec3 missing = beside[beside.size() / 2];
  const CoverCandidate after = search.hold(std::vector{missing});
  EXPECT_TRUE(holds(after, missing));
  EXPECT_LE(after.bodies.size(), before.bodies.size() + 1);
  geom::ConvexSet set;
  set.bodies = after.bodies;
  const verify::Cover found = verify::verify_cover(l, set);
  EXPECT_EQ(found.inclusion.solid.answer, verify::Answer::Verified);
  EXPECT_EQ(found.inclusion.surface.answer, verify::Answer::Verified);
  EXPECT_EQ(verify::verify_excess(set, l, 0.3, true).answer, verify::Answer::Verified);
}

TEST(SimpleBodies, ByNumber) {
  SimpleBodyOptions options;
  options.kinds.boxes = true;
  options.max_bodies = 1;
  options.effort = Effort::Fast;
  const CoverCandidate one =
      SimpleBodySearch(geom::prepare(bar({4, 1, 2}), {}).solid, options).find();
  EXPECT_EQ(one.bodies.size(), 1U);
  EXPECT_LT(one.excess_upper, 0.3);
}

// The room of a face against boxes that are tried: none within it leaves the body, and a little
// more does.
TEST(SimpleBodies, RoomIsWhatIsLeft) {
  const Mesh mesh = bar({4, 1, 2});
  const geom::DistanceQuery query(mesh);
  const geom::WindingNumber winding(mesh);
  constexpr double kDistance = 0.3;
  const ParallelBody body(query, winding, kDistance, 0.1);
  const auto far = [&](const AxesBox& box) {
    double out = 0;
    for (const Vec3& p : box.corners()) out = std::max(out, body.signed_distance(p).upper);
    return out;
  };
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& axes : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turned})
    for (int face = 0; face < 6; ++face) {
      AxesBox box{{2, 0.5, 1}, axes, Vec3::Constant(-0.2), Vec3::Constant(0.2)};
      const double way = room(body, box, face / 2, face % 2 != 0, 100);
      EXPECT_GT(way, 0.1);
      (face % 2 != 0 ? box.high : box.low)[face / 2] += face % 2 != 0 ? way : -way;
      EXPECT_LE(far(box), kDistance);
      EXPECT_GT(far(box), 0.9 * kDistance);
    }
  // From the middle of a side, a capsule is as thick as the bar and the distance.
  EXPECT_NEAR(clearance(body, {1, 0.5, 1}, {3, 0.5, 1}), 0.5 + kDistance, 0.01);
  EXPECT_LE(clearance(body, {1, 0.5, 1}, {3, 0.5, 1}), 0.5 + kDistance);
  EXPECT_EQ(clearance(body, {1, 0.5, 1}, {9, 0.5, 1}), 0);
}

// Moves every face in every turn, also those that met a cap before.
void grow_by_all(const RegionalBody& body, AxesBox& box, std::span<const int> order) {
  for (int turn = 0; turn < 40; ++turn) {
    bool moved = false;
    for (const int face : order) {
      const double most = std::max(0.25 * (box.high - box.low).maxCoeff(), body.distance());
      const double way = room(body, box, face / 2, face % 2 != 0, most);
      if (!(way > 0.02 * body.distance())) continue;
      (face % 2 != 0 ? box.high : box.low)[face / 2] += face % 2 != 0 ? way : -way;
      moved = true;
    }
    if (!moved) return;
  }
}

TEST(SimpleBodies, AFaceThatMetACapNeedNotBeAskedAgain) {
  const Mesh mesh = kaboum::test::torus(1.5, 0.5, 24, 12);
  const geom::DistanceQuery query(mesh);
  const geom::WindingNumber winding(mesh);
  constexpr double kDistance = 0.2;
  const RegionalBody body(query, winding, kDistance, 0.1, {}, kDistance);
  const geom::Box3 around = geom::bounding_box(mesh);
  Random random(5);
  const auto any = [&](double low, double high) {
    return Vec3(random.between(low, high), random.between(low, high), random.between(low, high));
  };
  int grown = 0;
  for (int turn = 0; turn < 200; ++turn) {
    const Vec3 at = around.min + any(0, 1).cwiseProduct(around.max - around.min);
    const Vec3 axis = any(-1, 1).normalized();
    const double half = 0.3 * body.radius_about(at);
    if (!(half > 0)) continue;
    AxesBox one{at, Eigen::AngleAxisd(turn % 3 * 0.4, axis).toRotationMatrix(),
                Vec3::Constant(-half), Vec3::Constant(half)};
    AxesBox other = one;
    std::array<int, 6> order{0, 1, 2, 3, 4, 5};
    std::swap(order[static_cast<std::size_t>(turn % 6)], order[0]);
    grow(body, one, order, 0.25);
    grow_by_all(body, other, order);
    EXPECT_EQ(one.low, other.low) << turn;
    EXPECT_EQ(one.high, other.high) << turn;
    grown += one.high.maxCoeff() > 2 * half ? 1 : 0;
  }
  EXPECT_GT(grown, 50);
}

}  // namespace
}  // namespace simple_bodies_test
}  // namespace kaboum::bcd
