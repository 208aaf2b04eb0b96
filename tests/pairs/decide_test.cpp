// Pairs decided against exact meshes by other code, in configurations at random.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/judge/placement.h>
#include <kaboum/judge/solid.h>
#include <kaboum/pairs/decide.h>

#include <algorithm>
#include <map>
#include <memory>

#include "contact.h"
#include "robots.h"

namespace kaboum::pairs {
namespace {

using geom::Vec3;
using test::box_mesh;
using test::TestRobot;

class Oracle {
 public:
  explicit Oracle(const TestRobot& of) : robot_(of.robot) {
    for (const LinkSurface& s : of.surfaces)
      solids_[s.link] = std::make_unique<judge::Solid>(s.outer);
  }
  [[nodiscard]] std::vector<geom::Transform> places(const std::vector<double>& q) const {
    return judge::places(robot_, {}, q);
  }
  [[nodiscard]] bool meet(const std::vector<geom::Transform>& at, const DecidedPair& pair) const {
    return solids_.at(pair.a)->meets(at[pair.a], *solids_.at(pair.b), at[pair.b]);
  }
  /// The second link moved by a vector.
  [[nodiscard]] bool meet_moved(std::vector<geom::Transform> at, const DecidedPair& pair,
                                const Vec3& by) const {
    at[pair.b].translation += by;
    return meet(at, pair);
  }

