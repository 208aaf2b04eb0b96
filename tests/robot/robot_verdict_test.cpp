// The verdict on a robot: one answer and one sentence a link, whatever its meshes bound.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/verify/robot_verdict.h>

#include <algorithm>
#include <map>

#include "support/shapes.h"

namespace kaboum::test {
namespace {

using robot::Geometry;
using verify::Answer;
using verify::Claims;
using verify::Solid;

geom::Mesh block_between(const geom::Vec3& low, const geom::Vec3& high) {
  return translated(box(high - low, 1), low);
}

/// A triangle and the same back to back.
geom::Mesh sheet(double reach) {
  geom::Mesh out;
  out.vertices = {{1, 0.2, 0.5}, {1 + reach, 0.2, 0.5}, {1 + reach, 0.8, 0.5}};
  out.triangles = {{0, 1, 2}, {0, 2, 1}};
  return out;
}

/// An extruded bow tie: half of it winds backwards.
geom::Mesh bow_tie() {
  geom::Mesh out;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}})
      out.vertices.emplace_back(x, y, z);
  out.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    out.triangles.push_back({i, j, 4 + j});
    out.triangles.push_back({i, 4 + j, 4 + i});
  }
  return out;
}

Geometry shape_of(const std::string& mesh) {
  Geometry g;
  g.shape = Geometry::Shape::Mesh;
  g.mesh = mesh;
  g.size.setOnes();
  return g;
}

/// Robots of one link each, and their meshes by name.
struct Case {
  std::map<std::string, verify::MeshFile> files = {};
  robot::Robot original = {}, result = {};

  Case(const geom::Mesh& mesh, const std::vector<geom::Mesh>& bodies) {
    original.links.resize(1);
    original.links[0].name = "l";
    result = original;
    add("original", mesh);
    original.links[0].collision.push_back(shape_of("original"));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string name = "body" + std::to_string(i);
      add(name, bodies[i]);
      result.links[0].collision.push_back(shape_of(name));
    }
  }
  void add(const std::string& name, const geom::Mesh& mesh) { files[name] = {name, "", mesh, {}}; }
  verify::RobotVerdict decide(Solid solid, Claims claims = Claims::All,
                              std::optional<Length> epsilon = {}, bool drop_sheets = false) {
    verify::RobotQuestion q{
        original, result,
        [this](const Geometry& g, bool) -> const verify::MeshFile& { return files.at(g.mesh); }};
    q.solid = solid;
    q.claims = claims;
    q.epsilon = epsilon;
    q.drop_sheets = drop_sheets;
    return verify::decide(q);
  }
};

const geom::Mesh kBox = block_between({0, 0, 0}, {1, 1, 1});
const geom::Mesh kRound = block_between({-0.1, -0.1, -0.1}, {1.1, 1.1, 1.1});
const geom::Mesh kWide = block_between({-0.1, -0.1, -0.1}, {1.4, 1.1, 1.1});

TEST(RobotVerdict, SheetsAreJudgedWhateverBoundsTheSolid) {
  for (const Solid solid : {Solid::AsFile, Solid::Prepared, Solid::Enclosed}) {
    Case held(merged({kBox, sheet(0.3)}), {kWide});
    const verify::RobotVerdict yes = held.decide(solid);
    EXPECT_EQ(yes.answer, Answer::Verified);
    ASSERT_EQ(yes.links.size(), 1U);
    EXPECT_EQ(yes.links[0].sentence, "every triangle is inside: 1 mesh in 1 body");
    Case out(merged({kBox, sheet(0.3)}), {kRound});
    const verify::RobotVerdict no = out.decide(solid);
    EXPECT_EQ(no.answer, Answer::Refuted);
    const verify::ShapeVerdict& shape = no.links.at(0).shapes.at(0);
    ASSERT_TRUE(shape.triangles && shape.sticks_out);
    EXPECT_EQ(shape.triangles->inner_triangles.size(), 2U);
    EXPECT_NEAR(shape.sticks_out->upper, 0.2, 0.001);
    EXPECT_GE(shape.sticks_out->upper, 0.2 - 1e-12);
    EXPECT_NE(no.links[0].sentence.find("2 triangles are not inside"), std::string::npos)
        << no.links[0].sentence;
    // Only triangles' claim: the same; only the solid's: the box is held.
    EXPECT_EQ(out.decide(solid, Claims::Surface).answer, Answer::Refuted);
    EXPECT_EQ(out.decide(solid, Claims::Solid).answer, Answer::Verified);
  }
}

