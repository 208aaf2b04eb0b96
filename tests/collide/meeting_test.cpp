/// Many boxes against one: vectors and a loop against the definition.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "meeting.h"

namespace kaboum::collide::detail {
namespace {

TEST(Meeting, BitsAreThoseOfBoxesThatMeet) {
  std::mt19937_64 random(1);
  // Few different numbers, so that many boxes touch.
  std::uniform_int_distribution<int> place(0, 8), size(0, 3);
  std::array<std::vector<float>, 6> rows;
  constexpr std::size_t kBoxes = 200;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < kBoxes; ++i) {
      rows[k].push_back(static_cast<float>(place(random)));
      rows[3 + k].push_back(rows[k].back() + static_cast<float>(size(random)));
    }
  // Behind the last one, numbers may be read.
  for (std::vector<float>& row : rows) row.resize(row.size() + kBoxesAtOnce);
  const BoxRows all{{rows[0].data(), rows[1].data(), rows[2].data()},
                    {rows[3].data(), rows[4].data(), rows[5].data()}};
  for (int trial = 0; trial < 300; ++trial) {
    FloatBox box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = static_cast<float>(place(random));
      box.high[k] = box.low[k] + static_cast<float>(size(random));
    }
    const auto count = static_cast<std::size_t>(trial % 65);
    const std::size_t from = static_cast<std::size_t>(trial) % (kBoxes - 64);
    std::uint64_t expected = 0;
    for (std::size_t j = 0; j < count; ++j) {
      bool meet = true;
      for (std::size_t k = 0; k < 3; ++k)
        meet = meet && rows[k][from + j] <= box.high[k] && rows[3 + k][from + j] >= box.low[k];
      if (meet) expected |= std::uint64_t{1} << j;
    }
    EXPECT_EQ(meeting_boxes(all, from, count, box, false), expected) << trial;
    if (has_avx2()) {
      EXPECT_EQ(meeting_boxes(all, from, count, box, true), expected) << trial;
    }
  }
}

}  // namespace
}  // namespace kaboum::collide::detail