 private:
  const robot::Robot& robot_;
  std::map<std::uint32_t, std::unique_ptr<judge::Solid>> solids_;
};

TEST(DecidedPairs, AgreeWithMeshesInConfigurationsAtRandom) {
  std::size_t never = 0, always = 0, touch = 0, open = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const TestRobot of = test::random_robot(seed);
    const std::vector<DecidedPair> pairs =
        decide_pairs(of.robot, of.surfaces, {.most_boxes = 3'000, .samples = 60});
    ASSERT_EQ(pairs.size(), 15U);
    const Oracle oracle(of);
    Random random(seed);
    for (const DecidedPair& pair : pairs) {
      never += pair.verdict == Verdict::Never ? 1 : 0;
      always += pair.verdict == Verdict::Always ? 1 : 0;
      touch += pair.verdict == Verdict::CanTouch ? 1 : 0;
      open += pair.verdict == Verdict::Open ? 1 : 0;
      EXPECT_LE(pair.nearest.lower, pair.nearest.upper);
      if (pair.verdict != Verdict::CanTouch && pair.verdict != Verdict::Always) continue;
      const auto at = oracle.places(pair.q);
      EXPECT_TRUE(oracle.meet(at, pair)) << seed << ": " << pair.a << " " << pair.b;
      if (pair.depth.lower > 0) {
        EXPECT_LE(pair.depth.lower, pair.depth.upper);
        // No translation by less than the lower bound parts them.
        for (int i = 0; i < 20; ++i) {
          const Vec3 by = 0.999 * pair.depth.lower *
                          (test::random_vector(random, 1) + Vec3(0, 1e-3, 0)).normalized();
          EXPECT_TRUE(oracle.meet_moved(at, pair, by)) << seed << ": " << pair.a << " " << pair.b;
        }
      }
    }
    for (int i = 0; i < 400; ++i) {
      const std::vector<double> q = test::random_configuration(of.robot, random);
      const auto at = oracle.places(q);
      for (const DecidedPair& pair : pairs) {
        if (pair.verdict == Verdict::Never) {
          ASSERT_FALSE(oracle.meet(at, pair)) << seed << ": " << pair.a << " " << pair.b;
        } else if (pair.verdict == Verdict::Always) {
          ASSERT_TRUE(oracle.meet(at, pair)) << seed << ": " << pair.a << " " << pair.b;
        }
      }
    }
  }
  // The test is about something, and little is left.
  EXPECT_GT(never, 100U);
  EXPECT_GT(always, 3U);
  EXPECT_GT(touch, 50U);
  EXPECT_LT(open, 30U);
}

TEST(DecidedPairs, InOneConfigurationAgreeWithMeshesThere) {
  std::size_t apart = 0, touch = 0, open = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TestRobot of = test::random_robot(seed);
    const Oracle oracle(of);
    Random random(seed);
    for (int i = 0; i < 20; ++i) {
      const std::vector<double> q = test::random_configuration(of.robot, random);
      const auto at = oracle.places(q);
      for (const DecidedPair& pair : decide_pairs_at(of.robot, q, of.surfaces, {.samples = 3})) {
        EXPECT_EQ(pair.q, q);
        if (pair.verdict == Verdict::Open) {
          ++open;
          continue;
        }
        const bool is_apart = pair.verdict == Verdict::Never;
        ++(is_apart ? apart : touch);
        EXPECT_EQ(oracle.meet(at, pair), !is_apart) << seed << ": " << pair.a << " " << pair.b;
      }
    }
  }
  EXPECT_GT(apart, 3'000U);
  EXPECT_GT(touch, 300U);
  EXPECT_LT(open, 30U);
  const TestRobot of = test::random_robot(1);
  EXPECT_THROW(decide_pairs_at(of.robot, {0}, of.surfaces, {}), kaboum::Error);
}

/// A box at the end of a turning arm, over a fixed box: how near it comes is known.
TestRobot arm_over_table(double gap) {
  TestRobot out;
  out.robot.name = "arm";
  out.robot.links = {{"table", {}, {}}, {"post", {}, {}}, {"arm", {}, {}}};
  robot::Joint shoulder, elbow;
  shoulder.name = "shoulder";
  shoulder.type = elbow.type = robot::JointType::Revolute;
  shoulder.axis = Vec3::UnitZ();
  elbow.name = "elbow";
  elbow.parent = 1;
  elbow.axis = Vec3::UnitY();
  elbow.variable = 1;
  elbow.origin.translation = Vec3(0, 0, 1);
  out.robot.joints = {shoulder, elbow};
  out.robot.variables = {{"shoulder", -3.0, 3.0}, {"elbow", -2.0, 2.0}};
  // The corner of the arm's box that comes lowest is at (0.5, ±0.1, −0.1) turned down.
  const double reach = std::hypot(0.5, 0.1);
  const double top = 1 - reach - gap;
  out.surfaces = {{0, box_mesh({-1, -1, top - 0.2}, {1, 1, top}), {}},
                  {1, box_mesh({-0.02, -0.02, 0.9}, {0.02, 0.02, 0.95}), {}},
                  {2, box_mesh({0.1, -0.1, -0.1}, {0.5, 0.1, 0.1}), {}}};
  return out;
}

const DecidedPair& pair_of(const std::vector<DecidedPair>& pairs, std::uint32_t a,
                           std::uint32_t b) {
  return *std::ranges::find_if(pairs, [&](const DecidedPair& p) { return p.a == a && p.b == b; });
}

TEST(DecidedPairs, ATenthOfAMillimetreApartIsNeverAndIntoEachOtherIsShown) {
  for (const double gap : {1e-2, 1e-3, 1e-4}) {
    const TestRobot apart = arm_over_table(gap), deep = arm_over_table(-gap);
    const auto never = decide_pairs(apart.robot, apart.surfaces, {});
    EXPECT_EQ(pair_of(never, 0, 2).verdict, Verdict::Never) << gap;
    EXPECT_LE(pair_of(never, 0, 2).nearest.lower, gap);
    EXPECT_GE(pair_of(never, 0, 2).nearest.upper, gap * (1 - 1e-9));
    const auto touch = decide_pairs(deep.robot, deep.surfaces, {});
    EXPECT_EQ(pair_of(touch, 0, 2).verdict, Verdict::CanTouch) << gap;
    EXPECT_GT(pair_of(touch, 0, 2).depth.lower, 0);
    EXPECT_LE(pair_of(touch, 0, 2).depth.lower, gap);
    EXPECT_GE(pair_of(touch, 0, 2).depth.upper, pair_of(touch, 0, 2).depth.lower);
  }
}

TEST(DecidedPairs, WhatIsInsideAlwaysTouchesAndWhatIsInACavityIsNotSaidTo) {
  TestRobot of;
  of.robot.name = "nut";
  of.robot.links = {{"outer", {}, {}}, {"middle", {}, {}}, {"inner", {}, {}}};
  for (std::uint32_t i = 0; i < 2; ++i) {
    robot::Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.type = robot::JointType::Revolute;
    joint.parent = i;
    joint.variable = i;
    of.robot.joints.push_back(joint);
    of.robot.variables.push_back({joint.name, -1.0, 1.0});
  }
  const geom::Mesh small = box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
  of.surfaces = {{0, box_mesh({-1, -1, -1}, {1, 1, 1}), {}}, {2, small, {}}};
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Always);
  test::append(of.surfaces[0].outer, box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, true));
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Open);
}