TEST(RobotVerdict, SheetsDroppedOnRequestAreNamed) {
  Case out(merged({kBox, sheet(0.3)}), {kRound});
  const verify::RobotVerdict found = out.decide(Solid::Prepared, Claims::All, {}, true);
  EXPECT_EQ(found.answer, Answer::Verified);
  EXPECT_NE(found.links.at(0).sentence.find("but the 2 ones of sheets"), std::string::npos)
      << found.links[0].sentence;
}

// A frame whose walls hold the triangles does not hold what these enclose.
TEST(RobotVerdict, WhatIsWoundRoundBackwardsIsAskedForToo) {
  std::vector<geom::Mesh> walls;
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {0.0, 1.0}) {
      geom::Vec3 low = geom::Vec3::Constant(-0.1), high = geom::Vec3::Constant(1.1);
      low[axis] = at - 0.1;
      high[axis] = at + 0.1;
      walls.push_back(block_between(low, high));
    }
  for (const Solid solid : {Solid::Prepared, Solid::Enclosed}) {
    EXPECT_EQ(Case(kBox, walls).decide(solid).answer, Answer::Refuted);
    EXPECT_EQ(Case(flipped(kBox), walls).decide(solid).answer, Answer::Refuted);
    EXPECT_EQ(Case(flipped(kBox), walls).decide(solid, Claims::Surface).answer, Answer::Verified);
    EXPECT_EQ(Case(flipped(kBox), {kRound}).decide(solid).answer, Answer::Verified);
    EXPECT_EQ(Case(bow_tie(), {kRound}).decide(solid).answer, Answer::Verified);
    // Both halves, whichever of them winds backwards.
    EXPECT_EQ(Case(bow_tie(), walls).decide(solid).answer, Answer::Refuted);
    EXPECT_EQ(Case(flipped(bow_tie()), walls).decide(solid).answer, Answer::Refuted);
  }
}

TEST(RobotVerdict, DistancesOfWhatBoundsNoSolid) {
  Case held(merged({kBox, sheet(0.3)}), {kWide});
  for (const Solid solid : {Solid::Prepared, Solid::Enclosed}) {
    // The farthest corners are beside the sheet.
    EXPECT_EQ(held.decide(solid, Claims::All, Length{0.5}).answer, Answer::Verified);
    EXPECT_EQ(held.decide(solid, Claims::All, Length{0.1}).answer, Answer::Refuted);
  }
}

TEST(RobotVerdict, OneMeshThatIsNotConvexRefutes) {
  const geom::Mesh ring =
      merged({kWide, flipped(block_between({1.15, 0.1, 0.4}, {1.35, 0.9, 0.6}))});
  EXPECT_EQ(Case(merged({kBox, sheet(0.3)}), {ring}).decide(Solid::Prepared).answer,
            Answer::Refuted);
  EXPECT_EQ(Case(merged({kBox, sheet(0.3)}), {ring, kRound}).decide(Solid::Prepared).answer,
            Answer::Undecided);
}

// What is kept as it was, or is inside out, is no more undecided than what is not there.
TEST(RobotVerdict, ALoneMeshThatHoldsNothingRefutes) {
  for (const Solid solid : {Solid::AsFile, Solid::Prepared, Solid::Enclosed}) {
    EXPECT_EQ(Case(sheet(0.3), {sheet(0.3)}).decide(solid).answer, Answer::Refuted);
    EXPECT_EQ(Case(kBox, {flipped(kRound)}).decide(solid).answer, Answer::Refuted);
    EXPECT_EQ(Case(bow_tie(), {bow_tie()}).decide(solid).answer, Answer::Refuted);
    // Beside others it may be meant otherwise.
    EXPECT_EQ(Case(kBox, {flipped(kRound), flipped(kWide)}).decide(solid).answer,
              Answer::Undecided);
  }
  // It is inside out as a whole, yet winds forwards round what it is to hold.
  const geom::Mesh both = merged({kRound, translated(flipped(kWide), {5, 0, 0})});
  EXPECT_EQ(Case(kBox, {both}).decide(Solid::Prepared).answer, Answer::Undecided);
}

