// Exact meshes of robots and objects: which pairs are looked at, and where things are.

#include <gtest/gtest.h>
#include <kaboum/judge/cell.h>
#include <kaboum/judge/placement.h>

#include <cmath>
#include <random>

namespace kaboum::judge {
namespace {

geom::Mesh box(const geom::Vec3& size, const geom::Vec3& center) {
  geom::Mesh out;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        out.vertices.emplace_back(center + geom::Vec3(x, y, z).cwiseProduct(size));
  out.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return out;
}

/// Three links in a row along x, each a bar of length 1; the joints turn about z.
robot::Robot bars() {
  return robot::parse_urdf(
      R"(<robot name="r"><link name="a"><collision><geometry><box size="1 1 1"/>
    </geometry></collision></link><link name="b"><collision><geometry><box size="1 1 1"/></geometry>
    </collision></link><link name="frame"/><link name="c"><collision><geometry><box size="1 1 1"/>
    </geometry></collision></link>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3.2" upper="3.2" effort="1" velocity="1"/></joint>
    <joint name="k" type="revolute"><parent link="b"/><child link="frame"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3.2" upper="3.2" effort="1" velocity="1"/></joint>
    <joint name="f" type="fixed"><parent link="frame"/><child link="c"/></joint></robot>)",
      "test");
}

Cell make_cell() {
  Cell cell;
  robot::Robot robot = bars();
  const auto a = *robot.find_link("a"), b = *robot.find_link("b"), c = *robot.find_link("c");
  cell.add_robot("r", std::move(robot), {});
  for (const auto link : {a, b, c}) cell.add_link(0, link, box({1.0, 0.1, 0.1}, {0.5, 0, 0}));
  cell.add_object("thing", box({0.1, 0.1, 0.1}, {0, 0, 0}));
  cell.add_object("wall", box({0.1, 0.1, 0.1}, {0, 0, 0}));
  return cell;
}

CellState far_away() {
  CellState state;
  state.q = {{0, 0}};
  state.objects = {{{Eigen::Matrix3d::Identity(), {10, 0, 0}}, std::nullopt, false},
                   {{Eigen::Matrix3d::Identity(), {20, 0, 0}}, std::nullopt, false}};
  return state;
}

TEST(Cell, LinksNextToEachOtherAreNotLookedAt) {
  const Cell cell = make_cell();
  CellState state = far_away();
  EXPECT_FALSE(cell.find_meeting(state));  // a and b, b and c share an end
  state.q = {{0, 2.9}};                    // c overlaps b, which is next to it
  EXPECT_FALSE(cell.find_meeting(state));
  state.q = {{2.1, 2.1}};  // a triangle: c crosses a
  const auto meeting = cell.find_meeting(state);
  ASSERT_TRUE(meeting);
  EXPECT_EQ(meeting->names, (std::array<std::string, 2>{"r/a", "r/c"}));
}

TEST(Cell, AllowedPairsAreNotLookedAt) {
  Cell cell = make_cell();
  CellState state = far_away();
  state.objects[0].pose.translation = {2.5, 0.05, 0};
  EXPECT_TRUE(cell.find_meeting(state));
  EXPECT_TRUE(cell.find_meeting(state, 0));
  EXPECT_TRUE(cell.find_meeting_of(state, 0));
  EXPECT_FALSE(cell.find_meeting_of(state, 1));
  cell.allow("thing", "r/c");
  EXPECT_FALSE(cell.find_meeting(state));
  state.objects[0].away = true;
  state.objects[0].pose.translation = {0.5, 0, 0};
  EXPECT_FALSE(cell.find_meeting(state));
}

TEST(Cell, DisplacementBoundsAllPoints) {
  const Cell cell = make_cell();
  CellState from = far_away(), to = from;
  EXPECT_EQ(cell.displacement(from, to, 0), 0);
  for (const double turn : {1e-9, 0.01, 0.3, -2.0}) {
    to.q = {{turn, 0}};
    // The end of the last bar is at 3, the joint at 1.
    const double end = 2 * 2 * std::abs(std::sin(turn / 2));
    EXPECT_GE(cell.displacement(from, to, 0), end * (1 - 1e-9));
    EXPECT_LE(cell.displacement(from, to, 0), 1.2 * end);
  }
  // What it holds counts, too: 3 from the last joint.
  from.objects[0] = {{}, Hold{0, 3, {Eigen::Matrix3d::Identity(), {3, 0, 0}}, {}}, false};
  to.objects[0] = from.objects[0];
  to.q = {{0, 0.01}};
  EXPECT_GE(cell.displacement(from, to, 0), 3 * 2 * std::sin(0.005));
}

/// At every sample, one after the other.
bool meets_somewhere(const Cell& cell, const CellState& from, const CellState& to, int samples) {
  CellState state = from;
  for (int k = 0; k <= samples; ++k) {
    for (std::size_t i = 0; i < state.q[0].size(); ++i)
      state.q[0][i] = from.q[0][i] + static_cast<double>(k) / samples * (to.q[0][i] - from.q[0][i]);
    if (cell.find_meeting(state)) return true;
  }
  return false;
}

// Motions past a thin thing, and by it: the same as by all samples, with fewer looked at.
TEST(Cell, MotionsMeetWhatTheirSamplesMeet) {
  const Cell cell = make_cell();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> turn(-3, 3);
  constexpr int kSamples = 300;
  int meetings = 0;
  for (int trial = 0; trial < 60; ++trial) {
    CellState from = far_away();
    from.objects[0].pose.translation = {1 + 0.7 * turn(random), 0.7 * turn(random), 0};
    from.q[0] = {turn(random), turn(random)};
    CellState to = from;
    for (double& q : to.q[0]) q += 0.5 * turn(random);
    std::size_t looked = 0;
    const bool found = cell.find_meeting_on(from, to, 0, kSamples, looked).has_value();
    EXPECT_EQ(found, meets_somewhere(cell, from, to, kSamples)) << trial;
    meetings += found ? 1 : 0;
  }
  EXPECT_GT(meetings, 5);
  EXPECT_LT(meetings, 55);
}

// A slide without limits below a joint that stands still.
TEST(Cell, MotionsOfSlidesWithoutLimitsAreBounded) {
  robot::Robot robot = robot::parse_urdf(
      R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"><collision><geometry>
    <box size="1 1 1"/></geometry></collision></link>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
    <joint name="s" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)",
      "test");
  robot.variables[1].lower.reset();
  robot.variables[1].upper.reset();
  const auto c = *robot.find_link("c");
  Cell cell;
  cell.add_robot("r", std::move(robot), {});
  cell.add_link(0, c, box({0.1, 0.1, 0.1}, {0, 0, 0}));
  cell.add_object("post", box({0.001, 1, 1}, {0, 0, 0}));
  CellState from;
  from.q = {{0, 0}};
  from.objects = {{{Eigen::Matrix3d::Identity(), {0.5, 0, 0}}, std::nullopt, false}};
  CellState to = from;
  to.q[0][1] = 1;
  std::size_t looked = 0;
  EXPECT_TRUE(cell.find_meeting_on(from, to, 0, 1000, looked));
  EXPECT_LT(looked, 200U);
}

