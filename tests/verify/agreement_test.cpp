// verify_inclusion against the exact oracle.
#include <kaboum/verify/inclusion.h>

#include <gtest/gtest.h>

#include "judge.h"
#include "pairs.h"

namespace {

using namespace kaboum::test;  // NOLINT: a test

TEST(Agreement, LatticePairs) {
  Tally tally;
  for (std::uint64_t seed = 1000; seed < 1190 && tally.faults().empty(); ++seed)
    tally.judge(lattice_pair(seed), seed);
  EXPECT_EQ(tally.faults(), "");
  EXPECT_GE(tally.solid_true(), 100U);
  EXPECT_GE(tally.solid_false(), 100U);
}

TEST(Agreement, BentPairs) {
  Tally tally;
  for (std::uint64_t seed = 2000; seed < 2012 && tally.faults().empty(); ++seed)
    tally.judge(bent_pair(seed), seed);
  EXPECT_EQ(tally.faults(), "");
}

TEST(Agreement, OpenPairs) {
  Tally tally;
  for (std::uint64_t seed = 3000; seed < 3060 && tally.faults().empty(); ++seed)
    tally.judge(open_pair(seed), seed);
  EXPECT_EQ(tally.faults(), "");
  EXPECT_GE(tally.difference_true(), 10U);
  EXPECT_GE(tally.difference_false(), 10U);
}

}  // namespace