/// Every triangle cut into four.
geom::Mesh finer(const geom::Mesh& mesh) {
  geom::Mesh out;
  for (const geom::Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (int i = 0; i < 3; ++i) out.vertices.push_back(mesh.vertices[t[i]]);
    for (int i = 0; i < 3; ++i)
      out.vertices.push_back(0.5 * (mesh.vertices[t[i]] + mesh.vertices[t[(i + 1) % 3]]));
    for (const geom::Triangle& part : {geom::Triangle{0, 3, 5}, geom::Triangle{3, 1, 4},
                                       geom::Triangle{5, 4, 2}, geom::Triangle{3, 4, 5}})
      out.triangles.push_back({first + part[0], first + part[1], first + part[2]});
  }
  return out;
}

/// Two links and the joint between them.
TestRobot two_links(robot::JointType type, double lower, double upper) {
  TestRobot out;
  out.robot.name = "two";
  out.robot.links = {{"a", {}, {}}, {"b", {}, {}}};
  robot::Joint joint;
  joint.name = "j";
  joint.type = type;
  joint.axis = type == robot::JointType::Prismatic ? Vec3::UnitX() : Vec3::UnitZ();
  out.robot.joints = {joint};
  out.robot.variables = {{"j", lower, upper}};
  return out;
}

TEST(DecidedPairs, WhatIsInsideAwayFromTheJointIsSeenAlthoughTheMeshIsCutThere) {
  TestRobot of = two_links(robot::JointType::Revolute, -1, 1);
  const geom::Mesh solid = finer(finer(finer(box_mesh({-1, -1, -2}, {1, 1, 0}))));
  geom::Mesh pin = box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
  of.surfaces = {{0, solid, {}}, {1, pin, {}}};
  auto pair = decide_pairs(of.robot, of.surfaces, {}).front();
  ASSERT_TRUE(pair.away);
  EXPECT_LT(pair.away->beyond, 0.6);
  EXPECT_EQ(pair.away->verdict, Verdict::Never);
  test::append(of.surfaces[1].outer, box_mesh({0.2, -0.1, -1.5}, {0.4, 0.1, -1.3}));
  pair = decide_pairs(of.robot, of.surfaces, {}).front();
  ASSERT_TRUE(pair.away);
  EXPECT_LT(pair.away->beyond, 0.6);
  EXPECT_EQ(pair.away->verdict, Verdict::Always);
}

/// A wall round the z axis between two heights; or, of inner radius 0, a solid prism.
geom::Mesh ring(double inner, double outer, double bottom, double top, std::uint32_t sides) {
  geom::Mesh mesh;
  for (const double radius : {inner, outer})
    for (const double z : {bottom, top})
      for (std::uint32_t i = 0; i < sides; ++i)
        mesh.vertices.emplace_back(radius * std::cos(2 * M_PI * i / sides),
                                   radius * std::sin(2 * M_PI * i / sides), z);
  const auto band = [&](std::uint32_t from, std::uint32_t to) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const std::uint32_t j = (i + 1) % sides;
      mesh.triangles.push_back({from * sides + i, from * sides + j, to * sides + j});
      mesh.triangles.push_back({from * sides + i, to * sides + j, to * sides + i});
    }
  };
  band(2, 3);
  band(3, 1);
  band(1, 0);
  band(0, 2);
  return mesh;
}

TEST(DecidedPairs, WhatIsHardAwayFromTheJointIsGoneOnWith) {
  // Links that meet at the joint, with a narrow gap all round far from it.
  TestRobot of = two_links(robot::JointType::Revolute, -0.1, 0.1);
  geom::Mesh shaft = box_mesh({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2});
  geom::Mesh sleeve = box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.3});
  test::append(shaft, ring(0.5, 0.9999, 5, 5.2, 300));
  test::append(sleeve, ring(1, 1.5, 5, 5.2, 300));
  of.surfaces = {{0, shaft, {}}, {1, sleeve, {}}};
  for (const std::size_t most : {5, 300'000}) {
    const DecidedPair pair = decide_pairs(of.robot, of.surfaces, {.most_boxes = most}).front();
    ASSERT_TRUE(pair.away);
    EXPECT_LT(pair.away->beyond, 1);
    EXPECT_EQ(pair.away->verdict, most > 5 ? Verdict::Never : Verdict::Open);
  }
  // Where nothing meets in the middle, all is away from the joint, and what is said is the same.
  of.surfaces[1].outer = ring(1, 1.5, 5, 5.2, 300);
  for (const std::uint32_t sides : {20, 300}) {
    of.surfaces[0].outer = ring(0.5, sides == 300 ? 0.9999 : 0.95, 5, 5.2, sides);
    const DecidedPair pair = decide_pairs(of.robot, of.surfaces, {.most_boxes = 5}).front();
    EXPECT_EQ(pair.verdict, sides == 20 ? Verdict::Never : Verdict::Open);
    EXPECT_EQ(pair.away.has_value(), sides == 300);
    EXPECT_TRUE(!pair.away || (pair.away->verdict == Verdict::Open && pair.away->beyond == 0));
  }
}

