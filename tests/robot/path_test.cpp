#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/path.h>
#include <kaboum/robot/path_derivatives.h>

#include <cmath>
#include <random>

#include "robots.h"

namespace kaboum::test {
namespace {

std::string message(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

TEST(Path, CsvWithAndWithoutHeader) {
  const NamedPath a = parse_path_csv("# comment\nb, a\n1, 2 # more\n\n-3e-1,+4\n", "p");
  EXPECT_EQ(a.joints, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(a.waypoints, (Path{{1, 2}, {-0.3, 4}}));
  EXPECT_EQ(parse_path_csv("1 2\t3\r\n4 5 6", "p").waypoints, (Path{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(parse_path_csv(" joint a , joint b\n 1 , 2\r\n", "p").joints,
            (std::vector<std::string>{"joint a", "joint b"}));
  EXPECT_EQ(parse_path_csv("1;2\n3;4", "p").waypoints, (Path{{1, 2}, {3, 4}}));
}

TEST(Path, CsvAsOtherProgramsWriteIt) {
  const NamedPath a = parse_path_csv("\"joint a\", \"b\",\r\n\"1\",2,\r\n3,4\n", "p");
  EXPECT_EQ(a.joints, (std::vector<std::string>{"joint a", "b"}));
  EXPECT_EQ(a.waypoints, (Path{{1, 2}, {3, 4}}));
  EXPECT_EQ(parse_path_csv("1,\n2,\n", "p").waypoints, (Path{{1}, {2}}));
  for (const char* text : {"1,,\n", ",\n", ",,\n", "1,2,,\n", "\"1,2\n"})
    EXPECT_NE(message([&] { parse_path_csv(text, "p"); }).find("line 1"), std::string::npos)
        << text;
  EXPECT_NE(message([&] { parse_path_csv("1,2\n3,\n", "p"); }).find("line 2"), std::string::npos);
}

TEST(Path, TimesAreNoJoints) {
  Robot robot;
  robot.variables = {{"a", -1, 1}, {"T", {}, {}}};
  EXPECT_EQ(arrange({{"Time", "T", "a"}, {{9, 5, 1}}}, robot, "p"), (Path{{1, 5}}));
  EXPECT_EQ(time_columns({{"Time", "T", "a", "%time"}, {}}, robot),
            (std::vector<std::size_t>{0, 3}));
  EXPECT_TRUE(time_columns({{}, {{1, 2}}}, robot).empty());
  robot.variables[1].name = "time";
  EXPECT_EQ(arrange({{"time", "a"}, {{5, 1}}}, robot, "p"), (Path{{1, 5}}));
}

TEST(Path, JointsThatDoNotMove) {
  Robot robot;
  robot.variables = {{"a", -1, 1}, {"b", {}, {}}, {"c", {}, {}}};
  const FixedJoints fixed{{"b", 7}};
  EXPECT_EQ(arrange({{"c", "a"}, {{5, 1}}}, robot, "p", true, fixed), (Path{{1, 7, 5}}));
  EXPECT_EQ(arrange({{}, {{1, 5}}}, robot, "p", true, fixed), (Path{{1, 7, 5}}));
  EXPECT_EQ(arrange({{}, {{}}}, robot, "p", true, {{"a", 0}, {"b", 1}, {"c", 2}}),
            (Path{{0, 1, 2}}));
  EXPECT_THROW(arrange({{}, {{1, 2, 5}}}, robot, "p", true, fixed), Error);
  EXPECT_THROW(arrange({{"a", "b", "c"}, {{1, 2, 5}}}, robot, "p", true, fixed), Error);
  EXPECT_THROW(arrange({{"a", "c"}, {{1, 5}}}, robot, "p", true, {{"d", 7}}), Error);
  EXPECT_THROW(arrange({{"b", "c"}, {{1, 5}}}, robot, "p", true, {{"a", 2}}), Error);
}

TEST(Path, Json) {
  const NamedPath a = parse_path_json(R"({"joints": ["x"], "waypoints": [[1], [2.5]]})", "p");
  EXPECT_EQ(a.joints, (std::vector<std::string>{"x"}));
  EXPECT_EQ(a.waypoints, (Path{{1}, {2.5}}));
  EXPECT_EQ(parse_path_json("[[1, 2]]", "p").waypoints, (Path{{1, 2}}));
}

constexpr const char* kTrajectory =
    R"({"header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""},
  "joint_names": ["b", "a"], "points": [
    {"positions": [1, 2], "velocities": [0, 0], "time_from_start": {"sec": 0, "nanosec": 500000000}},
    {"positions": [3, 4], "velocities": [], "effort": [9, 9], "time_from_start": {"secs": 2, "nsecs": 250000000}},
    {"positions": [5, 6], "time_from_start": 3.5}]})";

TEST(Path, TrajectoriesOfRosMoveItAndCuRobo) {
  Robot robot;
  robot.variables = {{"a", {}, {}}, {"b", {}, {}}};
  const std::string plain = kTrajectory;
  const Path expected{{2, 1}, {4, 3}, {6, 5}};
  for (const std::string& text :
       {plain,
        "{\"joint_trajectory\": " + plain +
            ", \"multi_dof_joint_trajectory\": {\"joint_names\": [], \"points\": []}}",
        "{\"model_id\": \"arm\", \"trajectory\": [{\"joint_trajectory\": " + plain +
            "}], \"trajectory_start\": {}}",
        "{\"goal\": {\"trajectory\": " + plain + "}}"}) {
    const NamedPath path = parse_path_json(text, "p");
    EXPECT_EQ(arrange(path, robot, "p"), expected) << text;
    EXPECT_EQ(times_of(path, robot), (std::vector<double>{0.5, 2.25, 3.5}));
    EXPECT_TRUE(path.notes.empty());
  }
  const NamedPath rows = parse_path_json(
      R"({"position": [[[1, 2], [3, 4]]], "joint_names": ["b", "a"], "interpolation_dt": 0.25})",
      "p");
  EXPECT_EQ(arrange(rows, robot, "p"), (Path{{2, 1}, {4, 3}}));
  EXPECT_EQ(times_of(rows, robot), (std::vector<double>{0, 0.25}));
  EXPECT_EQ(parse_path_json(R"({"positions": [[1, 2], [3, 4]]})", "p").waypoints,
            (Path{{1, 2}, {3, 4}}));
  EXPECT_EQ(parse_path_json(R"({"name": ["x"], "position": [1]})", "p").waypoints, (Path{{1}}));
  // Derivatives, as many as there are joints, are those of their point.
  PathDerivatives spline;
  parse_path_json(
      R"({"joint_names": ["a", "b"], "points": [
        {"positions": [1, 2], "velocities": [0.5, 1], "accelerations": [3, 4], "time_from_start": 0},
        {"positions": [1, 2], "velocities": [0.5], "accelerations": [3, "x"], "time_from_start": 1},
        {"positions": [1, 2], "time_from_start": 2}]})",
      "p", spline);
  EXPECT_EQ(spline.velocities, (Path{{0.5, 1}, {}, {}}));
  EXPECT_EQ(spline.accelerations, (Path{{3, 4}, {}, {}}));
  // Times that are all the same are none.
  EXPECT_TRUE(times_of(parse_path_json(R"({"joint_names": ["a"], "points": [
      {"positions": [1], "time_from_start": 0}, {"positions": [2], "time_from_start": 0}]})",
                                       "p"),
                       robot)
                  .empty());
}

