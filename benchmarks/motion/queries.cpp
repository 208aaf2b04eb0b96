// Queries for paths, timed, and paths judged by exact meshes.
//
//   path-query-benchmark plan SCENE PROBLEMS ANSWERS REPEATS [NODES]
//   path-query-benchmark judge SCENE URDF PROBLEMS PATHS ANSWERS STEP
//   path-query-benchmark batches SCENE URDF OBJECTS CONFIGURATIONS MOTIONS SEED
//
// The last one judges what the batch checks call free: half of the configurations are drawn, half
// are halved towards contact; motions begin at such, and go on by up to half a radian of each
// joint. They are judged as if at every sample at 10 kHz, at one radian per second of the joint
// that turns most: samples are left out where the distance of the exact meshes at one before is
// larger than points can have moved since. OBJECTS is a line of JSON.
//
// SCENE has a robot; PROBLEMS are lines of JSON: objects, start and goal; PATHS are lines of
// waypoints, one for each problem. planner_peers.py writes and reads all of them.

#include <kaboum/base/error.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/motion/roadmap.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "judged_robot.h"

namespace {

using namespace kaboum;
using namespace kaboum::benchmarks;
using nlohmann::json;
using Values = std::vector<double>;

/// CPU time of the process: others may be at work on the machine. [s]
double now() {
  timespec at{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
  return static_cast<double>(at.tv_sec) + 1e-9 * static_cast<double>(at.tv_nsec);
}

double length_of(const robot::Path& path) {
  double out = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < path[i].size(); ++k)
      sum += (path[i][k] - path[i - 1][k]) * (path[i][k] - path[i - 1][k]);
    out += std::sqrt(sum);
  }
  return out;
}

/// A scene with the objects of a problem, kept while they are the same.
struct Cell {
  json objects;
  std::unique_ptr<world::World> world;
  std::unique_ptr<world::Checker> checker;
  std::unique_ptr<motion::PathFinder> finder;
  std::unique_ptr<motion::Roadmap> roadmap;
  double seconds = 0;  ///< to make it

  Cell(const world::World& robot, const json& of, std::size_t nodes) : objects(of) {
    world = std::make_unique<world::World>(with_objects(robot, of));
    const double start = now();
    checker = std::make_unique<world::Checker>(*world);
    finder = std::make_unique<motion::PathFinder>(*checker, initial_state(*world), 0);
    motion::RoadmapOptions options;
    options.nodes = nodes;
    if (nodes > 0) roadmap = std::make_unique<motion::Roadmap>(*finder, options);
    seconds = now() - start;
  }
};

int plan(int argc, char** argv) {
  const world::SceneFile scene = world::read_scene(argv[2]);
  const std::vector<json> problems = read_lines(argv[3]);
  std::ofstream out(argv[4]);
  const int repeats = argc > 5 ? std::atoi(argv[5]) : 5;
  const std::size_t nodes = argc > 6 ? std::strtoul(argv[6], nullptr, 10) : 0;
  std::unique_ptr<Cell> cell;
  for (const json& problem : problems) {
    if (!cell || cell->objects != problem["objects"])
      cell = std::make_unique<Cell>(scene.world, problem["objects"], nodes);
    const auto start = problem["start"].get<Values>();
    const std::vector<Values> goals{problem["goal"].get<Values>()};
    motion::PathOptions options;
    double least = HUGE_VAL;
    motion::PathAnswer answer;
    for (int k = 0; k < repeats; ++k) {
      const double begin = now();
      answer = cell->roadmap ? cell->roadmap->find(*cell->finder, start, goals, options)
                             : cell->finder->find(start, goals, options);
      least = std::min(least, now() - begin);
    }
    json said{{"problem", problem["problem"]},
              {"outcome", name_of(answer.outcome)},
              {"seconds", least},
              {"setup", cell->seconds},
              {"path", answer.path},
              {"length", length_of(answer.path)},
              {"straight", answer.straight},
              {"motions", answer.spent.motions},
              {"stretches", answer.spent.intervals},
              {"samples", answer.spent.samples},
              {"nodes", answer.spent.nodes},
              {"configurations", answer.spent.configurations}};
    if (answer.contact)
      said["contact"] = {cell->world->name_of(answer.contact->items[0]),
                         cell->world->name_of(answer.contact->items[1])};
    out << said << '\n';
  }
  return 0;
}

/// Samples of a path that are in contact by the exact meshes.
struct Verdict {
  std::size_t samples = 0, contacts = 0;
  std::map<std::string, std::size_t> pairs;
};

