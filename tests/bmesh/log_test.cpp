#include <kaboum/base/error.h>
#include <kaboum/bmesh/log.h>

#include <gtest/gtest.h>

namespace {

using kaboum::Error;
using kaboum::bmesh::Direction;
using kaboum::bmesh::Log;
using kaboum::bmesh::parse_log;
using kaboum::bmesh::serialise_log;

Log sample() {
  Log log;
  log.direction = Direction::Inner;
  log.input_sha256 = std::string(64, 'a');
  log.tool = "test 1";
  log.dropped = {3, 9};
  log.reversed = {1};
  log.rims = {{0, 1, 5}, {1, 2, 5, 7}};
  log.reversed_after_filling = {1, 12};
  log.steps = {{1, 2, {0.1, -0.0, 1e300}}, {4, 4, {1, 2, 3}}};
  return log;
}

TEST(Log, SurvivesARoundTrip) {
  const Log log = sample();
  const Log back = parse_log(serialise_log(log), "log");
  EXPECT_EQ(back.direction, log.direction);
  EXPECT_EQ(back.input_sha256, log.input_sha256);
  EXPECT_EQ(back.tool, log.tool);
  EXPECT_EQ(back.dropped, log.dropped);
  EXPECT_EQ(back.reversed, log.reversed);
  EXPECT_EQ(back.rims, log.rims);
  EXPECT_EQ(back.reversed_after_filling, log.reversed_after_filling);
  ASSERT_EQ(back.steps.size(), 2U);
  EXPECT_EQ(back.steps[0].gone, 2U);
  EXPECT_EQ(back.steps[0].position, log.steps[0].position);
}

TEST(Log, RefusesEveryTruncationAndTrailingBytes) {
  std::vector<char> bytes = serialise_log(sample());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(parse_log(std::span(bytes).first(n), "log"), Error) << n;
  bytes.push_back(0);
  EXPECT_THROW(parse_log(bytes, "log"), Error);
}

TEST(Log, RefusesHugeCountsWithoutAllocating) {
  std::vector<char> bytes = serialise_log(Log{});
  // The last eight bytes are the number of steps.
  for (std::size_t i = bytes.size() - 8; i < bytes.size(); ++i) bytes[i] = '\x7f';
  EXPECT_THROW(parse_log(bytes, "log"), Error);
}

}  // namespace
