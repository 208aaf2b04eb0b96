// Closed forms of segments and boxes against distances that are searched for face by face and edge
// by edge, in long double: nothing is shared but the bodies.

#include "closed_forms.h"

#include <gtest/gtest.h>
#include <kaboum/collide/bounding_set.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include "facings.h"
#include "pairs.h"

namespace kaboum::collide {
namespace {

using geom::Vec3;
using Long = long double;
using Point = Eigen::Matrix<Long, 3, 1>;

/// Corners, edges and facets of a core at its place.
struct Hull {
  std::vector<Point> corners;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::array<std::uint32_t, 3>> facets;
};

Hull hull_of(const geom::ConvexBody& body, const geom::Transform& pose) {
  Hull out;
  for (const Vec3& p : body.core.vertices)
    out.corners.emplace_back(pose.linear.cast<Long>() * p.cast<Long>() +
                             pose.translation.cast<Long>());
  for (const auto& [i, j, k] : body.core.triangles) {
    out.facets.push_back({i, j, k});
    if (i < j) out.edges.push_back({i, j});
    if (j < k) out.edges.push_back({j, k});
    if (k < i) out.edges.push_back({k, i});
  }
  if (out.corners.size() == 2) out.edges.push_back({0, 1});
  return out;
}

/// What is nearest so far: from a point of the one to a point of the other.
struct Nearest {
  Long square = std::numeric_limits<Long>::infinity();
  Point way = Point::Zero();
  void take(const Point& from, const Point& to) {
    const Long now = (to - from).squaredNorm();
    if (!(now < square)) return;
    square = now;
    way = to - from;
  }
};

Point on_segment(const Point& a, const Point& b, const Point& p) {
  const Point d = b - a;
  const Long length = d.squaredNorm(), along = (p - a).dot(d);
  return along <= 0 || length == 0 ? a : (along >= length ? b : Point(a + along / length * d));
}

/// Interiors of two edges: only where both nearest points of the lines are on them.
void take_edges(const Point& a, const Point& b, const Point& c, const Point& d, Nearest& best) {
  const Point u = b - a, v = d - c, n = u.cross(v);
  const Long all = n.squaredNorm();
  if (all == 0) return;
  const Long s = (c - a).cross(v).dot(n) / all, t = (c - a).cross(u).dot(n) / all;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best.take(a + s * u, c + t * v);
}

bool holds(const Hull& hull, const Point& p) {
  if (hull.facets.empty()) return false;
  return std::ranges::all_of(hull.facets, [&](const auto& f) {
    const Point& a = hull.corners[f[0]];
    return (hull.corners[f[1]] - a).cross(hull.corners[f[2]] - a).dot(p - a) <= 0;
  });
}

/// Of the inside of facets: a corner above one, or an edge through one.
void take_facets(const Hull& hull, const Hull& other, bool turned, Nearest& best) {
  for (const auto& [i, j, k] : hull.facets) {
    const Point &a = hull.corners[i], &b = hull.corners[j], &c = hull.corners[k];
    const Point n = (b - a).cross(c - a);
    const auto inside = [&](const Point& q) {
      return (b - a).cross(q - a).dot(n) >= 0 && (c - b).cross(q - b).dot(n) >= 0 &&
             (a - c).cross(q - c).dot(n) >= 0;
    };
    for (const Point& p : other.corners) {
      const Point foot = p - (p - a).dot(n) / n.squaredNorm() * n;
      if (!inside(foot)) continue;
      if (turned)
        best.take(p, foot);
      else
        best.take(foot, p);
    }
    for (const auto& [x, y] : other.edges) {
      const Long from = (other.corners[x] - a).dot(n), to = (other.corners[y] - a).dot(n);
      if (!(from * to <= 0) || from == to) continue;
      const Point q = other.corners[x] + from / (from - to) * (other.corners[y] - other.corners[x]);
      if (inside(q)) best.take(q, q);
    }
  }
}

/// From a to b; square 0 where they meet.
Nearest nearest(const Hull& a, const Hull& b) {
  Nearest best;
  if (holds(a, b.corners[0]) || holds(b, a.corners[0])) {
    best.take(a.corners[0], a.corners[0]);
    return best;
  }
  for (const Point& p : a.corners)
    for (const Point& q : b.corners) best.take(p, q);
  for (const auto& [i, j] : a.edges) {
    for (const Point& q : b.corners) best.take(on_segment(a.corners[i], a.corners[j], q), q);
    for (const auto& [k, l] : b.edges)
      take_edges(a.corners[i], a.corners[j], b.corners[k], b.corners[l], best);
  }
  for (const auto& [k, l] : b.edges)
    for (const Point& p : a.corners) best.take(p, on_segment(b.corners[k], b.corners[l], p));
  take_facets(a, b, false, best);
  take_facets(b, a, true, best);
  return best;
}

enum class Kind { Ball, Capsule, Box, Other };

double number(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Of about the size 1, or as thin as 1e-3; a box in any direction, its corners rounded to floats.
geom::ConvexBody random_body(Kind kind, std::mt19937_64& random) {
  geom::ConvexBody out;
  const Vec3 center = test::random_point(random, 0.5);
  const auto size = [&] {
    return random() % 4 == 0 ? number(random, 1e-3, 0.1) : number(random, 0.1, 1);
  };
  if (kind == Kind::Ball) {
    out.core.vertices = {center};
    out.radius = size();
  } else if (kind == Kind::Capsule) {
    Vec3 way = test::random_point(random, 1);
    if (random() % 3 == 0) way = size() * Vec3::Unit(static_cast<int>(random() % 3));
    out.core.vertices = {center, center + way};
    out.radius = size();
  } else if (kind == Kind::Box) {
    const Eigen::Matrix3d turn = random() % 3 == 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                                   : test::random_rotation(random);
    const Vec3 half(size(), size(), size());
    // Of some, corners are off by more than floats round.
    const double off = random() % 4 == 0 ? 2e-3 * half.minCoeff() : 0;
    std::vector<Vec3> corners;
    corners.reserve(8);
    for (int i = 0; i < 8; ++i)
      corners.push_back(
          (center + test::random_point(random, off) +
           turn * Vec3((i & 1) != 0 ? half.x() : -half.x(), (i & 2) != 0 ? half.y() : -half.y(),
                       (i & 4) != 0 ? half.z() : -half.z()))
              .cast<float>()
              .cast<double>());
    out.core = *geom::convex_hull(corners);
    out.radius = random() % 3 == 0 ? 0.1 * size() : 0;
  } else {
    out.core = test::random_body(random, 0.5);
    out.radius = random() % 2 == 0 ? 0.1 * size() : 0;
  }
  return out;
}

/// How often each answer was given.
struct Seen {
  std::size_t apart = 0, meet = 0, open = 0;
};

/// Looks at a pair, by the closed forms from both sides and by what sets answer.
void check(const BoundingSet& a, const BoundingSet& b, const geom::Transform& at_a,
           const geom::Transform& at_b, double slack, Seen& seen) {
  const Hull x = hull_of(a.body(0), at_a), y = hull_of(b.body(0), at_b);
  const Long between = std::sqrt(nearest(x, y).square) - static_cast<Long>(a.body(0).radius) -
                       static_cast<Long>(b.body(0).radius) - static_cast<Long>(slack);
  const PosedSet p(a, at_a), q(b, at_b);
  // Radii are those that matrices may stretch to, and sums are rounded up.
  const Long doubt = 1e-13L;
  const bool sure = std::abs(between) > doubt;
  for (const bool turned : {false, true}) {
    const PosedSet &faces = turned ? p : q, &lanes = turned ? q : p;
    const detail::Facings facings(faces, lanes, slack);
    bool met = false, asked = false;
    static_cast<void>(facings.any_block([&](std::size_t, std::uint64_t) {
      met = facings.first_to_meet(
                0, 1, [&](std::size_t, std::size_t) { return asked = true, false; }, nullptr) == 0;
      return true;
    }));
    ++(met ? seen.meet : asked ? seen.open : seen.apart);
    if (!sure) continue;
    ASSERT_FALSE(met && between > 0) << static_cast<double>(between);
    ASSERT_FALSE(!met && !asked && between <= 0) << static_cast<double>(between);
  }
  if (!sure) return;
  ASSERT_EQ(find_collision(p, q, slack).has_value(), between <= 0) << static_cast<double>(between);
  ASSERT_EQ(find_collision(q, p, slack).has_value(), between <= 0) << static_cast<double>(between);
}

/// Pairs of all kinds at random places, and moved so that they nearly touch: by 1e-3 to 1e-9, to
/// both sides.
TEST(ClosedForms, SayWhatDistancesSay) {
  std::mt19937_64 random(1);
  for (const Kind first : {Kind::Ball, Kind::Capsule, Kind::Box, Kind::Other})
    for (const Kind second : {Kind::Ball, Kind::Capsule, Kind::Box, Kind::Other}) {
      Seen far, near;
      for (int trial = 0; trial < 3000; ++trial) {
        const BoundingSet a({random_body(first, random)}, Direction::Outer, 0),
            b({random_body(second, random)}, Direction::Outer, 0);
        const geom::Transform at_a = test::random_pose(random, 1);
        geom::Transform at_b = test::random_pose(random, 2);
        const double slack = random() % 2 == 0 ? 0 : number(random, 0, 0.3);
        check(a, b, at_a, at_b, slack, far);
        const Nearest found = nearest(hull_of(a.body(0), at_a), hull_of(b.body(0), at_b));
        if (found.square == 0) continue;
        const double reach = a.body(0).radius + b.body(0).radius + slack,
                     off = std::pow(10, number(random, -9, -3)) * (trial % 2 == 0 ? 1 : -1),
                     distance = static_cast<double>(std::sqrt(found.square));
        at_b.translation -= (1 - (reach + off) / distance) * found.way.cast<double>();
        check(a, b, at_a, at_b, slack, near);
      }
      const bool exact = first != Kind::Other && second != Kind::Other;
      EXPECT_GT(far.apart, 100U);
      EXPECT_GT(near.apart, exact ? 100U : 0U);
      // What closed forms are for.
      if (exact) {
        EXPECT_GT(far.meet, 100U);
        EXPECT_LT(far.open, first == Kind::Box && second == Kind::Box ? 2000U : 60U);
        EXPECT_GT(near.meet, 50U);
      } else {
        EXPECT_EQ(far.meet, 0U);
      }
    }
}

/// Instruction sets compute the same bits.
TEST(ClosedForms, AreTheSameHoweverManyLanesThereAre) {
  if (!has_avx2()) GTEST_SKIP();
  std::mt19937_64 random(2);
  const auto same = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  for (int trial = 0; trial < 4000; ++trial) {
    const geom::Transform first = test::random_pose(random, 2),
                          second = test::random_pose(random, 2);
    std::array<detail::RotationDefect, 2> defect{};
    std::array<detail::Relation, 2> relation{};
    std::array<detail::MovedBox, 2> moved{};
    std::array<detail::FloatRelation, 2> seen{};
    const Vec3 center = test::random_point(random, 1),
               half = test::random_point(random, 1).cwiseAbs();
    for (const bool wide : {false, true}) {
      const std::size_t i = wide ? 1 : 0;
      detail::rotation_defect(first, 1e-9, defect[i], wide);
      detail::relate(first, second, relation[i], wide);
      detail::move_box(relation[i], center, half, 0.1, 1e-9, moved[i], wide);
      detail::see_from(relation[i], second.linear, center, moved[i].center,
                       {half.data(), half.data()}, seen[i], wide);
    }
    ASSERT_EQ(defect[0].square, defect[1].square);
    ASSERT_TRUE(defect[0].is_rotation && defect[1].is_rotation);
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(relation[0].way[k], relation[1].way[k]);
      ASSERT_EQ(moved[0].box.low[k], moved[1].box.low[k]);
      ASSERT_EQ(moved[0].box.high[k], moved[1].box.high[k]);
      ASSERT_EQ(seen[0].way[k], seen[1].way[k]);
      for (int j = 0; j < 3; ++j) {
        ASSERT_EQ(relation[0].turn[j][k], relation[1].turn[j][k]);
        ASSERT_EQ(seen[0].turn[j][k], seen[1].turn[j][k]);
      }
    }
    ASSERT_EQ(seen[0].apart, seen[1].apart);
    // One lane that counts: of several, those behind the first that meets may stay open.
    const detail::Shapes lanes({random_body(static_cast<Kind>(random() % 4), random)},
                               {Vec3::Constant(-2), Vec3::Constant(2)});
    detail::Facing facing;
    facing.is_round = random() % 2 == 0;
    facing.relation = seen[0];
    for (int k = 0; k < 3; ++k) {
      facing.half[k] = static_cast<float>(half[k]);
      facing.first[k] = static_cast<float>(center[k]);
      facing.second[k] = static_cast<float>(half[k]);
    }
    facing.size = 4;
    const detail::Verdicts narrow = look(lanes.lanes[0], facing, false),
                           wide = look(lanes.lanes[0], facing, true);
    ASSERT_TRUE(same(narrow, wide)) << trial;
  }
}

/// Reflections, matrices that stretch, and numbers that are none.
TEST(ClosedForms, WhatIsNoRotationIsSeen) {
  const auto is_rotation = [](const Eigen::Matrix3d& matrix) {
    detail::RotationDefect narrow, wide;
    detail::rotation_defect({matrix, Vec3::Zero()}, 1e-9, narrow, false);
    detail::rotation_defect({matrix, Vec3::Zero()}, 1e-9, wide);
    EXPECT_EQ(narrow.is_rotation, wide.is_rotation);
    return wide.is_rotation;
  };
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Matrix3d turn = test::random_rotation(random);
    ASSERT_TRUE(is_rotation(turn));
    ASSERT_FALSE(is_rotation(-turn));
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d other = turn;
      other.data()[k] += 1e-6;
      ASSERT_FALSE(is_rotation(other));
      other.data()[k] = std::numeric_limits<double>::quiet_NaN();
      ASSERT_FALSE(is_rotation(other));
      other.data()[k] = std::numeric_limits<double>::infinity();
      ASSERT_FALSE(is_rotation(other));
    }
  }
}

