#pragma once

#include <kaboum/world/scene.h>

#include <random>

#include "exact_scene.h"

namespace kaboum::test {

/// A robot among things, as its sets and as what these bound.
struct RandomScene {
  world::World world;
  ExactScene exact;
};

/// An arm of four links of half a length each, among `objects`
/// random hulls, every third of them a needle or a plate a thousandth thick. Sets are a hundredth
/// larger than what they bound.
RandomScene random_scene(std::uint32_t seed, int objects);

/// A configuration within the limits.
std::vector<double> random_values(const robot::Robot& robot, std::mt19937_64& random);

}  // namespace kaboum::test