TEST(DecidedPairs, LimitsBeyondAllRoundingTellNothingOfTheJoint) {
  for (const double most : {1.0, 1e12, 1e18, 1e300}) {
    TestRobot of = two_links(robot::JointType::Revolute, -most, most);
    geom::Mesh a = box_mesh({-0.1, -0.1, -0.1}, {1, 0.1, 0.1});
    test::append(a, box_mesh({-1, -0.1, 0.2}, {-0.8, 0.1, 0.4}));
    geom::Mesh b = box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.2});
    test::append(b, box_mesh({0.8, -0.1, 0.2}, {1, 0.1, 0.4}));
    of.surfaces = {{0, a, {}}, {1, b, {}}};
    const DecidedPair pair = decide_pairs(of.robot, of.surfaces, {.most_boxes = 3'000}).front();
    EXPECT_NE(pair.verdict, Verdict::Never) << most;
    EXPECT_EQ(is_connected(pair), most == 1) << most;
  }
}

TEST(DecidedPairs, OnlyThoseThatAreWantedAreDecidedAndAsBefore) {
  const TestRobot of = test::random_robot(7);
  DecideOptions options{.most_boxes = 1'000, .samples = 40};
  const auto all = decide_pairs(of.robot, of.surfaces, options);
  options.wanted = [](std::uint32_t a, std::uint32_t b) { return a == 1 || b == 4; };
  const auto some = decide_pairs(of.robot, of.surfaces, options);
  ASSERT_EQ(some.size(), 7U);
  for (const DecidedPair& pair : some) {
    EXPECT_TRUE(options.wanted(pair.a, pair.b));
    const DecidedPair& before = pair_of(all, pair.a, pair.b);
    EXPECT_EQ(pair.verdict, before.verdict);
    EXPECT_EQ(pair.relation, before.relation);
  }
}

TEST(DecidedPairs, AlwaysNeedsInnerMeshesThatMeetEverywhere) {
  // In the outer mesh all along, but only up to 0.9 in the inner one.
  TestRobot of = two_links(robot::JointType::Prismatic, 0, 0.95);
  of.surfaces = {
      {0, box_mesh({-1, -1, -1}, {1, 1, 1}), box_mesh({-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9})},
      {1, box_mesh({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}), {}}};
  EXPECT_NE(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Always);
  of.robot.variables[0].upper = 0.8;
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Always);
}

TEST(DecidedPairs, WithoutAnInnerMeshTheOuterOneStillDecides) {
  TestRobot of = two_links(robot::JointType::Prismatic, -0.1, 0.1);
  const geom::Mesh none, far = box_mesh({4, 4, 4}, {5, 5, 5});
  of.surfaces = {{0, box_mesh({-1, -1, -1}, {1, 1, 1}), {}},
                 {1, box_mesh({-0.3, -0.3, -0.01}, {0.3, 0.3, 0.01}), none}};
  auto pairs = decide_pairs(of.robot, of.surfaces, {});
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs.front().verdict, Verdict::Open);
  of.surfaces[1].outer = far;
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Never);
}

