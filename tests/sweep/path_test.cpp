#include <gtest/gtest.h>
#include <kaboum/geom/error.h>
#include <kaboum/sweep/path.h>

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

TEST(Path, Json) {
  const NamedPath a = parse_path_json(R"({"joints": ["x"], "waypoints": [[1], [2.5]]})", "p");
  EXPECT_EQ(a.joints, (std::vector<std::string>{"x"}));
  EXPECT_EQ(a.waypoints, (Path{{1}, {2.5}}));
  EXPECT_EQ(parse_path_json("[[1, 2]]", "p").waypoints, (Path{{1, 2}}));
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
  EXPECT_NE(json(std::string(100000, '[')).find("JSON"), std::string::npos);
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

}  // namespace
}  // namespace kaboum::test
