/// All that the bounded predicates were asked during one search for a plan, decided again: by the
/// bounding sets, as the planner does it; and by exact meshes and bounding sets in FCL, Bullet and
/// ODE, where motions are looked at at samples. search-benchmark DOMAIN PROBLEM SCENE [SEARCH [SEED
/// [STEP]]]; prints one JSON object. STEP: no point of a robot moves farther between two samples.
/// [m; 0.02, as the thesis's ε]
#include <kaboum/base/error.h>
#include <kaboum/execution/exact_cell.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>
#include <kaboum/sweep/motion.h>
#include <kaboum/world/scene.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "other_world.h"

namespace {

using namespace kaboum;
using world::Item;
using world::WorldState;

/// A configuration, or a motion where there is a path.
struct Recording {
  WorldState state;
  std::size_t robot = 0;
  robot::Path path;
  std::optional<std::vector<Item>> things;
};

class Recorder : public world::Observer {
 public:
  std::vector<Recording> asked_of;

  void asked(const WorldState& state) override { asked_of.push_back({state, 0, {}, {}}); }
  void asked(const WorldState& state, std::size_t robot, const robot::Path& path,
             const std::vector<Item>* things) override {
    std::optional<std::vector<Item>> looked_at;
    if (things != nullptr) looked_at = *things;
    asked_of.push_back({state, robot, path, std::move(looked_at)});
  }
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Samples of a motion, so near to each other that no point moves by more than `step` in between.
std::vector<WorldState> samples_of(const world::Checker& checker, const Recording& asked,
                                   double step) {
  const world::RobotModel& model = checker.world().robots[asked.robot];
  std::vector<WorldState> out;
  WorldState state = asked.state;
  const auto add = [&](std::vector<double> q) {
    state.q[asked.robot] = std::move(q);
    out.push_back(state);
  };
  add(asked.path.front());
  for (std::size_t i = 0; i + 1 < asked.path.size(); ++i) {
    const std::vector<double>&from = asked.path[i], &to = asked.path[i + 1];
    double most = 0;
    const auto look = [&](std::uint32_t link, const auto& reach_of) {
      const sweep::LinkMotion motion(model.kinematics, link, from, to);
      if (motion.moves())
        most = std::max(most, sweep::MotionBounds(motion, reach_of(motion)).derivative(1));
    };
    for (std::size_t s = 0; s < model.shapes.size(); ++s)
      look(model.shapes[s].link, [&](const auto&) { return checker.reach_of(asked.robot, s); });
    for (std::size_t o = 0; o < asked.state.attachments.size(); ++o) {
      const auto& held = asked.state.attachments[o];
      if (!held || held->robot != asked.robot) continue;
      std::vector<geom::Vec3> points = checker.hull_of({Item::kObject, o});
      for (geom::Vec3& p : points) p = held->pose * p;
      look(held->link, [&](const auto& motion) { return sweep::reach_of(motion, points); });
    }
    const auto count = std::max(1, static_cast<int>(std::ceil(most / step)));
    for (int k = 1; k <= count; ++k) {
      std::vector<double> q = from;
      for (std::size_t j = 0; j < q.size(); ++j)
        q[j] += static_cast<double>(k) / count * (to[j] - from[j]);
      add(std::move(q));
    }
  }
  return out;
}

struct Times {
  double seconds = 0;
  std::size_t configurations = 0, in_contact = 0;
  std::vector<char> contact;  ///< of each question
};

/// Decides every question by samples, until one is in contact.
template <typename Choose, typename Collide>
Times sampled(const std::vector<Recording>& all,
              const std::vector<std::vector<WorldState>>& samples, const Choose& choose,
              const Collide& collide) {
  Times out;
  const double start = cpu_seconds();
  for (std::size_t i = 0; i < all.size(); ++i) {
    choose(all[i]);
    bool contact = false;
    for (std::size_t k = 0; k < samples[i].size() && !contact; ++k) {
      ++out.configurations;
      contact = collide(all[i], samples[i][k], k == 0);
    }
    out.contact.push_back(contact ? 1 : 0);
    out.in_contact += contact ? 1 : 0;
  }
  out.seconds = cpu_seconds() - start;
  return out;
}

template <typename MakeShapes>
Times sampled_in(const world::Checker& checker, const search::Meshes& meshes,
                 const MakeShapes& make, const std::vector<Recording>& all,
                 const std::vector<std::vector<WorldState>>& samples) {
  search::OtherWorld other(checker, meshes, make);
  return sampled(
      all, samples,
      [&](const Recording& a) {
        if (a.path.empty())
          other.choose_pairs(a.state);
        else
          other.choose_pairs(samples[static_cast<std::size_t>(&a - all.data())].front(), a.robot,
                             a.things ? &*a.things : nullptr);
      },
      [&](const Recording& a, const WorldState& state, bool first) {
        return other.collide(state, first || a.path.empty() ? search::OtherWorld::kAll : a.robot);
      });
}

/// As the planner asks: motions at every instant.
Times decided(const world::Checker& checker, const std::vector<Recording>& all) {
  Times out;
  world::Scratch scratch;
  const double start = cpu_seconds();
  for (const Recording& a : all) {
    bool contact = false;
    if (a.path.empty())
      contact = !checker.is_free(a.state, scratch);
    else if (a.things)
      contact = !find_obstacles(checker, a.state, a.robot, a.path, *a.things, {}).empty();
    else
      contact = check_motion(checker, a.state, a.robot, a.path, {}).outcome !=
                world::MotionAnswer::Outcome::Free;
    out.contact.push_back(contact ? 1 : 0);
    out.in_contact += contact ? 1 : 0;
  }
  out.seconds = cpu_seconds() - start;
  return out;
}

plan::Text text_of(const char* file) {
  const std::vector<char> bytes = io::read_file(file);
  return {file, std::string(bytes.begin(), bytes.end()), plan::Language::Kpl};
}

nlohmann::json json_of(const Times& t) {
  return {{"s", t.seconds}, {"configurations", t.configurations}, {"in_contact", t.in_contact}};
}

int run(int argc, char** argv) {
  const std::string search = argc > 4 ? argv[4] : "bfs";
  const std::uint64_t seed = argc > 5 ? std::strtoull(argv[5], nullptr, 10) : 1;
  const double step = argc > 6 ? std::strtod(argv[6], nullptr) : 0.02;
  const std::map<std::string, plan::Algorithm> algorithms = {
      {"dfs", plan::Algorithm::DepthFirst},
      {"bfs", plan::Algorithm::BreadthFirst},
      {"ids", plan::Algorithm::IterativeDeepening},
      {"greedy", plan::Algorithm::Greedy}};
  world::SceneFile scene = world::read_scene(argv[3]);
  const world::World world = scene.world;
  const auto recorder = std::make_shared<Recorder>();
  manipulation::ExternalOptions options;
  options.observer = recorder;
  const plan::Text domain = text_of(argv[1]), problem = text_of(argv[2]);
  plan::SolveOptions how;
  how.algorithm = algorithms.at(search);
  how.seed = seed;
  const plan::Solution solution = plan::solve(
      plan::load(domain, &problem, manipulation::bind_externals(std::move(scene.world), options)),
      how);
  const std::vector<Recording> all = std::move(recorder->asked_of);
  const world::Checker checker(world);
  std::vector<std::vector<WorldState>> samples;
  std::size_t motions = 0;
  for (const Recording& a : all) {
    motions += a.path.empty() ? 0 : 1;
    samples.push_back(a.path.empty() ? std::vector{a.state} : samples_of(checker, a, step));
  }
  search::Meshes exact, sets;
  std::size_t triangles = 0;
  for (execution::ExactMesh& mesh : execution::exact_meshes(world, argv[3], {})) {
    triangles += mesh.mesh.triangles.size();
    exact.emplace_back(mesh.item, std::move(mesh.mesh));
  }
  for (const auto& [item, mesh] : exact) {
    if (!sets.empty() && sets.back().first == item) continue;
    const world::BoundingSet& outer = world.outer(item);
    for (std::size_t i = 0; i < outer.size(); ++i) sets.emplace_back(item, outer.body(i).core);
  }
  const Times ours = decided(checker, all);
  world::Scratch scratch;
  const Times ours_sampled = sampled(
      all, samples, [](const Recording&) {},
      [&](const Recording&, const WorldState& state, bool) {
        return !checker.is_free(state, scratch);
      });
  const auto in = [&](const search::Meshes& meshes, const auto& make) {
    return sampled_in(checker, meshes, make, all, samples);
  };
  const auto in_fcl = [](bool convex) {
    return [=](std::size_t things) { return search::fcl_shapes(things, convex); };
  };
  const auto in_bullet = [](bool convex) {
    return [=](std::size_t things) { return search::bullet_shapes(things, convex); };
  };
  const Times by_exact = in(exact, in_fcl(false)), by_sets = in(sets, in_fcl(true)),
              exact_ode = in(exact, search::ode_shapes), exact_bullet = in(exact, in_bullet(false)),
              sets_bullet = in(sets, in_bullet(true));
  // Contacts of exact meshes by each library that the sets miss, and where it differs from FCL.
  std::size_t missed = 0, otherwise = 0;
  for (const Times* exact_times : {&by_exact, &exact_ode, &exact_bullet})
    for (std::size_t i = 0; i < all.size(); ++i) {
      missed += exact_times->contact[i] != 0 && ours.contact[i] == 0 ? 1 : 0;
      otherwise += exact_times->contact[i] != by_exact.contact[i] ? 1 : 0;
    }
  const nlohmann::json out = {{"search", search},
                              {"seed", seed},
                              {"step_m", step},
                              {"solved", solution.outcome == plan::Outcome::Solved},
                              {"configurations", all.size() - motions},
                              {"motions", motions},
                              {"triangles", triangles},
                              {"bodies", sets.size()},
                              {"sets_at_every_instant", json_of(ours)},
                              {"sets_sampled", json_of(ours_sampled)},
                              {"exact_fcl", json_of(by_exact)},
                              {"sets_fcl", json_of(by_sets)},
                              {"exact_ode", json_of(exact_ode)},
                              {"exact_bullet", json_of(exact_bullet)},
                              {"sets_bullet", json_of(sets_bullet)},
                              {"missed", missed},
                              {"exact_differing", otherwise}};
  std::printf("%s\n", out.dump().c_str());
  return missed == 0 && otherwise * 1000 <= all.size() ? 0 : 1;  // touching is a matter of rounding
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 3;
  }
}