TEST(DecidedPairs, NothingIsNeverOfALinkThatMayLackAShape) {
  TestRobot of = two_links(robot::JointType::Revolute, -0.1, 0.1);
  of.surfaces = {{0, box_mesh({-1, -1, -1}, {1, 1, 1}), {}, "a plane was not read"},
                 {1, box_mesh({4, 4, 4}, {5, 5, 5}), {}}};
  DecidedPair pair = decide_pairs(of.robot, of.surfaces, {}).front();
  EXPECT_EQ(pair.verdict, Verdict::Open);
  EXPECT_EQ(pair.nearest.lower, 0);
  EXPECT_EQ(pair.why, "link 'a': a plane was not read");
  of.surfaces[0].outer = {};
  pair = decide_pairs(of.robot, of.surfaces, {}).front();
  EXPECT_EQ(pair.verdict, Verdict::Open);
  EXPECT_EQ(pair.why, "link 'a': a plane was not read");
  // A contact is one whatever else there is; what holds away from the joint is not known.
  of.surfaces[0].outer = box_mesh({-1, -1, -1}, {1, 1, 1});
  of.surfaces[1].outer = box_mesh({-0.1, -0.1, 0.9}, {0.1, 0.1, 1.1});
  pair = decide_pairs(of.robot, of.surfaces, {}).front();
  EXPECT_EQ(pair.verdict, Verdict::Always);
  ASSERT_TRUE(pair.away);
  EXPECT_EQ(pair.away->verdict, Verdict::Open);
}

/// Two surfaces that slide a little against each other.
TestRobot sliding(const geom::Mesh& a, const geom::Mesh& b) {
  TestRobot of = two_links(robot::JointType::Prismatic, -0.01, 0.01);
  of.surfaces = {{0, a, {}}, {1, b, {}}};
  return of;
}

TEST(DecidedPairs, OfAGuessNeverIsProvedOfAllThatTrianglesShutOff) {
  // A wall whose two sides are one part winds about nothing, and shuts off what is in it.
  geom::Mesh wall = box_mesh({-1, -1, -1}, {1, 1, 1});
  test::append(wall, box_mesh({-1, -1, -1}, {1, 1, 1}, true));
  TestRobot of = sliding(wall, box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}));
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Never);
  for (const std::size_t which : {0, 1}) {
    of.surfaces[which].guess = "it crosses itself";
    const DecidedPair pair = decide_pairs(of.robot, of.surfaces, {}).front();
    // Of the small box it does not matter what it means.
    EXPECT_EQ(pair.verdict, which == 0 ? Verdict::Open : Verdict::Never);
    EXPECT_EQ(pair.why, which == 0 ? "link 'a': it crosses itself" : "");
    EXPECT_EQ(pair.nearest.lower > 0, which == 1);
    of.surfaces[which].guess.clear();
  }
  // Beside it, and in a cup that is open to one side only.
  of.surfaces[0].guess = "it crosses itself";
  of.surfaces[1].outer = box_mesh({1.1, -0.1, -0.1}, {1.3, 0.1, 0.1});
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Never);
  of.surfaces[1].outer = box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
  std::erase_if(of.surfaces[0].outer.triangles, [&](const geom::Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return wall.vertices[v].y() < 0; });
  });
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Never);
}

TEST(DecidedPairs, AnyConfigurationTellsWhatIsShutOff) {
  // Deep in a tube no ray leaves it, but from nearer to its end.
  geom::Mesh tube = box_mesh({-1, -0.5, -0.5}, {40, 0.5, 0.5});
  std::erase_if(tube.triangles, [&](const geom::Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return tube.vertices[v].x() < 0; });
  });
  const geom::Mesh body = box_mesh({39, -0.1, -0.1}, {39.2, 0.1, 0.1});
  for (const double most : {0.1, 30.0}) {
    TestRobot of = two_links(robot::JointType::Prismatic, -most, 0.1);
    of.surfaces = {{0, tube, {}, "", "it is open"}, {1, body, {}}};
    EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict,
              most > 1 ? Verdict::Never : Verdict::Open);
  }
}

TEST(DecidedPairs, OfAGuessNeverIsProvedAwayFromTheJointAsWell) {
  TestRobot of = two_links(robot::JointType::Revolute, -0.5, 0.5);
  geom::Mesh wall = box_mesh({0.5, -1, -1}, {3, 1, 1});
  test::append(wall, box_mesh({0.5, -1, -1}, {3, 1, 1}, true));
  test::append(wall, box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}));
  geom::Mesh pin = box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.2});
  of.surfaces = {{0, wall, {}, "", "it crosses itself"}, {1, pin, {}}};
  DecidedPair pair = decide_pairs(of.robot, of.surfaces, {}).front();
  ASSERT_TRUE(pair.away);
  EXPECT_EQ(pair.away->verdict, Verdict::Never);
  test::append(of.surfaces[1].outer, box_mesh({1.6, -0.1, -0.1}, {1.8, 0.1, 0.1}));
  pair = decide_pairs(of.robot, of.surfaces, {}).front();
  ASSERT_TRUE(pair.away);
  EXPECT_LT(pair.away->beyond, 0.4);
  EXPECT_EQ(pair.away->verdict, Verdict::Open);
  EXPECT_FALSE(is_connected(pair));
}

