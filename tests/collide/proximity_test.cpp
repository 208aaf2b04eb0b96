// Proximity of polytopes against an oracle in rational numbers, on pairs that nearly touch.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/collide/proximity.h>

#include "pairs.h"
#include "support/contacts.h"
#include "support/rational_contact.h"

namespace kaboum::collide {
namespace {

using geom::Vec3;
using test::Contact;

bool says(const Contact& c, double reach, Decided* decided = nullptr, Axis* axis = nullptr) {
  const Polytope a(c.a.vertices), b(c.b.vertices);
  return are_within(Posed(a, c.pose_a), Posed(b, c.pose_b), reach, axis, decided);
}

bool truth(const Contact& c, double reach) {
  return test::rational_within(c.a, c.pose_a, c.b, c.pose_b, reach);
}

TEST(AreWithin, SaysOfPairsThatNearlyTouchWhatRationalNumbersSay) {
  std::mt19937_64 random(11);
  Decided decided;
  int meeting = 0;
  constexpr int kPairs = 2000;
  for (int i = 0; i < kPairs; ++i) {
    const Contact c = test::random_contact(random);
    const bool expected = truth(c, 0);
    meeting += expected ? 1 : 0;
    EXPECT_EQ(says(c, 0, &decided), expected) << i;
  }
  EXPECT_GT(meeting, kPairs / 5);
  EXPECT_LT(meeting, kPairs * 4 / 5);
  EXPECT_GT(decided.exactly, 100U);
}

TEST(AreWithin, DecidesAReachExactly) {
  std::mt19937_64 random(12);
  int within = 0, exactly = 0;
  constexpr int kPairs = 150;
  for (int i = 0; i < kPairs; ++i) {
    Contact c = test::random_contact(random);
    const Polytope a(c.a.vertices), b(c.b.vertices);
    c.pose_b.translation += c.size * test::random_point(random, 3);
    const Gap gap = gap_between(Posed(a, c.pose_a), Posed(b, c.pose_b));
    if (gap.upper == 0) continue;
    // Numbers next to the distance.
    double reach = gap.upper;
    for (auto k = random() % 8; k-- > 0;) reach = std::nextafter(reach, 0.0);
    const bool expected = truth(c, reach);
    within += expected ? 1 : 0;
    Decided decided;
    EXPECT_EQ(says(c, reach, &decided), expected) << i;
    exactly += decided.exactly > 0 ? 1 : 0;
    EXPECT_TRUE(truth(c, gap.upper)) << i;
    EXPECT_FALSE(truth(c, gap.lower * (1 - 1e-15))) << i;
    EXPECT_LE(gap.upper - gap.lower, 1e-9 * (gap.upper + c.size)) << i;
    // What is apart from a shorter reach, and within a longer one, is so in rounded arithmetic.
    EXPECT_FALSE(says(c, gap.lower * 0.999)) << i;
    EXPECT_TRUE(says(c, gap.upper * 1.001)) << i;
  }
  EXPECT_GT(within, 15);
  EXPECT_GT(exactly, 15);
}

TEST(AreWithin, ADifferentPoseOrReachIsNoticed) {
  // A pair that touches at a facet; a mutant that moves it by 1e-12, or takes that from the reach,
  // is another one.
  const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const Polytope box(cube);
  const geom::Transform here;
  const auto within = [&](double x, double reach) {
    const geom::Transform there{Eigen::Matrix3d::Identity(), {x, 0.25, 0.125}};
    return are_within(Posed(box, here), Posed(box, there), reach);
  };
  EXPECT_TRUE(within(1, 0));
  EXPECT_FALSE(within(std::nextafter(1.0, 2.0), 0));
  EXPECT_TRUE(within(1.5, 0.5));
  EXPECT_FALSE(within(1.5, std::nextafter(0.5, 0.0)));
  EXPECT_FALSE(within(1.5 + 0x1p-52, 0.5));
}

TEST(AreWithin, MemoryChangesNoAnswer) {
  std::mt19937_64 random(13);
  Axis axis = Axis::Zero();
  for (int i = 0; i < 500; ++i) {
    const Contact c = test::random_contact(random);
    if (i % 7 == 0) axis = test::random_point(random, 1e-3);
    EXPECT_EQ(says(c, 0, nullptr, &axis), says(c, 0)) << i;
  }
  axis = Axis::Constant(std::numeric_limits<double>::quiet_NaN());
  const Contact c = test::random_contact(random);
  EXPECT_EQ(says(c, 0, nullptr, &axis), says(c, 0));
}

TEST(AreWithin, PointsSegmentsAndFlatBodies) {
  const Polytope point(std::vector<Vec3>{{0, 0, 0}}),
      segment(std::vector<Vec3>{{-1, 0, 0}, {1, 0, 0}}),
      triangle(std::vector<Vec3>{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
  const geom::Transform here, above{Eigen::Matrix3d::Identity(), {0, 0, 0.5}};
  for (const Polytope* a : {&point, &segment, &triangle}) {
    for (const Polytope* b : {&point, &segment, &triangle}) {
      EXPECT_TRUE(are_within(Posed(*a, here), Posed(*b, here), 0));
      EXPECT_FALSE(are_within(Posed(*a, here), Posed(*b, above), 0.499999));
      EXPECT_TRUE(are_within(Posed(*a, here), Posed(*b, above), 0.5));
      EXPECT_NEAR(gap_between(Posed(*a, here), Posed(*b, above)).lower, 0.5, 1e-12);
    }
  }
}

TEST(AreWithin, RefusesWhatIsNoNumber) {
  const std::vector<Vec3> one{{0, 0, 0}};
  const Polytope point(one);
  geom::Transform pose;
  EXPECT_THROW(are_within(Posed(point, pose), Posed(point, pose), -1), Error);
  EXPECT_THROW(are_within(Posed(point, pose), Posed(point, pose), std::nan("")), Error);
  EXPECT_THROW(Polytope(std::vector<Vec3>{{std::nan(""), 0, 0}}), Error);
  EXPECT_THROW(Polytope(std::vector<Vec3>{}), Error);
  pose.translation.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Posed(point, pose), Error);
}

}  // namespace
}  // namespace kaboum::collide