TEST(Path, TrajectoriesThatMeanSomethingElseAreRefused) {
  Robot robot;
  robot.variables = {{"a", {}, {}}, {"b", {}, {}}};
  const auto refused = [&](const std::string& text) {
    return message([&] { arrange(parse_path_json(text, "p.json"), robot, "p.json"); });
  };
  const auto point = [](const std::string& members) {
    return R"({"joint_names": ["a", "b"], "points": [{"positions": [0, 0]}, {)" + members + "}]}";
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {R"({"points": [{"positions": [1]}]})", "no \"joint_names\""},
      {R"({"joint_names": ["a"], "points": []})", "points: no points"},
      {R"({"joint_names": "a", "points": [{"positions": [1]}]})",
       "joint_names: not a list of names"},
      {point(R"("positions": [0])"), "points: point 2, positions: 1 numbers instead of 2"},
      {point(R"("velocities": [0, 0])"), "points: point 2: no \"positions\""},
      {point(R"("positions": [0, "..."])"), "with all of its values"},
      {point(R"("positions": [0, null])"), "point 2, positions: not a list of numbers"},
      {point(R"("positions": [0, 0], "time_from_start": 1)"), "some points have"},
      {R"({"joint_names": ["a", "c"], "points": [{"positions": [1, 2]}]})",
       "joint_names: the robot has no joint 'c'"},
      {R"({"joint_names": ["a"], "points": [{"positions": [1]}]})",
       "joint_names: no column for joint 'b'"},
      {R"({"joint_names": ["a", "a"], "points": [{"positions": [1, 2]}]})", "'a' is named twice"},
      {R"({"joint_names": ["a", "b"], "points": [{"positions": [1, 2], "time_from_start": 2},
          {"positions": [1, 2], "time_from_start": 1}]})",
       "waypoint 2, column 3: time_from_start 1 is before 2"},
      {R"({"trajectory": [{"points": []}, {"points": []}]})", "trajectory: 2 trajectories"},
      {R"({"joint_trajectory": {"joint_names": [], "points": []},
          "multi_dof_joint_trajectory": {"joint_names": ["base"], "points": [{}]}})",
       "several degrees of freedom"},
      {R"({"position": [[[1, 2]], [[1, 2]]], "joint_names": ["a", "b"]})",
       "position: 2 trajectories"},
      {R"({"position": [[1, 2]], "dt": 0.1})", "dt: a time, but no \"joint_names\""},
      {R"({"position": [[1, 2]], "joint_names": ["a", "b"], "dt": -0.1})",
       "dt: a number of seconds above 0"},
      {R"({"joint_names": ["a", "b"], "points": [{"positions": [1, 2], "time_from_start": {"sec": "x"}}]})",
       "time_from_start: a number of seconds"}};
  for (const auto& [text, words] : cases)
    EXPECT_NE(refused(text).find(words), std::string::npos) << text << "\n" << refused(text);
  const NamedPath carried = parse_path_json(
      R"({"trajectory_start": {"attached_collision_objects": [{}]},
          "trajectory": [{"joint_trajectory": {"joint_names": ["a"], "points": [{"positions": [1]}]}}]})",
      "p");
  ASSERT_EQ(carried.notes.size(), 1);
  EXPECT_NE(carried.notes[0].find("WARNING"), std::string::npos);
}

