#include <gtest/gtest.h>
#include <kaboum/verify/held_shape.h>
#include <kaboum/verify/motion_alike.h>

#include <functional>

#include "robots.h"
#include "support/shapes.h"

namespace kaboum::test {
namespace {

using verify::Answer;
using verify::Claims;
using verify::Holders;

geom::Mesh block(const geom::Vec3& low, const geom::Vec3& high) {
  return translated(box(high - low, 1), low);
}

TEST(MotionAlike, EveryDifferenceIsSeen) {
  const Robot robot = six_axis_arm().robot;
  EXPECT_EQ(verify::difference_in_motion(robot, robot), "");
  const std::uint32_t v = robot.joints[2].variable;
  const std::vector<std::pair<std::string, std::function<void(Robot&)>>> changes{
      {"root", [](Robot& r) { r.links[0].name = "other"; }},
      {"no link", [](Robot& r) { r.links[3].name = "other"; }},
      {"no joint", [](Robot& r) { r.joints[2].name = "other"; }},
      {"another type", [](Robot& r) { r.joints[2].type = JointType::Prismatic; }},
      {"another parent", [](Robot& r) { r.joints[2].parent = 0; }},
      {"another child", [](Robot& r) { std::swap(r.links[3].name, r.links[4].name); }},
      {"another origin", [](Robot& r) { r.joints[2].origin.translation.x() += 1e-15; }},
      {"another axis", [](Robot& r) { r.joints[2].axis = -r.joints[2].axis; }},
      {"mimics", [](Robot& r) { r.joints[2].multiplier = 2; }},
      {"mimics", [](Robot& r) { r.joints[2].offset = 1e-15; }},
      {"mimics", [&](Robot& r) { r.variables[v].name = "other"; }},
      {"other limits", [&](Robot& r) { r.variables[v].upper = 9; }},
  };
  for (const auto& [what, change] : changes) {
    Robot other = robot;
    change(other);
    const std::string found = verify::difference_in_motion(robot, other);
    EXPECT_NE(found.find(what), std::string::npos) << what << ": " << found;
  }
}

TEST(HeldShape, HeldByOneOrByTwoTogether) {
  const geom::Mesh low = block({0, 0, 0}, {2, 2, 1}), high = block({0, 0, 1}, {2, 2, 2});
  const geom::Mesh both = block({0, 0, 0.5}, {2, 2, 1.5}), more = block({0, 0, 0.5}, {2, 2, 2.01});
  const Holders holders({{"low", &low}, {"high", &high}});
  EXPECT_TRUE(holders.all_convex());
  EXPECT_EQ(holders.hold(both, Claims::All).answer, Answer::Verified);
  const verify::HeldShape refuted = holders.hold(more, Claims::All);
  EXPECT_EQ(refuted.answer, Answer::Refuted);
  ASSERT_TRUE(refuted.decisive && refuted.decisive->witness);
  EXPECT_EQ(Holders({{"low", &low}}).hold(both, Claims::All).answer, Answer::Refuted);
  EXPECT_EQ(holders.hold(flipped(both), Claims::All).answer, Answer::Undecided);
  EXPECT_EQ(Holders({}).hold(both, Claims::All).answer, Answer::Refuted);
}

// What is open or inside out holds nothing; several that are not all convex refute nothing.
TEST(HeldShape, NotEveryMeshHolds) {
  const geom::Mesh solid = block({0, 0, 0}, {2, 2, 2}), inner = block({0.5, 0.5, 0.5}, {1, 1, 1});
  geom::Mesh open = solid;
  open.triangles.pop_back();
  const geom::Mesh inverted = flipped(solid);
  for (const geom::Mesh* mesh : std::initializer_list<const geom::Mesh*>{&open, &inverted}) {
    const Holders none({{"a", mesh}});
    EXPECT_EQ(none.left_out().size(), 1U);
    EXPECT_EQ(none.hold(inner, Claims::All).answer, Answer::Refuted);
    EXPECT_EQ(none.hold(inner, Claims::Solid).answer, Answer::Undecided);
    // Beside others it may be meant otherwise.
    const Holders two({{"a", mesh}, {"b", mesh}});
    EXPECT_EQ(two.hold(inner, Claims::All).answer, Answer::Undecided);
  }
  const geom::Mesh hollow = merged({solid, flipped(block({0.25, 0.25, 0.25}, {1.5, 1.5, 1.5}))});
  const Holders crooked({{"hollow", &hollow}});
  EXPECT_FALSE(crooked.all_convex());
  EXPECT_EQ(crooked.hold(inner, Claims::All).answer, Answer::Refuted);
  const Holders several({{"hollow", &hollow}, {"solid", &inner}});
  EXPECT_EQ(several.hold(block({0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}), Claims::All).answer,
            Answer::Undecided);
}

TEST(HeldShape, SegmentsAreJudgedAsTheyAre) {
  const geom::Mesh solid = block({0, 0, 0}, {1, 1, 1});
  const Holders holders({{"solid", &solid}});
  const auto segment = [](double end) {
    return geom::Mesh{{{0.5, 0.5, 0.5}, {end, 0.5, 0.5}, {0.6, 0.5, 0.5}}, {{0, 1, 2}}};
  };
  EXPECT_EQ(holders.hold(segment(1), Claims::All).answer, Answer::Verified);
  EXPECT_EQ(holders.hold(segment(5), Claims::All).answer, Answer::Refuted);
  geom::Mesh closed = segment(1);
  closed.triangles.push_back({2, 1, 0});
  EXPECT_EQ(holders.hold(closed, Claims::All).answer, Answer::Verified);
  EXPECT_EQ(holders.hold(closed, Claims::Solid).answer, Answer::Undefined);
  EXPECT_EQ(holders.hold({}, Claims::All).answer, Answer::Undecided);
}

// Of meshes that are not convex, the surface: inside them it may be farther.
TEST(HeldShape, DistanceOfMeshesThatAreNotConvex) {
  const geom::Mesh cavity = flipped(block({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));
  const geom::Mesh hollow = merged({block({0, 0, 0}, {2, 2, 2}), cavity}),
                   larger = merged({block({0, 0, 0}, {2, 2, 2.2}), cavity});
  const Holders holders({{"larger", &larger}});
  const verify::HeldDistance near = holders.distance({hollow}, 0.21),
                             far = holders.distance({hollow}, 0.19);
  ASSERT_TRUE(near.claim && far.claim);
  EXPECT_TRUE(near.of_surface && near.to_solid);
  EXPECT_EQ(near.claim->answer, Answer::Verified);
  EXPECT_EQ(far.claim->answer, Answer::Refuted);
  EXPECT_NEAR(far.claim->largest, 0.2, 0.01);
  geom::Mesh open = larger;
  open.triangles.pop_back();
  EXPECT_FALSE(Holders({{"open", &open}}).distance({hollow}, 1).claim);
  EXPECT_FALSE(Holders({{"open", &open}, {"larger", &larger}}).distance({hollow}, 1).claim);
}

TEST(HeldShape, DistanceToAllMeshesTogether) {
  const geom::Mesh a = block({0, 0, 0}, {1, 1, 1}), b = block({3, 0, 0}, {4, 1, 1});
  const geom::Mesh round_a = block({-0.1, 0, 0}, {1, 1, 1}),
                   round_b = block({3, 0, 0}, {4.2, 1, 1});
  const Holders holders({{"a", &round_a}, {"b", &round_b}});
  EXPECT_EQ(holders.distance({a, b}, 0.21).claim->answer, Answer::Verified);
  EXPECT_EQ(holders.distance({a, b}, 0.19).claim->answer, Answer::Refuted);
  EXPECT_EQ(holders.distance({a}, 0.21).claim->answer, Answer::Refuted);
}

}  // namespace
}  // namespace kaboum::test
