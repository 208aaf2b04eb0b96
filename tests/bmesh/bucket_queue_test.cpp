#include "bucket_queue.h"

#include <gtest/gtest.h>

#include <random>

namespace {

using kaboum::bmesh::BucketQueue;

BucketQueue::Entry entry(std::uint32_t a) { return {a, a + 1, 0}; }

TEST(BucketQueue, PopsInOrderWithinOnePercent) {
  BucketQueue queue;
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> exponent(-30, 30);
  std::vector<double> keys;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    keys.push_back(std::pow(10.0, exponent(random)));
    queue.push(keys.back(), entry(i));
  }
  BucketQueue::Entry e;
  double last = 0;
  std::size_t n = 0;
  while (queue.pop(e)) {
    EXPECT_GE(keys[e.a], last * 0.99);
    last = std::max(last, keys[e.a]);
    ++n;
  }
  EXPECT_EQ(n, keys.size());
}

TEST(BucketQueue, TakesExtremeKeys) {
  BucketQueue queue;
  queue.push(std::numeric_limits<double>::quiet_NaN(), entry(5));
  queue.push(std::numeric_limits<double>::infinity(), entry(4));
  queue.push(1e300, entry(3));
  queue.push(0, entry(0));
  queue.push(-0.0, entry(0));
  queue.push(1e-300, entry(0));
  BucketQueue::Entry e;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(queue.pop(e));
    EXPECT_EQ(e.a, 0U);
  }
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(queue.pop(e));
    EXPECT_GE(e.a, 3U);
  }
  EXPECT_FALSE(queue.pop(e));
}

TEST(BucketQueue, ReusesAndPurges) {
  BucketQueue queue;
  for (std::uint32_t i = 0; i < 1000; ++i) queue.push(i, entry(i));
  queue.purge([](const BucketQueue::Entry& e) { return e.a % 2 == 0; });
  EXPECT_EQ(queue.size(), 500U);
  BucketQueue::Entry e;
  while (queue.pop(e)) EXPECT_EQ(e.a % 2, 1U);
  queue.push(3, entry(7));  // below the position reached
  ASSERT_TRUE(queue.pop(e));
  EXPECT_EQ(e.a, 7U);
  EXPECT_TRUE(queue.due(3));
  EXPECT_FALSE(queue.due(4));
}

}  // namespace