TEST(Path, BadFilesAreRefusedByPlace) {
  const auto csv = [](const char* text) { return message([&] { parse_path_csv(text, "p.csv"); }); };
  EXPECT_NE(csv("1,2\n3\n").find("p.csv: line 2"), std::string::npos);
  EXPECT_NE(csv("1,2\n1 2,3 4\n").find("line 2: '3 4' is not a number"), std::string::npos);
  EXPECT_NE(csv("1,2\n3,x\n").find("line 2: 'x'"), std::string::npos);
  EXPECT_NE(csv("1,x\n").find("line 1"), std::string::npos);
  EXPECT_NE(csv("a,b\n").find("no waypoint"), std::string::npos);
  EXPECT_NE(csv("1,nan\n").find("not finite"), std::string::npos);
  EXPECT_NE(csv("1,1e999\n").find("1e999"), std::string::npos);
  EXPECT_NE(csv("1,,2\n").find("line 1"), std::string::npos);
  EXPECT_NE(csv("").find("no waypoint"), std::string::npos);
  const auto json = [](const std::string& text) {
    return message([&] { parse_path_json(text, "p.json"); });
  };
  EXPECT_NE(json("{").find("JSON"), std::string::npos);
  EXPECT_NE(json("{}").find("waypoints"), std::string::npos);
  EXPECT_NE(json("[1]").find("waypoint 1"), std::string::npos);
  EXPECT_NE(json("[[1], [1, 2]]").find("waypoint 2"), std::string::npos);
  EXPECT_NE(json("[[\"1\"]]").find("waypoint 1"), std::string::npos);
  EXPECT_NE(json(R"({"joints": [1], "waypoints": [[1]]})").find("names"), std::string::npos);
  EXPECT_NE(json(std::string(100000, '[')).find("lists and objects in each other"),
            std::string::npos);
}

