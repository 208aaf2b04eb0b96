// Loops by several threads: every index once, on any number of them; what is thrown arrives; a loop
// is not cut short by what is thrown elsewhere.
#include <kaboum/base/parallel.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace kaboum {
namespace {

TEST(Parallel, EveryIndexOnceOnAnyNumberOfThreads) {
  for (const std::size_t threads : {1U, 2U, 5U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (const std::size_t n : {0U, 1U, 2U, 7U, 1000U, 70000U}) {
      for (const LoopParts parts :
           {LoopParts{}, LoopParts{.grain = 64}, LoopParts{.alone = true}}) {
        std::vector<int> count(n, 0);  // no two calls have an index in common, or this is a race
        parallel_for(
            std::size_t{0}, n, [&](std::size_t i) { ++count[i]; }, parts);
        EXPECT_EQ(count, std::vector<int>(n, 1)) << n << " on " << threads;
      }
      std::vector<int> count(n, 0);
      parallel_for_light(n, [&](std::size_t i) { ++count[i]; });
      EXPECT_EQ(count, std::vector<int>(n, 1));
    }
  }
}

TEST(Parallel, FromAnyFirstIndex) {
  std::vector<int> seen(10, 0);
  parallel_for(3, 7, [&](int i) { seen[static_cast<std::size_t>(i)] = i; });
  EXPECT_EQ(seen, (std::vector<int>{0, 0, 0, 3, 4, 5, 6, 0, 0, 0}));
  parallel_for(7, 3, [&](int) { ADD_FAILURE(); });
}

TEST(Parallel, PartsAreNotSmallerThanTheGrain) {
  std::atomic<std::size_t> sum = 0, small = 0;
  parallel_ranges(100000, {.grain = 1000}, [&](std::size_t begin, std::size_t end) {
    sum += end - begin;
    small += end - begin < 500 ? 1 : 0;
  });
  EXPECT_EQ(sum, 100000U);
  EXPECT_LE(small, 1U);  // the last one
}

TEST(Parallel, WhatIsThrownByAThreadArrives) {
  for (const std::size_t threads : {1U, 3U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const auto loop = [] {
      parallel_for(0, 1000, [](int i) {
        if (i == 777) throw std::runtime_error("777");
      });
    };
    EXPECT_THROW(loop(), std::runtime_error);
    EXPECT_THROW(parallel_invoke([] {}, [] { throw std::logic_error("second"); }),
                 std::logic_error);
  }
}

// Where one task of a loop throws, loops that its siblings have begun go on to their ends.
TEST(Parallel, LoopsWithinAreDoneWhateverOtherThreadsThrow) {
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> cut_short = 0;
    const auto outer = [&] {
      parallel_for(0, 8,
                   [&](int i) {
                     if (i == 3) throw std::runtime_error("3");
                     std::atomic<int> done = 0;
                     parallel_for(0, 2000, [&](int) { ++done; });
                     if (done != 2000) ++cut_short;
                   },
                   {.alone = true});
    };
    EXPECT_THROW(outer(), std::runtime_error);
    EXPECT_EQ(cut_short, 0);
  }
}

}  // namespace
}  // namespace kaboum