Verdict judge(const judge::Cell& cell, judge::CellState& state, const robot::Path& path,
              double step) {
  Verdict out;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0;
    for (std::size_t k = 0; k < path[i].size(); ++k)
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    const auto parts = std::max(1.0, std::ceil(most / step));
    for (double p = i == 1 ? 0 : 1; p <= parts; ++p) {
      for (std::size_t k = 0; k < path[i].size(); ++k)
        state.q[0][k] = path[i - 1][k] + p / parts * (path[i][k] - path[i - 1][k]);
      ++out.samples;
      if (const auto meeting = cell.find_meeting(state)) {
        ++out.contacts;
        ++out.pairs[meeting->names[0] + " " + meeting->names[1]];
      }
    }
  }
  return out;
}

int judge_paths(char** argv) {
  const world::SceneFile scene = world::read_scene(argv[2]);
  const std::vector<json> problems = read_lines(argv[4]), paths = read_lines(argv[5]);
  std::ofstream out(argv[6]);
  const double step = std::atof(argv[7]);
  const JudgedRobot robot(scene.world.robots[0], argv[3]);
  std::unique_ptr<judge::Cell> cell;
  judge::CellState state;
  json objects;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    if (!cell || objects != problems[i]["objects"]) {
      objects = problems[i]["objects"];
      cell = robot.cell(with_objects(scene.world, objects), state);
    }
    const Verdict v = judge(*cell, state, paths[i].get<robot::Path>(), step);
    out << json{{"samples", v.samples}, {"contacts", v.contacts}, {"pairs", v.pairs}} << '\n';
  }
  return 0;
}

/// Rows of values, one after the other.
class JudgedBatches {
 public:
  JudgedBatches(const world::World& world, const judge::Cell& cell, judge::CellState state,
                std::uint64_t seed)
      : variables_(world.robots[0].kinematics.variables),
        checker_(world),
        batch_(checker_, initial_state(world), 0, {}),
        cell_(cell),
        state_(std::move(state)),
        random_(seed) {}

  /// @throws Error{LimitReached} where so many cannot be had
  void run(std::size_t configurations, std::size_t motions) {
    constexpr std::size_t kAtOnce = 20'000;
    constexpr int kTurns = 1000;  // without anything to judge
    const std::size_t half = configurations / 2;
    while (drawn_.rows < half) judge_rows(drawn(std::min(kAtOnce, half - drawn_.rows)), drawn_);
    int idle = 0;
    const auto count_idle = [&](bool more) {
      idle = more ? 0 : idle + 1;
      if (idle >= kTurns)
        throw Error(ErrorCode::LimitReached, "nothing is found to be free, or all is");
    };
    while (near_.rows < configurations - half || free_motions_ < motions) {
      const std::size_t known = near_.rows + free_motions_;
      const Values free = judge_rows(halved(kAtOnce / 8), near_);
      if (free_motions_ < motions) {
        const std::size_t left = motions - free_motions_;
        judge_motions(free, near_.rows < configurations - half ? left / 8 + 1 : left);
      }
      count_idle(near_.rows + free_motions_ > known);
    }
  }

  json said() const {
    const auto counts = [](const Counts& c) {
      return json{{"configurations", c.rows},
                  {"free", c.free},
                  {"missed", c.missed},
                  {"not free, sampled", c.other},
                  {"of these in contact", c.other_in_contact}};
    };
    return {{"drawn", counts(drawn_)},
            {"near contact", counts(near_)},
            {"motions",
             {{"asked", asked_},
              {"free", free_motions_},
              {"samples", samples_},
              {"samples of pairs looked at", looked_},
              {"missed", missed_motions_}}}};
  }
  /// Whether the judge saw a contact among the drawn configurations that are not free.
  [[nodiscard]] bool has_found_contacts() const { return drawn_.other_in_contact > 0; }
  [[nodiscard]] std::size_t missed() const {
    return drawn_.missed + near_.missed + missed_motions_;
  }

 private:
  struct Counts {
    std::size_t rows = 0, free = 0, missed = 0, other = 0, other_in_contact = 0;
  };

  [[nodiscard]] std::size_t width() const { return variables_.size(); }

  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  Values drawn(std::size_t count) {
    Values out;
    for (std::size_t i = 0; i < count; ++i)
      for (const robot::Variable& v : variables_)
        out.push_back(from(v.lower.value_or(-3.0), v.upper.value_or(3.0)));
    return out;
  }

  std::vector<std::uint8_t> decided(const Values& rows) {
    std::vector<std::uint8_t> out(rows.size() / width());
    batch_.decide(rows, out);
    return out;
  }