/// Sets of several bodies of all kinds: the pair that is found is the first one of those that meet,
/// whichever set is larger.
TEST(ClosedForms, TheFirstPairIsFoundWhicheverSetIsLarger) {
  std::mt19937_64 random(4);
  const auto set_of = [&](std::size_t count) {
    std::vector<geom::ConvexBody> bodies;
    for (std::size_t i = 0; i < count; ++i)
      bodies.push_back(random_body(static_cast<Kind>(random() % 4), random));
    for (geom::ConvexBody& body : bodies) {
      const Vec3 way = test::random_point(random, 1.2);
      for (Vec3& p : body.core.vertices) p = 0.3 * p + way;
      body.radius *= 0.3;
      if (body.core.triangles.empty()) continue;
      body.core = *geom::convex_hull(body.core.vertices);
    }
    return BoundingSet(bodies, Direction::Outer, 0);
  };
  int found = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const BoundingSet a = set_of(1 + random() % 20), b = set_of(1 + random() % 20);
    const geom::Transform at_a = test::random_pose(random, 1), at_b = test::random_pose(random, 1);
    const PosedSet p(a, at_a), q(b, at_b);
    std::optional<BodyPair> first;
    for (std::size_t i = 0; i < a.size() && !first; ++i)
      for (std::size_t j = 0; j < b.size() && !first; ++j)
        if (are_within(p.body(i), q.body(j),
                       p.radius_above(i) == 0 ? q.radius_above(j)
                       : q.radius_above(j) == 0
                           ? p.radius_above(i)
                           : (p.radius_above(i) + q.radius_above(j)) * (1 + 0x1p-50)))
          first = BodyPair{i, j};
    const auto pair = find_collision(p, q);
    ASSERT_EQ(pair.has_value(), first.has_value());
    if (!first) continue;
    ++found;
    EXPECT_EQ(pair->a, first->a);
    EXPECT_EQ(pair->b, first->b);
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 400);
}

