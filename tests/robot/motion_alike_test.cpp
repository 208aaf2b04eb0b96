// Whether links of two files have the same frames, against poses at random values of the joints.
#include <gtest/gtest.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>
#include <random>
#include <string>

namespace kaboum::test {
namespace {

// Two arms, with mimicry, a fixed joint and one that slides.
constexpr const char* kRobot = R"(<robot name="r">
<link name="base"/><link name="stand"/><link name="l1"/><link name="l2"/><link name="l3"/>
<link name="r1"/><link name="r2"/>
<joint name="s" type="fixed"><parent link="base"/><child link="stand"/><origin xyz="0.5 0 0.25" rpy="0 0 0.5"/></joint>
<joint name="a" type="revolute"><parent link="stand"/><child link="l1"/><origin xyz="0 0.2 0.1"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="b" type="prismatic"><parent link="l1"/><child link="l2"/><origin xyz="1 0 0" rpy="0.3 0.2 0.1"/><axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="c" type="fixed"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.125" rpy="0.7 0 0"/></joint>
<joint name="d" type="continuous"><parent link="stand"/><child link="r1"/><origin xyz="0 -0.2 0.1"/><axis xyz="0 1 0"/></joint>
<joint name="e" type="revolute"><parent link="r1"/><child link="r2"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="1" velocity="1"/><mimic joint="a" multiplier="2" offset="0.25"/></joint>
</robot>)";

/// The robot with texts in place of others.
std::string changed(std::initializer_list<std::pair<std::string, std::string>> edits) {
  std::string text = kRobot;
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  }
  return text;
}

/// The largest difference of where common links are, from the first of them on, at random values
/// of the joints.
double apart(const robot::Robot& a, const robot::Robot& b) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> values(-1, 1);
  double out = 0;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> qa(a.variables.size()), qb(b.variables.size());
    for (double& q : qa) q = values(random);
    for (std::size_t y = 0; y < qb.size(); ++y) {
      const auto same = [&](const robot::Variable& x) { return x.name == b.variables[y].name; };
      const auto x = std::ranges::find_if(a.variables, same);
      qb[y] = x == a.variables.end() ? values(random) : qa[x - a.variables.begin()];
    }
    const auto pa = robot::forward(a, qa), pb = robot::forward(b, qb);
    std::optional<std::pair<std::size_t, std::size_t>> first;
    for (std::size_t x = 0; x < a.links.size(); ++x) {
      const auto y = b.find_link(a.links[x].name);
      if (!y) continue;
      if (!first) first = {x, *y};
      const auto from = [](const robot::Transform& f, const robot::Transform& t) {
        return geom::Vec3(f.linear.transpose() * (t * geom::Vec3(1, 2, 3) - f.translation));
      };
      out = std::max(out, (from(pa[first->first], pa[x]) - from(pb[first->second], pb[*y])).norm());
    }
  }
  return out;
}

std::optional<verify::FrameElsewhere> found(const std::string& text) {
  return verify::find_frame_elsewhere(robot::parse_urdf(kRobot, "original"),
                                      robot::parse_urdf(text, "result"), 1e-6);
}

