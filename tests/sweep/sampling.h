#pragma once

#include <kaboum/sweep/sweep.h>

#include "robots.h"

namespace kaboum::test {

using namespace kaboum::sweep;

/// Samples points of the bodies at configurations of the path and looks for those outside the set.
struct Missed {
  std::size_t tested = 0, missed = 0;
  double largest = 0;  ///< distance from the polytopes, without the margin
};
/// By default a sample is compared with the piece of its time; `anywhere`: with all hulls.
Missed sample_points(const TestRobot& robot, const Path& path, const SweepResult& result,
                     std::mt19937_64& random, std::size_t samples, bool anywhere = false);

/// The first hull that is not exactly convex, not in float32, or does not contain all images of
/// its body's points (rounded to float32), by exact predicates; nullopt when all are right.
std::optional<std::size_t> find_bad_hull(const TestRobot& robot, const SweepResult& result);

}  // namespace kaboum::test