// Beyond floats, closed forms and boxes of bodies in floats know nothing.
TEST(ClosedForms, NumbersBeyondFloats) {
  const auto balls = [](double scale, double radius) {
    std::vector<geom::ConvexBody> out;
    for (int i = 0; i < 20; ++i)
      out.push_back({"ball", {{Vec3(5.0 * i * scale, scale, 0)}, {}}, radius});
    return out;
  };
  const geom::Transform here;
  for (const auto& [scale, radius] : std::vector<std::pair<double, double>>{{1, 1},
                                                                            {1e37, 1e37},
                                                                            {1e38, 1e38},
                                                                            {1e39, 1e39},
                                                                            {1e50, 1e50},
                                                                            {1e58, 1e58},
                                                                            {1, 1e39},
                                                                            {1, 1e100}}) {
    const BoundingSet set(balls(scale, radius), Direction::Outer, 0),
        one({balls(scale, radius).back()}, Direction::Outer, 0);
    const PosedSet a(set, here), b(set, here), c(one, here);
    EXPECT_TRUE(find_collision(a, b)) << scale << ' ' << radius;
    EXPECT_TRUE(find_collision(a, c)) << scale << ' ' << radius;
    EXPECT_TRUE(find_collision(c, a)) << scale << ' ' << radius;
    EXPECT_TRUE(certainly_collide(a, b)) << scale << ' ' << radius;
    EXPECT_TRUE(certainly_collide(a, c)) << scale << ' ' << radius;
    EXPECT_TRUE(certainly_collide(c, a)) << scale << ' ' << radius;
  }
}

}  // namespace
}  // namespace kaboum::collide