TEST(FramesOfOthers, MoreLinksFewerAndRoundedNumbersAreTheSame) {
  const std::string whole = kRobot;
  // Without its base; with a world; with a hand; with rounded numbers; without a link in between.
  const std::string stand =
      changed({{R"(<link name="base"/>)", ""},
               {whole.substr(whole.find("<joint name=\"s\""),
                             whole.find("<joint name=\"a\"") - whole.find("<joint name=\"s\"")),
                ""}});
  const std::vector<std::string> same{
      whole, stand,
      changed(
          {{"</robot>",
            R"(<link name="world"/><joint name="w" type="fixed"><parent link="world"/><child link="base"/><origin xyz="9 0 0"/></joint></robot>)"}}),
      changed(
          {{"</robot>",
            R"(<link name="hand"/><joint name="w" type="continuous"><parent link="l3"/><child link="hand"/><axis xyz="0 0 1"/></joint></robot>)"}}),
      changed({{"0.3 0.2 0.1", "0.3000001 0.2 0.1"}, {"1 0 0\" rpy", "1.0000002 0 0\" rpy"}}),
      changed({{R"(<link name="l2"/>)", R"(<link name="between"/>)"},
               {R"(<child link="l2"/>)", R"(<child link="between"/>)"},
               {R"(<parent link="l2"/>)", R"(<parent link="between"/>)"}}),
      // No common link holds both arms.
      changed(
          {{R"(<link name="base"/><link name="stand"/>)", R"(<link name="x"/>)"},
           {whole.substr(whole.find("<joint name=\"s\""),
                         whole.find("<joint name=\"a\"") - whole.find("<joint name=\"s\"")),
            ""},
           {R"(<parent link="stand"/><child link="l1"/><origin xyz="0 0.2 0.1"/>)",
            R"(<parent link="x"/><child link="l1"/><origin xyz="0.40411488922561576 0.17551651237807455 0.35" rpy="0 0 0.5"/>)"},
           {R"(<parent link="stand"/><child link="r1"/><origin xyz="0 -0.2 0.1"/>)",
            R"(<parent link="x"/><child link="r1"/><origin xyz="0.59588510774208400 -0.17551651237807455 0.35" rpy="0 0 0.5"/>)"}})};
  for (const std::string& text : same) {
    const auto where = found(text);
    EXPECT_FALSE(where) << where->why << "\n" << text;
    EXPECT_LT(apart(robot::parse_urdf(kRobot, "a"), robot::parse_urdf(text, "b")), 2e-6) << text;
  }
}

TEST(FramesOfOthers, WhatMovesOtherwiseIsFoundAndNamed) {
  struct Mutant {
    std::string from, to, link, why;
  };
  const std::vector<Mutant> mutants{
      {"1 0 0\" rpy", "1.00001 0 0\" rpy", "l2", "a step beside joint 'b'"},
      {"0.3 0.2 0.1", "0.3 0.2 0.10001", "l2", "rad"},
      {"0.7 0 0", "0.8 0 0", "l3", "a step beside joint 'b'"},
      {"0.5 0 0.25", "0.6 0 0.25", "stand", "a fixed step"},
      {R"(<axis xyz="1 0 0"/>)", R"(<axis xyz="0 1 0"/>)", "l2", "joint 'b' has another axis"},
      {R"(<axis xyz="1 0 0"/>)", R"(<axis xyz="-1 0 0"/>)", "l2", "joint 'b' has another axis"},
      {R"("b" type="prismatic")", R"("b" type="revolute")", "l2", "joint 'b' is of another type"},
      {R"("b" type="prismatic")", R"("b" type="fixed")", "l2", "joint 'b' does not move it"},
      {R"("c" type="fixed")", R"("c" type="continuous")", "l3", "joint 'c' moves it besides"},
      {R"(multiplier="2")", R"(multiplier="3")", "r2", "joint 'e' mimics"},
      {R"(offset="0.25")", R"(offset="0.5")", "r2", "joint 'e' mimics"},
      {R"(<mimic joint="a")", R"(<mimic joint="d")", "r2", "joint 'e' mimics"},
      {R"(<mimic joint="a" multiplier="2" offset="0.25"/>)", "", "r2", "joint 'e' mimics"},
      {R"(<parent link="r1"/>)", R"(<parent link="stand"/>)", "r2", "joint"}};
  for (const Mutant& m : mutants) {
    const std::string text = changed({{m.from, m.to}});
    const auto where = found(text);
    ASSERT_TRUE(where) << m.to;
    const robot::Robot original = robot::parse_urdf(kRobot, "a");
    EXPECT_EQ(original.links[where->link].name, m.link) << m.to;
    EXPECT_NE(where->why.find(m.why), std::string::npos) << m.to << ": " << where->why;
    // So it does, as configurations show.
    EXPECT_GT(apart(original, robot::parse_urdf(text, "b")), 1e-6) << m.to;
  }
}

// Where another root has the first link that both have, that link's own joint is compared.
TEST(FramesOfOthers, TheRootUnderAnotherName) {
  const auto renamed = [](const std::string& origin) {
    return changed({{R"(<link name="base"/>)", R"(<link name="world"/>)"},
                    {R"(<parent link="base"/>)", R"(<parent link="world"/>)"},
                    {"0.5 0 0.25", origin}});
  };
  EXPECT_FALSE(found(renamed("0.5 0 0.25")));
  const auto where = found(renamed("0.5 0 2.25"));
  ASSERT_TRUE(where);
  EXPECT_EQ(where->why.substr(0, 22), "a fixed step is 2 away");
}

}  // namespace
}  // namespace kaboum::test
