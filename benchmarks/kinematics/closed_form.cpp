// Closed-form inverse kinematics: time per pose, and round trips through the arm's own forward
// kinematics: closed-form-benchmark [ARMS [POSES]], of each family.
#include <kaboum/kinematics/redundant.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "arms.h"

namespace {

using namespace kaboum::test;

double seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Tally {
  std::size_t poses = 0, solutions = 0, recovered = 0, lost = 0;
  double time = 0, error = 0, joint_error = 0;
};

void run(const DhArm& dh, std::size_t poses, std::mt19937_64& random, Tally& tally) {
  const Arm arm = arm_of(dh);
  const auto form = recognise(arm);
  if (!form) {
    tally.lost += poses;
    return;
  }
  std::vector<std::vector<double>> q;
  std::vector<Transform> targets;
  std::vector<Solutions> found(poses);
  for (std::size_t i = 0; i < poses; ++i) {
    q.push_back(random_joints(random, arm.axes.size(), 3.141592653589793));
    targets.push_back(kaboum::kinematics::forward(arm, q.back()));
  }
  const double start = seconds();
  for (std::size_t i = 0; i < poses; ++i) found[i] = solve(*form, targets[i]);
  tally.time += seconds() - start;
  for (std::size_t i = 0; i < poses; ++i) {
    double nearest = 10;
    for (const Solution& s : found[i]) {
      const PoseError e = kaboum::kinematics::difference(
          kaboum::kinematics::forward(arm, {s.q.data(), q[i].size()}), targets[i]);
      tally.error = std::max(tally.error, e.position / form->reach + e.rotation);
      nearest = std::min(nearest, turn_distance(s.q.data(), q[i]));
    }
    tally.solutions += found[i].size();
    tally.joint_error = std::max(tally.joint_error, nearest);
    ++(nearest < 1e-4 ? tally.recovered : tally.lost);
  }
  tally.poses += poses;
}

/// The arm on a rail of 3 m: a pose that it reaches from somewhere, and one 1 m aside, which it
/// mostly does not.
void run_on_rail(std::size_t poses) {
  Arm arm = arm_of(rv_6sl(true));
  for (Axis& axis : arm.axes) {
    axis.lower = -2.8;
    axis.upper = 2.9;
  }
  Axis rail;
  rail.turns = false;
  rail.direction = Vec3::UnitY();
  rail.lower = -1.5;
  rail.upper = 1.5;
  arm.axes.insert(arm.axes.begin(), rail);
  const auto redundant = recognise_redundant(arm);
  std::mt19937_64 random(3);
  for (const bool aside : {false, true}) {
    std::size_t reached = 0, proved = 0, solutions = 0;
    double time = 0, longest = 0;
    for (std::size_t i = 0; i < poses; ++i) {
      std::vector<double> q = random_joints(random, arm.axes.size(), 2.8);
      q[0] = q[0] * 1.5 / 2.8;
      Transform target = kaboum::kinematics::forward(arm, q);
      if (aside) target.translation.x() += 1;
      const double start = seconds();
      const RedundantSolutions found = solve_redundant(*redundant, target);
      const double one = seconds() - start;
      time += one;
      longest = std::max(longest, one);
      reached += found.found.empty() ? 0 : 1;
      proved += found.out_of_reach ? 1 : 0;
      solutions += found.found.size();
    }
    const auto n = static_cast<double>(poses);
    std::printf(
        "RV-6SL on a rail of 3 m%-11s %8zu poses  %6.1f us, longest %.1f us  %.1f solutions  "
        "reached %zu, proved out of reach %zu\n",
        aside ? ", aside" : "", poses, time / n * 1e6, longest * 1e6,
        static_cast<double>(solutions) / n, reached, proved);
  }
}

void print(const char* name, const Tally& t) {
  const auto poses = static_cast<double>(t.poses);
  std::printf(
      "%-34s %8zu poses  %6.3f us  %.2f solutions  worst error %.1e  recovered %zu, lost %zu"
      "  worst joint %.1e\n",
      name, t.poses, t.time / poses * 1e6, static_cast<double>(t.solutions) / poses, t.error,
      t.recovered, t.lost, t.joint_error);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t arms = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000;
  const std::size_t poses = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1000;
  std::mt19937_64 random(1);
  Tally rv;
  for (int i = 0; i < 10; ++i) run(rv_6sl(true), poses, random, rv);
  print("RV-6SL", rv);
  run_on_rail(poses);
  for (const Family family : {Family::SphericalWrist, Family::ParallelAxes, Family::FiveAxes}) {
    Tally tally;
    for (std::size_t i = 0; i < arms; ++i) run(random_arm(family, random), poses, random, tally);
    print((std::string("random arms, ") + name_of(family)).c_str(), tally);
  }
}