// Quads that are not plane are to be held whichever way they are split.
TEST(RobotVerdict, BothWaysOfSplittingAQuadAreAskedFor) {
  geom::Mesh low = kBox;  // its top is the quad, with one corner raised
  const auto on_top = [&](const geom::Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return low.vertices[v].z() == 1; });
  };
  std::vector<geom::Triangle> top, rest;
  for (const geom::Triangle& t : low.triangles) (on_top(t) ? top : rest).push_back(t);
  ASSERT_EQ(top.size(), 2U);
  low.triangles = top;
  low.triangles.insert(low.triangles.end(), rest.begin(), rest.end());
  // A corner of one of both triangles only.
  for (const std::uint32_t v : top[0])
    if (std::ranges::find(top[1], v) == top[1].end()) low.vertices[v].z() = 0.7;
  // As it is read, along the other corners, which are higher; the other way is lower.
  geom::Mesh valley = low;
  for (geom::Vec3& v : valley.vertices)
    if (v.z() >= 0.7) v.z() = v.z() == 1 ? 0.7 : 1;
  for (const Solid solid : {Solid::Prepared, Solid::Enclosed}) {
    Case plain(valley, {valley}), told(valley, {valley});
    told.files["original"].quads = {0};
    EXPECT_EQ(plain.decide(solid).answer, Answer::Verified);
    EXPECT_EQ(told.decide(solid).answer, Answer::Refuted);
    Case held(valley, {kRound});
    held.files["original"].quads = {0};
    EXPECT_EQ(held.decide(solid).answer, Answer::Verified);
  }
}

TEST(RobotVerdict, TheWorstShapeIsTheLinks) {
  Case two(kBox, {kRound});
  Geometry ball;
  ball.shape = Geometry::Shape::Sphere;
  ball.size.setConstant(0.5);
  two.original.links[0].collision.push_back(ball);
  EXPECT_EQ(two.decide(Solid::Prepared).answer, Answer::Undecided);
  EXPECT_NE(two.decide(Solid::Prepared).links.at(0).sentence.find("none of its size"),
            std::string::npos);
  two.result.links[0].collision.push_back(ball);
  EXPECT_EQ(two.decide(Solid::Prepared).links.at(0).sentence,
            "every triangle is inside: 1 mesh in 1 body; 1 shape is as it was");
  two.original.links[0].name = "other";
  two.result = two.original;
  two.result.links[0].collision.clear();
  const verify::RobotVerdict gone = two.decide(Solid::Prepared);
  EXPECT_EQ(gone.answer, Answer::Refuted);
  EXPECT_NE(gone.links.at(0).sentence.find("nor are 1 other shape"), std::string::npos)
      << gone.links[0].sentence;
}

/// A question about a box in a turned and scaled frame, and a ball about one of its corners.
struct RegionCase : Case {
  robot::LinkBounds bounds = {};
  std::optional<Length> epsilon = Length{0.6};

  /// @param bodies  in the mesh's frame
  explicit RegionCase(const std::vector<geom::Mesh>& bodies, double radius = 0.3,
                      const geom::Vec3& scale = {2, 2, 2})
      : Case(kBox, bodies) {
    robot::Transform pose;
    pose.linear = robot::rotation_from_rpy(0.4, -1.1, 2.3);
    pose.translation = {3, -1, 2};
    for (robot::Robot* one : {&original, &result})
      for (Geometry& g : one->links[0].collision) {
        g.size = scale;
        g.origin = pose;
      }
    robot::LinkRegion region;
    region.name = "'corner'";
    region.epsilon = Length{0.05};
    region.region.center = pose * scale;  // of the corner (1, 1, 1)
    region.region.radius = radius;
    bounds.regions["l"] = {region};
  }
  verify::RobotVerdict decide_it() {
    verify::RobotQuestion q{
        original, result,
        [this](const Geometry& g, bool) -> const verify::MeshFile& { return files.at(g.mesh); }};
    q.epsilon = epsilon;
    q.bounds = bounds;
    return verify::decide(q);
  }
};

