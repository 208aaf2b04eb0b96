// Boxes, directions and trees of bodies against an oracle that decides whether two polytopes meet
// by the hull of their differences: what is said to be apart is apart, and most that is apart is
// said so.

#include <gtest/gtest.h>
#include <kaboum/collide/body_tree.h>
#include <kaboum/collide/separation.h>

#include <set>

#include "pairs.h"

namespace kaboum::collide {
namespace {

using test::meet;

std::vector<geom::Vec3> corners(const geom::Vec3& half) {
  std::vector<geom::Vec3> out;
  for (const double x : {-half.x(), half.x()})
    for (const double y : {-half.y(), half.y()})
      for (const double z : {-half.z(), half.z()}) out.emplace_back(x, y, z);
  return out;
}

TEST(BoxesAreApart, SaysWhatTheHullOfDifferencesSays) {
  std::mt19937_64 random(1);
  int apart = 0, meeting = 0;
  for (int i = 0; i < 3000; ++i) {
    const geom::Vec3 a = test::random_point(random, 1).cwiseAbs() + geom::Vec3::Constant(0.01);
    const geom::Vec3 b = test::random_point(random, 1).cwiseAbs() + geom::Vec3::Constant(0.01);
    const geom::Transform pose = test::random_pose(random, 1.7);
    const bool met = meet(corners(a), corners(b), pose);
    EXPECT_EQ(boxes_are_apart(pose.linear, pose.translation, a, b), !met) << i;
    (met ? meeting : apart) += 1;
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(meeting, 500);
}

TEST(BoxesAreApart, TouchingBoxesAreNot) {
  const geom::Vec3 half(0.5, 0.25, 1);
  for (int axis = 0; axis < 3; ++axis) {
    const geom::Vec3 between = 2 * half[axis] * geom::Vec3::Unit(axis);
    EXPECT_FALSE(boxes_are_apart(Eigen::Matrix3d::Identity(), between, half, half));
    EXPECT_TRUE(boxes_are_apart(Eigen::Matrix3d::Identity(), between * 1.000001, half, half));
  }
}

TEST(FindSeparatingDirection, FindsOneForMostBodiesApartAndNoneForThoseThatMeet) {
  std::mt19937_64 random(2);
  int apart = 0, found = 0, meeting = 0;
  for (int i = 0; i < 2000; ++i) {
    const geom::Mesh a = test::random_body(random, 0.1), b = test::random_body(random, 0.1);
    const geom::Transform pose = test::random_pose(random, 0.7);
    const auto direction = find_separating_direction(SupportPoints(a), SupportPoints(b), pose);
    if (meet(a.vertices, b.vertices, pose)) {
      ++meeting;
      EXPECT_FALSE(direction) << i;
      continue;
    }
    ++apart;
    if (!direction) continue;
    ++found;
    double most = -1e9, least = 1e9;
    for (const geom::Vec3& p : a.vertices) most = std::max(most, p.dot(*direction));
    for (const geom::Vec3& q : b.vertices) least = std::min(least, (pose * q).dot(*direction));
    EXPECT_LT(most, least) << i;
  }
  EXPECT_GT(meeting, 300);
  EXPECT_GT(apart, 300);
  EXPECT_GT(found, 0.9 * apart);
}

TEST(BodyTree, AsksOfEveryPairThatMeetsAndOfFewOthers) {
  std::mt19937_64 random(3);
  std::size_t asked = 0, met = 0, all = 0;
  for (int i = 0; i < 12; ++i) {
    std::vector<geom::Mesh> a, b;
    for (std::size_t k = random() % 20 + 1; k-- > 0;) a.push_back(test::random_body(random, 1.2));
    for (std::size_t k = random() % 20 + 1; k-- > 0;) b.push_back(test::random_body(random, 1.2));
    const geom::Transform pose = test::random_pose(random, 1);
    std::set<std::pair<int, int>> pairs;
    EXPECT_FALSE(any_pair(BodyTree(a), BodyTree(b), pose, [&](int x, int y) {
      EXPECT_TRUE(pairs.emplace(x, y).second);
      return false;
    }));
    for (std::size_t x = 0; x < a.size(); ++x)
      for (std::size_t y = 0; y < b.size(); ++y)
        if (meet(a[x].vertices, b[y].vertices, pose)) {
          EXPECT_TRUE(pairs.contains({static_cast<int>(x), static_cast<int>(y)}));
          ++met;
        }
    asked += pairs.size();
    all += a.size() * b.size();
  }
  EXPECT_GT(met, 20U);
  EXPECT_LT(asked, all / 3);
}

TEST(BodyTree, EmptyOnesMeetNothing) {
  std::mt19937_64 random(4);
  const BodyTree none({}), one({test::random_body(random, 1)});
  EXPECT_FALSE(any_pair(none, one, {}, [](int, int) { return true; }));
  EXPECT_FALSE(any_pair(one, none, {}, [](int, int) { return true; }));
  EXPECT_TRUE(any_pair(one, one, {}, [](int, int) { return true; }));
}

}  // namespace
}  // namespace kaboum::collide
