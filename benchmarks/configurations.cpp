// Times of configurations and motions in batches, and of the checker alone, on the same rows.
//
//   batch-benchmark SCENE [ROWS]
//
// Rows are the values of float64 of a file, else some that are drawn. Scenes: batch_scenes.py.

#include <kaboum/filter/batch_checker.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iostream>
#include <random>
#include <vector>

namespace {

using namespace kaboum;
using Answer = filter::BatchChecker::Answer;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::vector<double> drawn(const robot::Robot& robot, std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    for (const robot::Variable& v : robot.variables)
      out.push_back(std::uniform_real_distribution<double>(v.lower.value_or(-3),
                                                           v.upper.value_or(3))(random));
  return out;
}

std::vector<double> read(const char* name) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  std::vector<double> out(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(out.data()),
            static_cast<std::streamsize>(out.size() * sizeof(double)));
  return out;
}

/// Seconds of the checker for those rows that `looked_at` has, and how many answers are others.
double time_checker(const world::Checker& checker, const std::vector<double>& rows,
                    const std::vector<Answer>& answers, bool open_only, std::size_t& wrong) {
  world::Scratch scratch;
  world::WorldState state = initial_state(checker.world());
  const std::size_t n = rows.size() / answers.size();
  wrong = 0;
  const double start = cpu_seconds();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (open_only && answers[i] != Answer::Open) continue;
    state.q[0].assign(rows.data() + i * n, rows.data() + (i + 1) * n);
    const bool free = checker.is_free(state, scratch);
    wrong += answers[i] == (free ? Answer::Contact : Answer::Free) ? 1 : 0;
  }
  return cpu_seconds() - start;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const world::SceneFile scene = world::read_scene(argv[1]);
  const world::Checker checker(scene.world);
  const robot::Robot& robot = scene.world.robots[0].kinematics;
  const std::vector<double> rows = argc > 2 ? read(argv[2]) : drawn(robot, 50000);
  const std::size_t count = rows.size() / robot.variables.size();
  const auto each = [&](double seconds) { return 1e9 * seconds / static_cast<double>(count); };
  for (const filter::Instructions set : filter::instruction_sets()) {
    const double start = cpu_seconds();
    filter::BatchChecker::Options options;
    options.instructions = set;
    const filter::BatchChecker batch(checker, initial_state(scene.world), 0, options);
    const double made = cpu_seconds();
    std::vector<Answer> answers(count);
    batch.filter(rows, answers);
    const double filtered = cpu_seconds() - made;
    std::size_t wrong = 0, ignored = 0;
    const double open = time_checker(checker, rows, answers, true, ignored);
    const double all = time_checker(checker, rows, answers, false, wrong);
    const auto share = [&](Answer answer) {
      return 100.0 * static_cast<double>(std::ranges::count(answers, answer)) /
             static_cast<double>(count);
    };
    std::cout << name_of(set) << ": made in " << made - start << " s; ns each: filter "
              << each(filtered) << ", with exact answers " << each(filtered + open)
              << ", checker alone " << each(all) << "; free " << share(Answer::Free)
              << " %, in contact " << share(Answer::Contact) << " %, open " << share(Answer::Open)
              << " %; " << wrong << " wrong\n";
  }
}
