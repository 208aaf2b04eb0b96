#include <kaboum/base/parse_length.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/sweep/sweep.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>

#include "common/cli.h"

/// Times bounding swept volumes of a robot whose bodies are in memory, and counts bodies by rule.
/// Arguments: the robot's file, the epsilon of its bodies (3%), the most vertices of each (64).
namespace {

using namespace kaboum;

struct Times {
  double wall, processor;  // seconds
};

Times seconds_of(const robot::Robot& robot, const std::vector<robot::LinkBody>& bodies,
                 const robot::Path& path, const sweep::SweepOptions& options,
                 sweep::SweepResult& result) {
  std::vector<double> wall, processor;
  for (int run = 0; run < 101; ++run) {
    const std::clock_t before = std::clock();
    const auto start = std::chrono::steady_clock::now();
    result = sweep::swept_volume(robot, bodies, path, options);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    processor.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
  }
  // The median of the processor's time; of the wall's, which other programs only lengthen, the
  // fastest tenth.
  std::nth_element(processor.begin(), processor.begin() + 50, processor.end());
  std::nth_element(wall.begin(), wall.begin() + 10, wall.end());
  return {wall[10], processor[50]};
}

int measure(const char* file, const char* epsilon, int most_vertices) {
  const robot::RobotFile robot = robot::read_robot(file);
  certify::RobotRequest request;
  request.set.epsilon = parse_length(epsilon);
  request.set.max_vertices = static_cast<std::size_t>(most_vertices);
  request.set.effort = bcd::Effort::Fast;
  const certify::CertifiedBodies links = certify::certify_bodies(robot, request);
  std::size_t points = 0;
  for (const robot::LinkBody& body : links.artefact()) points += body.points.size();
  std::printf("%s: %zu bodies with %zu vertices\n", file, links.artefact().size(), points);
  const std::size_t joints = robot.robot.variables.size();
  const robot::Path path{std::vector<double>(joints, 0), std::vector<double>(joints, 1)};
  sweep::SweepOptions options;
  options.epsilon = 0.005;
  sweep::SweepResult result;
  for (const std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Times times = seconds_of(robot.robot, links.artefact(), path, options, result);
    std::printf(
        "all joints 1 rad, epsilon 5 mm, %zu threads: %.2f ms, %.2f ms of processors; %zu "
        "bodies, reach %.4f\n",
        threads, 1000 * times.wall, 1000 * times.processor, result.set.bodies.size(),
        result.excess);
  }
  const std::pair<const char*, sweep::StepRule> rules[] = {
      {"uniform", sweep::StepRule::Uniform},
      {"subset", sweep::StepRule::Subset},
      {"second-order", sweep::StepRule::SecondOrder},
      {"adaptive", sweep::StepRule::Adaptive},
      {"balanced", sweep::StepRule::Balanced}};
  double uniform = 0;
  for (const auto& [name, rule] : rules) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> value(-1.2, 1.2);
    options.rule = rule;
    double bodies = 0;
    for (int motion = 0; motion < 60; ++motion) {
      robot::Path random_path(2, std::vector<double>(joints));
      for (std::size_t i = 0; i < joints; ++i) {
        random_path[0][i] = value(random);
        random_path[1][i] =
            motion % 2 == 0 && random() % 2 == 0 ? random_path[0][i] : value(random);
      }
      bodies += static_cast<double>(
          sweep::swept_volume(robot.robot, links.artefact(), random_path, options)
              .set.bodies.size());
    }
    if (uniform == 0) uniform = bodies;
    std::printf("60 random motions, %s: %.1f bodies each, %.2f times fewer than uniform\n", name,
                bodies / 60, uniform / bodies);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: sweep-benchmark ROBOT [EPSILON [VERTICES]]\n");
    return 2;
  }
  try {
    return measure(argv[1], argc > 2 ? argv[2] : "3%", argc > 3 ? std::stoi(argv[3]) : 64);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sweep-benchmark: %s\n", error.what());
    return 1;
  }
}