  /// Rows between a free one and one that is not, halved some times: the free end, mostly.
  Values halved(std::size_t count) {
    const Values rows = drawn(4 * count);
    const std::vector<std::uint8_t> are_free = decided(rows);
    Values free, other;
    for (std::size_t i = 0; i < are_free.size(); ++i) {
      Values& to = are_free[i] != 0 ? free : other;
      to.insert(to.end(), rows.begin() + static_cast<std::ptrdiff_t>(i * width()),
                rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * width()));
    }
    const std::size_t size = std::min({free.size(), other.size(), count * width()});
    free.resize(size);
    other.resize(size);
    const auto halvings = 6 + random_() % 14;
    for (std::size_t k = 0; k < halvings; ++k) {
      Values middle(size);
      for (std::size_t i = 0; i < size; ++i) middle[i] = 0.5 * (free[i] + other[i]);
      const std::vector<std::uint8_t> is_free = decided(middle);
      for (std::size_t i = 0; i < size; ++i)
        (is_free[i / width()] != 0 ? free : other)[i] = middle[i];
    }
    return free;
  }

  void place(const double* row) { state_.q[0].assign(row, row + width()); }

  void report(const char* what, const judge::Meeting& meeting) {
    std::cout << what << ": " << meeting.names[0] << " and " << meeting.names[1] << " at";
    for (const double x : state_.q[0]) std::cout << ' ' << std::hexfloat << x << std::defaultfloat;
    std::cout << '\n';
  }

  /// @return the rows that are free
  Values judge_rows(const Values& rows, Counts& counts) {
    const std::vector<std::uint8_t> free = decided(rows);
    Values out;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const double* row = rows.data() + i * width();
      ++counts.rows;
      counts.free += free[i] != 0 ? 1U : 0U;
      if (free[i] == 0 && random_() % 64 != 0) continue;
      place(row);
      const auto meeting = cell_.find_meeting(state_);
      if (free[i] == 0) {
        ++counts.other;
        counts.other_in_contact += meeting ? 1U : 0U;
        continue;
      }
      out.insert(out.end(), row, row + width());
      if (meeting && counts.missed++ < 5) report("a configuration that is called free", *meeting);
    }
    return out;
  }

  /// @return how many were called free and judged, no more than `most`
  std::size_t judge_motions(const Values& starts, std::size_t most) {
    Values goals = starts;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const robot::Variable& v = variables_[i % width()];
      goals[i] =
          std::clamp(goals[i] + from(-0.5, 0.5), v.lower.value_or(-3.0), v.upper.value_or(3.0));
    }
    const std::size_t count = std::min(starts.size() / width(), 4 * most);
    const std::span<const double> from_rows(starts.data(), count * width());
    const std::span<const double> to_rows(goals.data(), count * width());
    std::vector<std::uint8_t> free(count);
    batch_.decide_motions(from_rows, to_rows, free, {});
    std::size_t out = 0;
    for (std::size_t i = 0; i < count && out < most; ++i) {
      ++asked_;
      if (free[i] == 0) continue;
      ++out;
      judge_motion(starts.data() + i * width(), goals.data() + i * width());
    }
    free_motions_ += out;
    return out;
  }

  void judge_motion(const double* start, const double* goal) {
    constexpr double kRate = 10'000;
    double most = 0;
    for (std::size_t k = 0; k < width(); ++k) most = std::max(most, std::abs(goal[k] - start[k]));
    const auto samples = static_cast<std::size_t>(std::ceil(kRate * most));
    if (samples == 0) return;
    samples_ += samples + 1;
    place(start);
    judge::CellState end = state_;
    end.q[0].assign(goal, goal + width());
    const auto meeting = cell_.find_meeting_on(state_, end, 0, samples, looked_);
    if (meeting && missed_motions_++ < 5) report("a motion that is called free", *meeting);
  }

  const std::vector<robot::Variable>& variables_;
  world::Checker checker_;
  filter::BatchChecker batch_;
  const judge::Cell& cell_;
  judge::CellState state_;
  std::mt19937_64 random_;
  Counts drawn_, near_;
  std::size_t asked_ = 0, free_motions_ = 0, samples_ = 0, looked_ = 0, missed_motions_ = 0;
};

int judge_batches(char** argv) {
  const world::SceneFile scene = world::read_scene(argv[2]);
  const world::World all = with_objects(scene.world, read_lines(argv[4]).at(0));
  judge::CellState state;
  const JudgedRobot robot(scene.world.robots[0], argv[3]);
  const std::unique_ptr<judge::Cell> cell = robot.cell(all, state);
  JudgedBatches batches(all, *cell, state, std::strtoull(argv[7], nullptr, 10));
  batches.run(std::strtoull(argv[5], nullptr, 10), std::strtoull(argv[6], nullptr, 10));
  std::cout << batches.said() << '\n';
  if (!batches.has_found_contacts())
    throw Error(ErrorCode::InvalidInput, "the meshes meet nowhere: what they say is worth nothing");
  return batches.missed() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc >= 5 && std::string(argv[1]) == "plan") return plan(argc, argv);
    if (argc >= 8 && std::string(argv[1]) == "judge") return judge_paths(argv);
    if (argc >= 8 && std::string(argv[1]) == "batches") return judge_batches(argv);
  } catch (const std::exception& error) {
    std::cerr << "path-query-benchmark: " << error.what() << '\n';
    return 1;
  }
  std::cerr << "usage: path-query-benchmark plan|judge|batches ...\n";
  return 2;
}