TEST(DecidedPairs, GuessesOfRobotsAtRandomAreDecidedAsIfTheyWereNone) {
  std::size_t never = 0, fewer = 0;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    TestRobot of = test::random_robot(seed);
    const DecideOptions options{.most_boxes = 3'000, .samples = 60};
    const std::vector<DecidedPair> sure = decide_pairs(of.robot, of.surfaces, options);
    for (LinkSurface& s : of.surfaces) s.guess = "it crosses itself";
    const std::vector<DecidedPair> guessed = decide_pairs(of.robot, of.surfaces, options);
    const Oracle oracle(of);
    Random random(seed);
    for (int i = 0; i < 100; ++i) {
      const auto at = oracle.places(test::random_configuration(of.robot, random));
      for (const DecidedPair& pair : guessed) {
        const bool is_wrong = pair.verdict == Verdict::Never && oracle.meet(at, pair);
        ASSERT_FALSE(is_wrong) << seed << ": " << pair.a << " " << pair.b;
      }
    }
    for (std::size_t i = 0; i < sure.size(); ++i) {
      never += guessed[i].verdict == Verdict::Never ? 1 : 0;
      fewer += guessed[i].verdict != sure[i].verdict ? 1 : 0;
    }
  }
  EXPECT_GT(never, 50U);
  EXPECT_EQ(fewer, 0U);
}

TEST(DecidedPairs, NoRayLeavesWhatTrianglesShutOff) {
  using detail::Surface;
  std::size_t inside = 0, seen = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    // Closed boxes whose triangles are turned at random, and loose triangles.
    geom::Mesh mesh;
    std::vector<geom::Box3> boxes;
    for (int i = 0; i < 3; ++i) {
      geom::Box3 box;
      box.extend(test::random_vector(random, 1));
      box.extend(test::random_vector(random, 1));
      boxes.push_back(box);
      test::append(mesh, box_mesh(box.min, box.max));
    }
    for (int i = 0; i < 10; ++i) {
      const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(test::random_vector(random, 1.2));
      mesh.triangles.push_back({n, n + 1, n + 2});
    }
    for (geom::Triangle& t : mesh.triangles)
      if (random.index(2) == 0) std::swap(t[1], t[2]);
    const Surface surface(mesh, Surface::Solid::ShutOff);
    for (int i = 0; i < 100; ++i) {
      Vec3 p = test::random_vector(random, 1.3);
      // Some in line with the corners and edges of a box.
      for (int k = 0; k < 3; ++k)
        if (random.index(3) == 0) p[k] = boxes[0].center()[k];
      const bool in = std::ranges::any_of(boxes, [&](const geom::Box3& box) {
        return (p.array() > box.min.array()).all() && (p.array() < box.max.array()).all();
      });
      const bool out = surface.place(p, 64) == Surface::Place::Outside;
      ASSERT_FALSE(in && out) << seed << ": " << p.transpose();
      inside += in ? 1 : 0;
      seen += out ? 1 : 0;
      all += in ? 0 : 1;
    }
  }
  EXPECT_GT(inside, 300U);
  EXPECT_GT(seen, all * 9 / 10);
}

/// An arm that turns with a slide, or with a continuous joint below it; nothing else moves.
TestRobot two_joints(robot::JointType first, double multiplier) {
  TestRobot out = two_links(first, 0, 0.01);
  out.robot.links.push_back({"c", {}, {}});
  out.robot.joints[0].axis = Vec3::UnitZ();
  robot::Joint follower;
  follower.name = "k";
  follower.type = robot::JointType::Revolute;
  follower.parent = 1;
  follower.axis = Vec3::UnitZ();
  follower.multiplier = multiplier;
  out.robot.joints.push_back(follower);
  out.surfaces = {{0, box_mesh({0.9, -0.1, -0.1}, {1.1, 0.1, 0.1}), {}},
                  {2, box_mesh({-1.1, -0.1, -0.1}, {-0.9, 0.1, 0.1}), {}}};
  return out;
}

