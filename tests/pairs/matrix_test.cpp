// Matrices of allowed collisions: every format, every fault, and what is taken out.

#include <gtest/gtest.h>
#include <kaboum/pairs/matrix.h>

#include <algorithm>

namespace kaboum::pairs {
namespace {

/// A chain of links a, b, c, d: all pairs but a–c, a–d and b–d are adjacent.
robot::Robot chain() {
  robot::Robot out;
  out.name = "chain";
  for (const char* name : {"a", "b", "c", "d"}) out.links.push_back({name, {}, {}});
  for (std::uint32_t i = 0; i < 3; ++i) {
    robot::Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.type = robot::JointType::Revolute;
    joint.parent = i;
    joint.variable = i;
    out.joints.push_back(joint);
    out.variables.push_back({joint.name, -1.0, 1.0});
  }
  return out;
}

DecidedPair decided(std::uint32_t a, std::uint32_t b, Verdict verdict,
                    Relation relation = Relation::Moving) {
  DecidedPair out;
  out.a = a;
  out.b = b;
  out.verdict = verdict;
  out.relation = relation;
  out.q = {0, 0.5, 0};
  return out;
}

DecidedPair at_joint(std::optional<Verdict> away, Verdict verdict = Verdict::CanTouch) {
  DecidedPair out = decided(0, 1, verdict, Relation::Adjacent);
  if (away) out.away = AwayFromJoint{0.1, *away, {}, {0.7, 0, 0}};
  return out;
}

std::vector<DecidedPair> all() {
  return {at_joint(Verdict::Never), decided(0, 2, Verdict::Never), decided(0, 3, Verdict::CanTouch),
          decided(1, 3, Verdict::Open)};
}

std::string pairs_of(const Matrix& matrix) {
  std::string out;
  for (const DisabledPair& pair : matrix.pairs)
    out += pair.a + pair.b + std::to_string(pair.line) + " ";
  return out;
}

std::string faults_of(const Matrix& matrix) {
  std::string out;
  for (const MatrixFault& fault : matrix.faults)
    out += std::string(name_of(fault.kind)) + std::to_string(fault.line) + " ";
  return out;
}

const char* const kSrdf = R"(<?xml version="1.0"?>
<!-- <disable_collisions link1="x" link2="y"/> is a comment -->
<robot name="chain">
  <!-- the wrist -->
  <disable_collisions link1="a" link2="c" reason="Never"/>
  <disable_collisions link1="d" link2="a" reason="Never"></disable_collisions>  <!-- kept -->
  <disable_collisions
      link1='b' link2="d" reason="Never"/>
  <disable_collisions link1="a" link2="b" reason="Adjacent"/>
</robot>
)";

TEST(Matrix, SrdfIsJudgedAndOnlyWhatIsRefutedIsTakenOut) {
  const robot::Robot robot = chain();
  const Matrix matrix = parse_matrix(kSrdf, "m", robot);
  EXPECT_EQ(matrix.format, MatrixFormat::Srdf);
  EXPECT_EQ(pairs_of(matrix), "ac5 da6 bd7 ab9 ");
  EXPECT_EQ(faults_of(matrix), "");
  const std::vector<JudgedPair> judged = judge(matrix, robot, all());
  ASSERT_EQ(judged.size(), 4U);
  EXPECT_EQ(judged[0].judgement, Judgement::Proved);
  EXPECT_EQ(judged[1].judgement, Judgement::Refuted);
  EXPECT_EQ(judged[2].judgement, Judgement::Open);
  EXPECT_EQ(judged[3].judgement, Judgement::Connected);
  std::string wanted = kSrdf;
  const std::string gone =
      R"(<disable_collisions link1="d" link2="a" reason="Never"></disable_collisions>)";
  wanted.erase(wanted.find(gone), gone.size());
  EXPECT_EQ(corrected(matrix, judged, robot), wanted);
}

TEST(Matrix, AStatementAloneOnItsLineIsTakenOutWithIt) {
  const robot::Robot robot = chain();
  const std::string text =
      "<robot name=\"r\">\n  <disable_collisions link1=\"a\" link2=\"d\"/>\n</robot>\n";
  const Matrix matrix = parse_matrix(text, "m", robot);
  EXPECT_EQ(corrected(matrix, judge(matrix, robot, all()), robot),
            "<robot name=\"r\">\n</robot>\n");
}

TEST(Matrix, AContactAtAJointIsAcceptedOnlyWhereNoneIsAwayFromIt) {
  const robot::Robot robot = chain();
  const Matrix matrix =
      parse_matrix("<robot name='r'><disable_collisions link1='a' link2='b'/></robot>", "m", robot);
  const auto judged = [&](const DecidedPair& pair) {
    return judge(matrix, robot, {pair}).front().judgement;
  };
  EXPECT_EQ(judged(at_joint(Verdict::Never)), Judgement::Connected);
  EXPECT_EQ(judged(at_joint(Verdict::Open)), Judgement::Open);
  EXPECT_EQ(judged(at_joint(std::nullopt)), Judgement::Open);
  EXPECT_EQ(judged(at_joint(std::nullopt, Verdict::Always)), Judgement::Open);
  EXPECT_EQ(judged(at_joint(std::nullopt, Verdict::Never)), Judgement::Proved);
  EXPECT_EQ(judged(at_joint(Verdict::Always, Verdict::Always)), Judgement::Always);
  EXPECT_EQ(judged(at_joint(Verdict::CanTouch)), Judgement::Refuted);
  EXPECT_EQ(judge(matrix, robot, {at_joint(Verdict::CanTouch)}).front().q.front(), 0.7);
  EXPECT_EQ(judged(decided(0, 1, Verdict::CanTouch, Relation::Fixed)), Judgement::Connected);
}

TEST(Matrix, FaultsHaveTheirLines) {
  const Matrix matrix = parse_matrix(R"(<robot name="r">
<disable_collisions link1="a" link2="c" reason="Never"/>
<disable_collisions link1="c" link2="a" reason="Never"/>
<disable_collisions link1="a" link2="c" reason="Adjacent"/>
<disable_collisions link1="a" link2="e" reason="Never"/>
<disable_collisions link1="b" link2="b" reason="Never"/>
<disable_collisions link1="b" link2="d" reason="Never"/>
<enable_collisions link1="b" link2="d"/>
</robot>)",
                                     "m", chain());
  EXPECT_EQ(faults_of(matrix), "doubled3 contradicting4 unknown-link5 same-link6 contradicting7 ");
  EXPECT_EQ(pairs_of(matrix), "ac2 bd7 ");
}

