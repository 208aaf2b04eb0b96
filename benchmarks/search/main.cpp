/// All that the bounded predicates were asked during one search for a plan, decided again: by the
/// bounding sets, as the planner does it; and by exact meshes and bounding sets in FCL, Bullet and
/// ODE, as kaboum-plan --engine does it, where motions are looked at at samples. search-benchmark
/// DOMAIN PROBLEM SCENE [SEARCH [SEED [STEP]]]; prints one JSON object. STEP: no point of a robot
/// moves farther between two samples. [m; 0.02, as the thesis's ε]
#include <kaboum/base/error.h>
#include <kaboum/engines/engine_world.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/manipulation/externals.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>
#include <kaboum/world/exact_meshes.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

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

/// Counts the states that a substitute is asked about.
class Counted : public world::Substitute {
 public:
  explicit Counted(std::shared_ptr<world::Substitute> asked) : asked_(std::move(asked)) {}
  std::vector<std::size_t> find_meeting(const WorldState& state,
                                        const std::vector<std::array<Item, 2>>& pairs,
                                        bool all) override {
    ++states;
    return asked_->find_meeting(state, pairs, all);
  }
  [[nodiscard]] double step() const override { return asked_->step(); }
  std::size_t states = 0;

 private:
  std::shared_ptr<world::Substitute> asked_;
};

/// Own predicates, at the samples at which others look at motions.
class OwnAtSamples : public world::Substitute {
 public:
  OwnAtSamples(const world::Checker& checker, double step) : checker_(checker), step_(step) {}
  std::vector<std::size_t> find_meeting(const WorldState& state,
                                        const std::vector<std::array<Item, 2>>& pairs,
                                        bool /*all*/) override {
    std::vector<std::size_t> out;
    if (checker_.is_free(state, scratch_)) return out;
    const auto contacts = checker_.find_contacts(state, scratch_, {});
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if (std::ranges::any_of(contacts, [&](const auto& c) { return c.items == pairs[k]; }))
        out.push_back(k);
    return out;
  }
  [[nodiscard]] double step() const override { return step_; }

 private:
  const world::Checker& checker_;
  double step_;
  world::Scratch scratch_;
};

struct Times {
  double seconds = 0;
  std::size_t configurations = 0;  ///< that were looked at, samples of motions included
  std::size_t in_contact = 0;
  std::vector<char> contact;  ///< of each question
};

/// As the planner asks: motions at every instant or, of a library of others, at samples.
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
  std::size_t motions = 0;
  for (const Recording& a : all) motions += a.path.empty() ? 0 : 1;
  std::vector<std::pair<Item, geom::Mesh>> meshes;
  std::size_t triangles = 0, bodies = 0;
  for (world::ExactMesh& mesh : world::exact_meshes(world, argv[3], {})) {
    triangles += mesh.mesh.triangles.size();
    bodies += world.outer(mesh.item).size();
    meshes.emplace_back(mesh.item, std::move(mesh.mesh));
  }
  const Times ours = decided(checker, all);
  const auto by = [&](engines::Library library, engines::Shapes shapes) {
    Counted counted(engines::make_substitute(
        world, {.library = library, .shapes = shapes, .step = step}, meshes));
    Times out = decided(world::Checker(world, nullptr, &counted), all);
    out.configurations = counted.states;
    return out;
  };
  Counted own_counted(std::make_shared<OwnAtSamples>(checker, step));
  Times sampled = decided(world::Checker(world, nullptr, &own_counted), all);
  sampled.configurations = own_counted.states;
  nlohmann::json columns;
  // Contacts of exact meshes that the sets miss, ours and the library's own; and where it differs
  // from FCL about exact meshes.
  std::size_t missed = 0, otherwise = 0, touching = 0;
  Times first;
  for (const auto library :
       {engines::Library::Fcl, engines::Library::Bullet, engines::Library::Ode}) {
    const Times exact = by(library, engines::Shapes::Meshes),
                sets = by(library, engines::Shapes::Sets);
    const std::string name = engines::name_of(library);
    if (first.contact.empty()) first = exact;
    std::size_t less = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      missed += exact.contact[i] != 0 && ours.contact[i] == 0 ? 1 : 0;
      less += exact.contact[i] != 0 && sets.contact[i] == 0 ? 1 : 0;
      otherwise += exact.contact[i] != first.contact[i] ? 1 : 0;
    }
    touching += less;
    columns["exact_" + name] = json_of(exact);
    columns["sets_" + name] = json_of(sets);
    columns["sets_" + name]["missed"] = less;
  }
  nlohmann::json out = {{"search", search},
                        {"seed", seed},
                        {"step_m", step},
                        {"solved", solution.outcome == plan::Outcome::Solved},
                        {"configurations", all.size() - motions},
                        {"motions", motions},
                        {"triangles", triangles},
                        {"bodies", bodies},
                        {"sets_at_every_instant", json_of(ours)},
                        {"sets_sampled", json_of(sampled)},
                        {"missed", missed},
                        {"exact_differing", otherwise}};
  out.update(columns);
  std::printf("%s\n", out.dump().c_str());
  // Touching is a matter of rounding.
  return missed == 0 && touching * 1000 <= all.size() && otherwise * 1000 <= all.size() ? 0 : 1;
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