// Bodies are scaled by 2: 0.1 of the mesh's unit is 0.2 of the robot's.
TEST(RobotVerdict, RegionsAreNearerInTheFrameOfTheLink) {
  const geom::Mesh near = block_between({-0.1, -0.1, -0.1}, {1.01, 1.01, 1.01}),
                   far = block_between({-0.01, -0.01, -0.01}, {1.01, 1.01, 1.1});
  const verify::RobotVerdict yes = RegionCase({near}).decide_it();
  EXPECT_EQ(yes.answer, Answer::Verified);
  ASSERT_EQ(yes.links.at(0).shapes.size(), 3U);
  EXPECT_EQ(yes.links[0].shapes[2].region, "'corner'");
  EXPECT_TRUE(yes.links[0].shapes[2].reached);
  EXPECT_EQ(yes.links[0].shapes[2].bound, 0.025);
  // 0.2 is too far there, and would do elsewhere.
  RegionCase out({far});
  const verify::RobotVerdict no = out.decide_it();
  EXPECT_EQ(no.answer, Answer::Refuted);
  EXPECT_EQ(no.links.at(0).shapes.at(1).answer, Answer::Verified);
  EXPECT_EQ(no.links[0].shapes.at(2).answer, Answer::Refuted);
  EXPECT_NE(no.links[0].sentence.find("in the region 'corner'"), std::string::npos)
      << no.links[0].sentence;
  out.epsilon.reset();  // regions need none
  EXPECT_EQ(out.decide_it().answer, Answer::Refuted);
  out.bounds = {};
  EXPECT_EQ(out.decide_it().answer, Answer::Verified);
  // A part beside the corner that is too far, as near to it as the region reaches, and beyond.
  const auto beside = [&](double at) {
    return std::vector<geom::Mesh>{near, block_between({at - 0.01, 0.4, 0.4}, {at, 1.1, 1.1})};
  };
  EXPECT_EQ(RegionCase(beside(0.9)).decide_it().answer, Answer::Refuted);
  EXPECT_EQ(RegionCase(beside(0.8)).decide_it().answer, Answer::Verified);
  // Not reached at all.
  RegionCase apart({far});
  apart.bounds.regions["l"][0].region.center = {50, 50, 50};
  const verify::RobotVerdict nothing = apart.decide_it();
  EXPECT_EQ(nothing.answer, Answer::Verified);
  EXPECT_FALSE(nothing.links.at(0).shapes.at(2).reached);
}

// The same mesh and bodies twice in a link: the region is at one of them, whichever comes first.
TEST(RobotVerdict, RegionsAreElsewhereInOtherPoses) {
  const geom::Mesh far = block_between({-0.01, -0.01, -0.01}, {1.01, 1.01, 1.1});
  for (const bool first : {true, false}) {
    RegionCase two({far});
    for (robot::Robot* one : {&two.original, &two.result}) {
      std::vector<Geometry>& shapes = one->links[0].collision;
      Geometry other = shapes[0];
      other.origin.translation += geom::Vec3(20, 0, 0);
      shapes.insert(first ? shapes.end() : shapes.begin(), other);
    }
    const verify::RobotVerdict found = two.decide_it();
    EXPECT_EQ(found.answer, Answer::Refuted);
    ASSERT_EQ(found.links.at(0).shapes.size(), 6U);
    EXPECT_EQ(found.links[0].shapes[first ? 2 : 5].answer, Answer::Refuted);
    EXPECT_EQ(found.links[0].shapes[first ? 5 : 2].answer, Answer::Verified);
  }
}

// Where the scale is uneven, what is certain is said, and nothing else.
TEST(RobotVerdict, RegionsOfUnevenScales) {
  const geom::Vec3 uneven(1, 2, 4);
  const auto body = [](double x, double y, double z) {
    return std::vector{block_between({-0.01, -0.01, -0.01}, {1 + x, 1 + y, 1 + z})};
  };
  // 0.05 is 0.0125 where all axes may be the longest, 0.05 where none is.
  EXPECT_EQ(RegionCase(body(0.005, 0.005, 0.005), 0.3, uneven).decide_it().answer,
            Answer::Verified);
  EXPECT_EQ(RegionCase(body(0.03, 0.001, 0.001), 0.3, uneven).decide_it().answer,
            Answer::Undecided);
  EXPECT_EQ(RegionCase(body(0.07, 0.001, 0.001), 0.3, uneven).decide_it().answer, Answer::Refuted);
}

TEST(RobotVerdict, LinksHaveAnEpsilonOfTheirOwn) {
  RegionCase one({kRound});
  one.bounds = {};
  EXPECT_EQ(one.decide_it().answer, Answer::Verified);
  one.bounds.epsilons["l"] = Length{0.1};
  EXPECT_EQ(one.decide_it().answer, Answer::Refuted);
  one.epsilon = Length{0.1};
  one.bounds.epsilons["l"] = Length{0.6};
  EXPECT_EQ(one.decide_it().answer, Answer::Verified);
  one.epsilon.reset();
  one.bounds.epsilons["l"] = Length{0.1};
  EXPECT_EQ(one.decide_it().answer, Answer::Refuted);
}

}  // namespace
}  // namespace kaboum::test