TEST(Matrix, StatementsThatChangeNothingAreTakenOut) {
  const robot::Robot robot = chain();
  const auto after = [&](const std::string& text) {
    const Matrix matrix = parse_matrix(text, "m", robot);
    return corrected(matrix, judge(matrix, robot, all()), robot);
  };
  EXPECT_EQ(after(R"(<robot name="r">
<disable_collisions link1="a" link2="c" reason="Never"/>
<disable_collisions link1="c" link2="a" reason="Never"/>
<disable_collisions link1="a" link2="c" reason="Adjacent"/>
<disable_collisions link1="a" link2="e" reason="Never"/> <!-- kept -->
<disable_collisions link1="e" link2="f" reason="Never"/>
<enable_collisions link1="e" link2="b"/>
<disable_collisions link1="b" link2="b" reason="Never"/>
</robot>)"),
            R"(<robot name="r">
<disable_collisions link1="a" link2="c" reason="Never"/>
 <!-- kept -->
</robot>)");
  EXPECT_EQ(after("<mujoco><contact><exclude body1='a' body2='c'/><exclude body1='a' body2='e'/>"
                  "</contact></mujoco>"),
            "<mujoco><contact><exclude body1='a' body2='c'/></contact></mujoco>");
#ifdef KABOUM_HAS_YAML
  EXPECT_EQ(after("self_collision_ignore:\n  a: [c, e, c, d]\n"),
            "self_collision_ignore:\n  a: [c, ]\n");
#endif
}

TEST(Matrix, DefaultsAreExceptedByEnabledPairs) {
  const robot::Robot robot = chain();
  const std::string text = R"(<robot name="r">
  <disable_default_collisions link="a"/>
  <enable_collisions link1="a" link2="c"/>
</robot>
)";
  const Matrix matrix = parse_matrix(text, "m", robot);
  EXPECT_EQ(pairs_of(matrix), "ab2 ad2 ");
  EXPECT_EQ(faults_of(matrix), "");
  const std::string out = corrected(matrix, judge(matrix, robot, all()), robot);
  EXPECT_NE(out.find("  <enable_collisions link1=\"a\" link2=\"d\"/>\n</robot>"), std::string::npos)
      << out;
  EXPECT_EQ(pairs_of(parse_matrix(out, "m", robot)), "ab2 ");
}

TEST(Matrix, MjcfExcludes) {
  const robot::Robot robot = chain();
  const Matrix matrix = parse_matrix(R"(<mujoco>
  <contact>
    <exclude body1="a" body2="d"/>
    <exclude body1="a" body2="c"/>
  </contact>
</mujoco>)",
                                     "m", robot);
  EXPECT_EQ(matrix.format, MatrixFormat::Mjcf);
  EXPECT_EQ(pairs_of(matrix), "ad3 ac4 ");
  EXPECT_EQ(corrected(matrix, judge(matrix, robot, all()), robot).find("body2=\"d\""),
            std::string::npos);
}

