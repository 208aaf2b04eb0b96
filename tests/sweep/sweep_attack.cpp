#include <cstdio>
#include <cstdlib>

#include "sampling.h"

/// Samples points of robots at configurations of random motions and looks for any that the bounding
/// swept volume misses. Arguments: motions (1000), samples (10 000 000), in all. Exit code 1 when
/// one is missed.
int main(int argc, char** argv) {
  using namespace kaboum::test;
  const long motions = argc > 1 ? std::atol(argv[1]) : 1000;
  const long samples = argc > 2 ? std::atol(argv[2]) : 10'000'000;
  const std::vector<TestRobot> robots = test_robots();
  const auto count = static_cast<long>(robots.size());
  std::mt19937_64 random(1);
  std::size_t tested = 0, missed = 0;
  for (const TestRobot& r : robots) {
    Missed sum;
    std::size_t bodies = 0;
    double closest = 0;
    for (long m = 0; m < motions / count; ++m) {
      const Path path =
          random_path(r.robot, random, 2 + static_cast<std::size_t>(m % 3), 2.5, m % 2 == 0);
      SweepOptions options;
      options.epsilon = m % 5 == 0 ? 0.05 : 0.005;
      if (m % 4 == 3) options.rule = StepRule::Adaptive;
      const SweepResult result = swept_volume(r.robot, r.bodies, path, options);
      bodies += result.set.bodies.size();
      if (m % 20 == 0 && find_bad_hull(r, result)) {
        std::printf("%s: a hull is wrong\n", r.name.c_str());
        return 1;
      }
      const Missed one =
          sample_points(r, path, result, random, static_cast<std::size_t>(samples / motions));
      sum.tested += one.tested;
      sum.missed += one.missed;
      closest = std::max(closest, one.largest / margin_of(result.set).value());
    }
    std::printf("%s: %zu points, %zu missed; largest distance %.4f of the margin; %zu bodies\n",
                r.name.c_str(), sum.tested, sum.missed, closest, bodies);
    tested += sum.tested;
    missed += sum.missed;
  }
  std::printf("%zu points of %zu robots, %zu missed\n", tested, robots.size(), missed);
  return missed == 0 ? 0 : 1;
}