TEST(Path, ColumnsFollowTheRobot) {
  Robot robot;
  robot.variables = {{"a", -1, 1}, {"b", {}, {}}};
  EXPECT_EQ(arrange({{"b", "a"}, {{5, 1}}}, robot, "p"), (Path{{1, 5}}));
  EXPECT_EQ(arrange({{}, {{0, 7}}}, robot, "p"), (Path{{0, 7}}));
  const auto bad = [&](const NamedPath& path) {
    return message([&] { arrange(path, robot, "p"); });
  };
  EXPECT_NE(bad({{"b"}, {{5}}}).find("'a'"), std::string::npos);
  EXPECT_NE(bad({{"a", "b", "c"}, {{1, 2, 3}}}).find("'c'"), std::string::npos);
  EXPECT_NE(bad({{"a", "a"}, {{1, 2}}}).find("twice"), std::string::npos);
  EXPECT_NE(bad({{}, {{1}}}).find("columns"), std::string::npos);
  EXPECT_NE(bad({{}, {{0, 0}, {2, 0}}}).find("waypoint 2: joint 'a'"), std::string::npos);
  EXPECT_EQ(arrange({{}, {{2, 0}}}, robot, "p", false), (Path{{2, 0}}));
}

TEST(Path, NamesInQuotationMarksMayBeNumbersAndHoldSeparators) {
  const NamedPath path = parse_path_csv("\"1\", \"a,b\",\"say \"\"x\"\" # 1\"\n1,2,3 # end\n", "p");
  ASSERT_EQ(path.joints, (std::vector<std::string>{"1", "a,b", "say \"x\" # 1"}));
  ASSERT_EQ(path.waypoints, (Path{{1, 2, 3}}));
  for (const std::string& name : path.joints) {
    const NamedPath read = parse_path_csv(csv_field(name) + ",other\n0,1\n", "p");
    EXPECT_EQ(read.joints, (std::vector<std::string>{name, "other"}));
  }
  EXPECT_EQ(csv_field("elbow_joint"), "elbow_joint");
  // Names that are numbers, without the marks: taken for a waypoint, they would move the robot.
  Robot robot;
  robot.variables = {{"1", {}, {}}, {"2", {}, {}}};
  EXPECT_THROW(arrange(parse_path_csv("1,2\n0.5,0.5\n", "p"), robot, "p"), Error);
  EXPECT_EQ(arrange(parse_path_csv("\"1\",\"2\"\n0.5,0.25\n", "p"), robot, "p"),
            (Path{{0.5, 0.25}}));
  EXPECT_EQ(arrange(parse_path_csv("\"2\",\"1\"\n1,2\n", "p"), robot, "p"), (Path{{2, 1}}));
}

// Degrees read back as the radians that they were made of, or next to them, and within the limits.
TEST(Degrees, ThereAndBack) {
  const Robot robot = parse_urdf(R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="turn" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <limit lower="-2.9" upper="3" effort="1" velocity="1"/></joint>
    <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)",
                                 "r.urdf");
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> from(-2.9, 3);
  Path path{{-2.9, -1}, {3, 1}, {0, 0}, {std::nextafter(3.0, 0), 0.5}};
  for (int i = 0; i < 2000; ++i) path.push_back({from(random), 0.25});
  const Path there = to_degrees(path, robot), back = from_degrees(there, robot);
  std::size_t same = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(there[i][1], path[i][1]);
    EXPECT_NEAR(back[i][0], path[i][0], 2e-15 * std::abs(path[i][0]));
    EXPECT_TRUE(back[i][0] >= -2.9 && back[i][0] <= 3);
    same += back[i] == path[i] ? 1 : 0;
  }
  EXPECT_GT(same, path.size() / 2);
  // Plain numbers stay plain.
  const Path plain{{60, 0}, {-123.4, 0}, {0.001, 0}};
  EXPECT_EQ(to_degrees(from_degrees(plain, robot), robot), plain);
}

}  // namespace
}  // namespace kaboum::test