TEST(Matrix, DrakesGroupsAreExpandedAndEmptyOnesNamed) {
  const robot::Robot robot = chain();
  const Matrix matrix = parse_matrix(R"(<robot name="r">
  <drake:collision_filter_group name="base">
    <drake:member link="a"/>
    <drake:ignored_collision_filter_group name="wrist"/>
    <drake:ignored_collision_filter_group name="absent"/>
  </drake:collision_filter_group>
  <drake:collision_filter_group name="wrist">
    <drake:member_group name="tip"/>
    <drake:member link="c"/>
  </drake:collision_filter_group>
  <drake:collision_filter_group name="tip">
    <drake:member link="d"/>
  </drake:collision_filter_group>
  <drake:collision_filter_group name="nothing">
  </drake:collision_filter_group>
</robot>)",
                                     "m", robot);
  EXPECT_EQ(matrix.format, MatrixFormat::Drake);
  EXPECT_EQ(pairs_of(matrix), "ac4 ad4 ");
  EXPECT_EQ(faults_of(matrix), "empty-group5 empty-group14 ");
  EXPECT_ANY_THROW(corrected(matrix, judge(matrix, robot, all()), robot));
}

TEST(Matrix, EveryStatementOfARefutedPairIsTakenOut) {
  const robot::Robot robot = chain();
  const auto after = [&](const std::string& text) {
    const Matrix matrix = parse_matrix(text, "m", robot);
    const std::string out = corrected(matrix, judge(matrix, robot, all()), robot);
    return pairs_of(parse_matrix(out, "m", robot)) + faults_of(parse_matrix(out, "m", robot));
  };
  EXPECT_EQ(after(R"(<robot name="r">
<disable_collisions link1="a" link2="d"/>
<disable_collisions link1="a" link2="c"/>
<disable_collisions link1="d" link2="a"/>
</robot>)"),
            "ac2 ");
  EXPECT_EQ(after(R"(<robot name="r">
<disable_default_collisions link="a"/>
<disable_collisions link1="a" link2="d"/>
</robot>)"),
            "ab2 ac2 ");
  EXPECT_EQ(after(R"(<robot name="r">
<disable_default_collisions link="a"/>
<disable_default_collisions link="d"/>
</robot>)"),
            "ab2 ac2 db3 dc3 ");
  EXPECT_EQ(after(R"(<robot name="r">
<disable_default_collisions link="a"/>
<disable_collisions link1="a" link2="d"/>
<enable_collisions link1="a" link2="d"/>
</robot>)"),
            "ab2 ac2 ");
  EXPECT_EQ(after(R"(<mujoco><contact>
<exclude body1="a" body2="d"/>
<exclude body1="d" body2="a"/>
</contact></mujoco>)"),
            "");
#ifdef KABOUM_HAS_YAML
  EXPECT_EQ(after("self_collision_ignore:\n  a: [d, c]\n  d: [a]\n"), "ac2 empty-group3 ");
  EXPECT_EQ(after("self_collision_ignore:\n  a: [d, c, d]\n"), "ac2 ");
  EXPECT_EQ(after("self_collision_ignore: {a: [d, d]}\n"), "empty-group1 ");
  // Two lists that are one text: the second pair cannot be kept.
  EXPECT_ANY_THROW(after("self_collision_ignore:\n  a: &x [d]\n  b: *x\n"));
#endif
}

#ifdef KABOUM_HAS_YAML
TEST(Matrix, YamlOfBothKindsKeepsItsComments) {
  const robot::Robot robot = chain();
  const std::string curobo = R"(robot_cfg:
  kinematics:
    # not checked
    self_collision_ignore: {
      "a": ["b", "d", "c"],  # base
      "b": ["d"],
    }
)";
  Matrix matrix = parse_matrix(curobo, "m", robot);
  EXPECT_EQ(matrix.format, MatrixFormat::Curobo);
  EXPECT_EQ(pairs_of(matrix), "ab5 ad5 ac5 bd6 ");
  std::string out = corrected(matrix, judge(matrix, robot, all()), robot);
  EXPECT_NE(out.find("\"a\": [\"b\", \"c\"],  # base"), std::string::npos) << out;
  EXPECT_NE(out.find("# not checked"), std::string::npos);
  const std::string xrdf = R"(format: xrdf
self_collision:
  geometry: g
  ignore:
    a:
      - d  # never
      - c
)";
  matrix = parse_matrix(xrdf, "m", robot);
  EXPECT_EQ(matrix.format, MatrixFormat::Xrdf);
  EXPECT_EQ(pairs_of(matrix), "ad6 ac7 ");
  out = corrected(matrix, judge(matrix, robot, all()), robot);
  EXPECT_NE(out.find("    a:\n      - c\n"), std::string::npos) << out;
}
#endif

TEST(Matrix, WhatIsNoneIsRefused) {
  for (const char* text :
       {"", "<robot", "<robot><disable_collisions link1=\"a\"/></robot>", "<a/>", "<robot></a>",
        "<robot><disable_collisions link1=a link2=\"b\"/></robot>", "x: 1",
        "<robot><!-- no end </robot>", "<robot><xacro:include filename=\"f\"/></robot>",
        "self_collision_ignore: [1]", "self_collision_ignore: {a: b}"})
    EXPECT_ANY_THROW(parse_matrix(text, "m", chain())) << text;
}

}  // namespace
}  // namespace kaboum::pairs