TEST(DecidedPairs, ContactsAreShownWithinTheOwnLimitsOfJointsThatMimic) {
  TestRobot of = two_joints(robot::JointType::Prismatic, 314.15);
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::CanTouch);
  for (const bool turned_round : {false, true}) {
    of.robot.joints[1].multiplier = turned_round ? -314.15 : 314.15;
    of.robot.joints[1].lower = turned_round ? -0.1 : -0.2;
    of.robot.joints[1].upper = turned_round ? 0.2 : 0.1;
    const DecidedPair far = decide_pairs(of.robot, of.surfaces, {.most_boxes = 3'000}).front();
    EXPECT_EQ(far.verdict, Verdict::Open);
    EXPECT_EQ(far.nearest.lower, 0);
    EXPECT_GT(far.nearest.upper, 1);
  }
  // Half a turn is where they meet.
  of.robot.joints[1].lower = -3.1;
  const DecidedPair near = decide_pairs(of.robot, of.surfaces, {}).front();
  ASSERT_EQ(near.verdict, Verdict::CanTouch);
  EXPECT_LE(314.15 * near.q[0], 3.1 * (1 + 1e-12));
  // It cannot be where its leader has it at all.
  of.robot.joints[1].lower = 1;
  of.robot.joints[1].upper = 2;
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {.most_boxes = 3'000}).front().verdict,
            Verdict::Open);
}

TEST(DecidedPairs, JointsWithoutLimitsAreLookedAtForOneTurnOfTheSlowest) {
  for (const double multiplier : {2.0, -3.0, 0.25, 1.0}) {
    TestRobot of = two_joints(robot::JointType::Revolute, multiplier);
    of.robot.variables[0] = {"j", {}, {}};
    EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::CanTouch)
        << multiplier;
    for (geom::Vec3& v : of.surfaces[1].outer.vertices) v.z() += 0.3;
    EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Never)
        << multiplier;
  }
  // No turn of the first is one of both.
  TestRobot of = two_joints(robot::JointType::Revolute, 1.5);
  of.robot.variables[0] = {"j", {}, {}};
  for (geom::Vec3& v : of.surfaces[1].outer.vertices) v.z() += 0.3;
  EXPECT_EQ(decide_pairs(of.robot, of.surfaces, {}).front().verdict, Verdict::Open);
}

TEST(DecidedPairs, OuterMeshesProveAndInnerOnesShow) {
  TestRobot of = arm_over_table(0.001);
  // Outer meshes meet; inner ones do not: neither can be said.
  of.surfaces[2].inner = of.surfaces[2].outer;
  of.surfaces[2].outer = box_mesh({0.1, -0.1, -0.1}, {0.51, 0.1, 0.1});
  EXPECT_EQ(pair_of(decide_pairs(of.robot, of.surfaces, {.most_boxes = 2'000}), 0, 2).verdict,
            Verdict::Open);
}

TEST(DecidedPairs, TheSameForAnyOrderAndTwoSurfacesOfALinkAreRefused) {
  TestRobot of = test::random_robot(3);
  const auto first = decide_pairs(of.robot, of.surfaces, {.most_boxes = 1'000, .samples = 40});
  std::ranges::reverse(of.surfaces);
  const auto second = decide_pairs(of.robot, of.surfaces, {.most_boxes = 1'000, .samples = 40});
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].verdict, second[i].verdict);
    EXPECT_EQ(first[i].q, second[i].q);
    EXPECT_EQ(first[i].nearest.lower, second[i].nearest.lower);
    EXPECT_EQ(first[i].depth.lower, second[i].depth.lower);
  }
  of.surfaces.push_back(of.surfaces.front());
  EXPECT_ANY_THROW(decide_pairs(of.robot, of.surfaces, {}));
}

TEST(DecidedPairs, WhenTheTimeIsUpTheRestIsOpen) {
  const TestRobot of = test::random_robot(5);
  const auto pairs = decide_pairs(of.robot, of.surfaces, {.most_seconds = 1e-9});
  EXPECT_EQ(pairs.size(), 15U);
  for (const DecidedPair& pair : pairs) {
    EXPECT_LE(pair.nearest.lower, pair.nearest.upper);
    EXPECT_NE(pair.verdict, Verdict::CanTouch);
  }
}

}  // namespace
}  // namespace kaboum::pairs
