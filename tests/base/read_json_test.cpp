#include <gtest/gtest.h>
#include <kaboum/base/read_json.h>

#include <nlohmann/json.hpp>

namespace kaboum {
namespace {

using nlohmann::json;

std::string message(const std::string& text) {
  try {
    read_json<json>(text, "a.json", "write it again");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "taken";
}

TEST(ReadJson, SaysWhatParsersSay) {
  const std::string text = R"({"a": [1, {"a": "}\"{", "b": {}}, {"a": null}], "b": 2.5})";
  EXPECT_EQ(read_json<json>(text, "", ""), json::parse(text));
  const auto ordered = read_json<nlohmann::ordered_json>(R"({"b": 1, "a": 2})", "", "");
  EXPECT_EQ(ordered.dump(), R"({"b":1,"a":2})");
}

TEST(ReadJson, MembersThatAreGivenTwiceAreRefusedWithTheirPlace) {
  const auto twice = [](const std::string& place, const std::string& name) {
    return "a.json: " + place + ": '" + name + "' is given twice; write it again";
  };
  EXPECT_EQ(message(R"({"a": 1, "a": 2})"), twice("line 1, column 10", "a"));
  EXPECT_EQ(message("{\"x\": [{\"a\": 1},\n  {\"b\": {\"a\": 2}, \"c\": 1,\n    \"b\" : 3}]}"),
            twice("line 3, column 5", "b"));
  EXPECT_EQ(message(R"({"a": {"a": 1}, "a": 2})"), twice("line 1, column 17", "a"));
  // However it is written.
  EXPECT_EQ(message(R"({"a\"b": 1, "\u0061\u0022b": 2})"), twice("line 1, column 13", "a\"b"));
  EXPECT_EQ(message(R"({"": 1, "": 2})"), twice("line 1, column 9", ""));
  EXPECT_EQ(message(R"({"a": {"x": 1}, "b": {"x": 1}, "c": [{"x": 1}, {"x": 1}]})"), "taken");
}

TEST(ReadJson, AnObjectOfManyMembersKeepsTheirOrder) {
  // In a time that is square in their number this would not end.
  constexpr int kMembers = 150'000;
  std::string text = "{";
  for (int i = kMembers; i > 0; --i)
    text += (i < kMembers ? ",\"" : "\"") + std::to_string(i) + "\":" + std::to_string(i);
  const auto read = read_json<nlohmann::ordered_json>(text + "}", "", "");
  ASSERT_EQ(read.size(), static_cast<std::size_t>(kMembers));
  int next = kMembers;
  for (const auto& [key, value] : read.items()) {
    ASSERT_EQ(key, std::to_string(next));
    ASSERT_EQ(value, next--);
  }
  EXPECT_EQ(message(text + ",\"7\":0}").find("a.json: line 1, column "), 0U);
}

TEST(ReadJson, OtherDamageIsRefused) {
  EXPECT_EQ(message(""),
            "a.json: the JSON is cut short: it ends at line 1, column 1; write it again");
  EXPECT_EQ(message("[1, 1e999]"), "a.json: a number in it is out of range; write it again");
  EXPECT_EQ(message("[1]\n]"), "a.json: not JSON at line 2, column 1, near ']'; write it again");
  EXPECT_EQ(message(std::string(65, '[')),
            "a.json: more than 64 lists and objects in each other; write it again");
}

}  // namespace
}  // namespace kaboum