TEST(Cell, WhatIsHeldMovesWithTheLink) {
  const Cell cell = make_cell();
  CellState state = far_away();
  const std::uint32_t c = *cell.kinematics(0).find_link("c");
  Hold hold;
  hold.link = c;
  hold.pose.translation = {1.02, 0, 0};  // it overlaps c, which holds it
  state.objects[0].hold = hold;
  EXPECT_LT((cell.pose_of(state, 0).translation - geom::Vec3(3.02, 0, 0)).norm(), 1e-12);
  EXPECT_FALSE(cell.find_meeting(state));
  state.q = {{0, 1.5707963267948966}};
  EXPECT_LT((cell.pose_of(state, 0).translation - geom::Vec3(2, 1.02, 0)).norm(), 1e-12);
  state.objects[1].pose.translation = {2.02, 1.1, 0};
  const auto meeting = cell.find_meeting(state, 0);
  ASSERT_TRUE(meeting);
  EXPECT_EQ(meeting->names, (std::array<std::string, 2>{"thing", "wall"}));
  // Links that may touch it, and no others: beside the middle of c, where b is.
  state.objects[1].away = true;
  state.objects[0].hold->pose.translation = {0.5, 0.08, 0};
  state.q = {{0, 2.9}};
  ASSERT_TRUE(cell.find_meeting(state));
  state.objects[0].hold->touching = {*cell.kinematics(0).find_link("b")};
  EXPECT_FALSE(cell.find_meeting(state));
  // Pads alone: the link that it moves with may not.
  state.objects[0].hold->link_touches = false;
  const auto beside = cell.find_meeting(state);
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->names, (std::array<std::string, 2>{"r/c", "thing"}));
  state.objects[0].hold->touching.push_back(c);
  EXPECT_FALSE(cell.find_meeting(state));
}

}  // namespace
}  // namespace kaboum::judge
