// Configurations for checkers of others to answer, with our answers and those of exact meshes.
//
//   batch-peer-benchmark rows SCENE URDF OBJECTS COUNT SEED FOLDER
//   batch-peer-benchmark depths SCENE URDF OBJECTS ROWS DEPTHS
//
// SCENE has a robot, OBJECTS is a line of JSON, as for path-query-benchmark. Four kinds of so many
// rows of float64 (all of them values of float32): `drawn` from all values; `meshes`, halved
// between a drawn one that is free by the exact meshes and one that is not, both ends; `sets`, the
// same by our batch; `along`, the places of straight motions that the batch calls free, eight after
// one another. FOLDER gets KIND.rows, KIND.ours (a byte each, 1: free) and KIND.meshes (the same).
// Printed: our CPU time for each configuration of each kind, of one thread.
//
// `depths` writes for each row: how deep the exact meshes are in each other, at least, and the
// first two that meet; pairs of links come before others.

#include <kaboum/filter/batch_checker.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <random>
#include <span>
#include <string>

#include "judged_robot.h"

namespace {

using namespace kaboum;
using namespace kaboum::benchmarks;
using nlohmann::json;
using Values = std::vector<double>;
using Answers = std::vector<std::uint8_t>;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class T>
void write(const std::string& name, const std::vector<T>& values) {
  std::ofstream(name, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

/// A scene for the batch, and its exact meshes.
class Scene {
 public:
  explicit Scene(char** argv)
      : file_(world::read_scene(argv[2])),
        world_(with_objects(file_.world, read_lines(argv[4]).at(0))),
        checker_(world_),
        batch_(checker_, initial_state(world_), 0, {}),
        cell_(JudgedRobot(file_.world.robots[0], argv[3]).cell(world_, state_)) {}

  [[nodiscard]] const std::vector<robot::Variable>& variables() const {
    return world_.robots[0].kinematics.variables;
  }
  [[nodiscard]] std::size_t width() const { return variables().size(); }
  [[nodiscard]] Answers by_sets(const Values& rows) const {
    Answers out(rows.size() / width());
    batch_.decide(rows, out);
    return out;
  }
  [[nodiscard]] Answers by_meshes(const Values& rows) {
    Answers out;
    for (std::size_t i = 0; i < rows.size(); i += width()) {
      place(rows, i);
      out.push_back(cell_->find_meeting(state_) ? 0 : 1);
    }
    return out;
  }
  [[nodiscard]] std::string contact(const Values& rows, std::size_t at) {
    constexpr double kStep = 0.002;  // [m]
    place(rows, at);
    const auto meeting = cell_->find_meeting(state_);
    if (!meeting) return "0 - -";
    return std::to_string(cell_->depth(state_, kStep)) + " " + meeting->names[0] + " " +
           meeting->names[1];
  }
  [[nodiscard]] const filter::BatchChecker& batch() const { return batch_; }

 private:
  void place(const Values& rows, std::size_t at) {
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(at);
    state_.q[0].assign(first, first + static_cast<std::ptrdiff_t>(width()));
  }

  world::SceneFile file_;
  world::World world_;
  world::Checker checker_;
  filter::BatchChecker batch_;
  judge::CellState state_;
  std::unique_ptr<judge::Cell> cell_;
};

/// Rows of a scene.
class Rows {
 public:
  Rows(Scene& scene, std::uint64_t seed) : scene_(scene), random_(seed) {}

  [[nodiscard]] Values drawn(std::size_t count) {
    Values out;
    for (std::size_t i = 0; i < count; ++i)
      for (const robot::Variable& v : scene_.variables())
        out.push_back(single(from(v.lower.value_or(-3.0), v.upper.value_or(3.0)), v));
    return out;
  }

  /// @param ask  says of rows which are free
  template <class Ask>
  [[nodiscard]] Values halved(std::size_t count, const Ask& ask) {
    const std::size_t n = scene_.width();
    Values out;
    while (out.size() < count * n) {
      const Values rows = drawn(2 * count);
      const Answers are_free = ask(rows);
      Values free, other;
      for (std::size_t i = 0; i < are_free.size(); ++i)
        for (std::size_t k = 0; k < n; ++k)
          (are_free[i] != 0 ? free : other).push_back(rows[i * n + k]);
      const std::size_t size = std::min(free.size(), other.size());
      free.resize(size);
      other.resize(size);
      const auto halvings = 5 + random_() % 10;
      for (std::size_t h = 0; h < halvings; ++h) {
        Values middle(size);
        for (std::size_t i = 0; i < size; ++i)
          middle[i] = single(0.5 * (free[i] + other[i]), scene_.variables()[i % n]);
        const Answers is_free = ask(middle);
        for (std::size_t i = 0; i < size; ++i) (is_free[i / n] != 0 ? free : other)[i] = middle[i];
      }
      out.insert(out.end(), free.begin(), free.end());
      out.insert(out.end(), other.begin(), other.end());
    }
    out.resize(count * n);
    return out;
  }

  /// Eight places of each motion that the batch calls free, a thirty-second of a radian apart.
  [[nodiscard]] Values along(std::size_t count) {
    constexpr std::size_t kPlaces = 8;
    const std::size_t n = scene_.width();
    Values out;
    while (out.size() < count * n) {
      const Values starts = drawn(count / 2);
      Values goals = starts;
      for (std::size_t i = 0; i < goals.size(); ++i) {
        const robot::Variable& v = scene_.variables()[i % n];
        goals[i] = single(
            std::clamp(goals[i] + from(-0.2, 0.2), v.lower.value_or(-3.0), v.upper.value_or(3.0)),
            v);
      }
      Answers free(starts.size() / n);
      scene_.batch().decide_motions(starts, goals, free, {});
      for (std::size_t i = 0; i < free.size(); ++i)
        for (std::size_t p = 0; free[i] != 0 && p < kPlaces; ++p)
          for (std::size_t k = i * n; k < (i + 1) * n; ++k)
            out.push_back(
                single(starts[k] + static_cast<double>(p) / kPlaces * (goals[k] - starts[k]),
                       scene_.variables()[k % n]));
    }
    out.resize(count * n);
    return out;
  }

 private:
  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// The nearest value of float32, within the limits.
  static double single(double value, const robot::Variable& v) {
    auto out = static_cast<float>(value);
    if (v.lower && out < *v.lower) out = std::nextafter(out, HUGE_VALF);
    if (v.upper && out > *v.upper) out = std::nextafter(out, -HUGE_VALF);
    return out;
  }

  Scene& scene_;
  std::mt19937_64 random_;
};

int write_rows(char** argv) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  Scene scene(argv);
  const std::size_t count = std::strtoull(argv[5], nullptr, 10);
  Rows rows(scene, std::strtoull(argv[6], nullptr, 10));
  const std::string folder = argv[7];
  const auto by_sets = [&](const Values& some) { return scene.by_sets(some); };
  const auto by_meshes = [&](const Values& some) { return scene.by_meshes(some); };
  json said;
  const auto take = [&](const std::string& kind, const Values& some) {
    Answers ours(some.size() / scene.width());
    double least = HUGE_VAL;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const double start = cpu_seconds();
      scene.batch().decide(some, ours);
      least = std::min(least, cpu_seconds() - start);
    }
    write(folder + "/" + kind + ".rows", some);
    write(folder + "/" + kind + ".ours", ours);
    write(folder + "/" + kind + ".meshes", by_meshes(some));
    said[kind] = 1e9 * least / static_cast<double>(ours.size());
  };
  take("drawn", rows.drawn(count));
  take("meshes", rows.halved(count, by_meshes));
  take("sets", rows.halved(count, by_sets));
  take("along", rows.along(count));
  std::cout << said << '\n';
  return 0;
}

int write_depths(char** argv) {
  Scene scene(argv);
  std::ifstream file(argv[5], std::ios::binary | std::ios::ate);
  Values rows(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(rows.data()),
            static_cast<std::streamsize>(rows.size() * sizeof(double)));
  std::ofstream out(argv[6]);
  for (std::size_t i = 0; i < rows.size(); i += scene.width())
    out << scene.contact(rows, i) << '\n';
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc == 8 && std::string(argv[1]) == "rows") return write_rows(argv);
    if (argc == 7 && std::string(argv[1]) == "depths") return write_depths(argv);
  } catch (const std::exception& error) {
    std::cerr << "batch-peer-benchmark: " << error.what() << '\n';
    return 1;
  }
  std::cerr << "usage: batch-peer-benchmark rows|depths ...\n";
  return 2;
}
