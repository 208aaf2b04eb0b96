#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/judge/placement.h>
#include <kaboum/judge/solid.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>
#include <optional>
#include <random>

/// Bounded predicates judged by exact meshes: configurations, half of them near contact, and
/// motions said to be free. Every pair of things that is looked at is judged by itself.
/// judged-benchmark SCENE CONFIGURATIONS SEGMENTS SEED NAME=FILE...: the URDF of each robot and the
/// mesh of each object of the scene. Exit code 1 where an answer is wrong.
namespace {

using namespace kaboum;
using judge::Solid;
using world::Item;
using world::WorldState;

/// Samples of a motion per radian of the joint that turns most: 1 kHz at one radian per second.
constexpr double kSamples = 1000;

/// About the origin.
geom::Mesh unit_box() {
  geom::Mesh out;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) out.vertices.emplace_back(x, y, z);
  out.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                   {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return out;
}

/// The exact meshes of a world.
class Judge {
 public:
  Judge(const world::World& world, const std::map<std::string, std::string>& files)
      : world_(world) {
    for (std::size_t r = 0; r < world.robots.size(); ++r) {
      const robot::RobotFile file = robot::read_robot(files.at(world.robots[r].name));
      robot::MeshFiles meshes(file.path, {});
      for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
        geom::Mesh all;
        const robot::Link& link = file.robot.links[world.robots[r].shapes[s].link];
        for (const robot::Geometry& g : link.collision) {
          const bool is_mesh = g.shape == robot::Geometry::Shape::Mesh;
          if (!is_mesh && g.shape != robot::Geometry::Shape::Box)
            throw Error(ErrorCode::InvalidInput, link.name + ": a shape that is no mesh or box");
          const geom::Mesh mesh = is_mesh ? io::read_mesh(meshes.first(g.mesh)).mesh : unit_box();
          const auto first = static_cast<std::uint32_t>(all.vertices.size());
          for (const geom::Vec3& v : mesh.vertices)
            all.vertices.emplace_back(g.origin * v.cwiseProduct(g.size));
          for (const geom::Triangle& t : mesh.triangles)
            all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
        add({r, s}, all);
      }
    }
    for (std::size_t o = 0; o < world.objects.size(); ++o)
      add({Item::kObject, o}, io::read_mesh(files.at(world.objects[o].name)).mesh);
  }

  struct Placement {
    const Solid* solid;
    geom::Transform at;
    double epsilon;
  };

  [[nodiscard]] std::map<Item, Placement> place(const WorldState& state) const {
    std::vector<std::vector<geom::Transform>> links;
    for (std::size_t r = 0; r < world_.robots.size(); ++r)
      links.push_back(
          judge::places(world_.robots[r].kinematics, world_.robots[r].base, state.q[r]));
    std::map<Item, Placement> out;
    for (const auto& [item, solid] : solids_) {
      geom::Transform at;
      if (item.robot != Item::kObject)
        at = links[item.robot][world_.robots[item.robot].shapes[item.index].link];
      else if (const auto& a = state.attachments[item.index])
        at = judge::product(links[a->robot][a->link], a->pose);
      else
        at = state.poses[item.index];
      out.insert({item, {solid.get(), at, world_.outer(item).epsilon()}});
    }
    return out;
  }

  static bool meet(const Placement& a, const Placement& b) {
    return a.solid->meets(a.at, *b.solid, b.at);
  }

  /// Whether they are at most `times` the sum of their epsilons apart. A billionth more: rounding,
  /// and errors of places.
  static bool are_near(const Placement& a, const Placement& b, double times) {
    return meet(a, b) || a.solid->is_within(a.at, *b.solid, b.at,
                                            (times * (a.epsilon + b.epsilon) + 1e-9) * (1 + 1e-9));
  }

  [[nodiscard]] std::optional<std::array<Item, 2>> find_meeting(
      const WorldState& state, const std::vector<std::array<Item, 2>>& pairs) const {
    const auto at = place(state);
    for (const auto& p : pairs)
      if (meet(at.at(p[0]), at.at(p[1]))) return p;
    return std::nullopt;
  }

  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  [[nodiscard]] std::size_t open() const { return open_; }

 private:
  void add(const Item& item, const geom::Mesh& mesh) {
    solids_[item] = std::make_unique<Solid>(mesh);
    triangles_ += solids_[item]->triangles();
    open_ += solids_[item]->closed() ? 0 : 1;
  }

  const world::World& world_;
  std::map<Item, std::unique_ptr<Solid>> solids_;
  std::size_t triangles_ = 0, open_ = 0;
};

struct Counts {
  std::size_t configurations = 0, near = 0, contacts = 0, said = 0, pairs = 0, said_pairs = 0,
              missed = 0, false_alarms = 0;
  double predicate_seconds = 0;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class Trial {
 public:
  Trial(const world::World& world, const Judge& judge, std::uint64_t seed)
      : world_(world),
        judge_(judge),
        checker_(world),
        pairs_(checker_.pairs(initial_state(world), {})),
        random_(seed) {}

  WorldState anywhere() {
    WorldState state = initial_state(world_);
    for (std::size_t r = 0; r < world_.robots.size(); ++r)
      for (std::size_t i = 0; i < state.q[r].size(); ++i) {
        const robot::Variable& v = world_.robots[r].kinematics.variables[i];
        state.q[r][i] =
            from(std::max(v.lower.value_or(-3), -3.0), std::min(v.upper.value_or(3), 3.0));
      }
    return state;
  }

  /// Both ends of what halvings leave between a state that is in contact and one that is not; by
  /// the predicate or by the exact meshes.
  WorldState at_contact(bool by_meshes) {
    const auto is_in_contact = [&](const WorldState& s) {
      return by_meshes ? judge_.find_meeting(s, pairs_).has_value()
                       : checker_.find_contact(s, scratch_).has_value();
    };
    for (;;) {
      std::array<WorldState, 2> ends{anywhere(), anywhere()};
      const bool first = is_in_contact(ends[0]);
      if (first == is_in_contact(ends[1])) continue;
      const auto halvings = 10 + random_() % 12;
      WorldState middle = ends[0];
      for (std::size_t step = 0; step < halvings; ++step) {
        for (std::size_t r = 0; r < middle.q.size(); ++r)
          for (std::size_t i = 0; i < middle.q[r].size(); ++i)
            middle.q[r][i] = 0.5 * (ends[0].q[r][i] + ends[1].q[r][i]);
        ends[is_in_contact(middle) == first ? 0 : 1] = middle;
      }
      return ends[random_() % 2];
    }
  }

  void judge_state(const WorldState& state, bool near, Counts& counts) {
    const double start = cpu_seconds();
    const auto contacts = checker_.find_contacts(state, scratch_, {});
    counts.predicate_seconds += cpu_seconds() - start;
    std::vector<std::array<Item, 2>> said;
    for (const world::Contact& c : contacts) said.push_back(c.items);
    const auto at = judge_.place(state);
    ++counts.configurations;
    bool in_contact = false, is_near = false;
    for (const auto& pair : pairs_) {
      const auto &a = at.at(pair[0]), &b = at.at(pair[1]);
      const bool meets = Judge::meet(a, b);
      const bool is_said = std::find(said.begin(), said.end(), pair) != said.end();
      in_contact = in_contact || meets;
      ++counts.pairs;
      counts.said_pairs += is_said ? 1 : 0;
      if (meets && !is_said) report("missed", state, pair, counts.missed++);
      const bool touches = meets || (is_said && Judge::are_near(a, b, 1));
      if (is_said && !touches) report("false alarm", state, pair, counts.false_alarms++);
      is_near = is_near || touches || (near && !is_near && Judge::are_near(a, b, 2));
    }
    counts.contacts += in_contact ? 1 : 0;
    counts.said += said.empty() ? 0 : 1;
    counts.near += is_near ? 1 : 0;
    if (checker_.find_contact(state, scratch_).has_value() != !said.empty())
      report("another answer to one contact than to all", state, pairs_.front(), counts.missed++);
  }

  /// From states said to be free. @return samples in contact of motions said to be free.
  std::size_t judge_motions(std::size_t count) {
    std::size_t free = 0, asked = 0, samples = 0, wrong = 0;
    while (free < count) {
      const WorldState start = anywhere();
      // Pairs that rest are no matter of the motion.
      if (checker_.find_contact(start, scratch_)) continue;
      const std::size_t r = asked % world_.robots.size();
      std::vector<double> to = start.q[r];
      for (double& q : to) q += from(-0.5, 0.5);
      ++asked;
      if (!checker_.is_within_limits(r, to)) continue;
      const auto answer = check_motion(checker_, start, r, {start.q[r], to}, {});
      if (answer.outcome != world::MotionAnswer::Outcome::Free) continue;
      ++free;
      double most = 0;
      for (std::size_t i = 0; i < to.size(); ++i)
        most = std::max(most, std::abs(to[i] - start.q[r][i]));
      const auto steps = static_cast<std::size_t>(std::ceil(kSamples * most));
      WorldState state = start;
      for (std::size_t k = 0; k <= steps; ++k, ++samples) {
        for (std::size_t i = 0; i < to.size(); ++i)
          state.q[r][i] = start.q[r][i] + static_cast<double>(k) / static_cast<double>(steps) *
                                              (to[i] - start.q[r][i]);
        if (const auto pair = judge_.find_meeting(state, pairs_))
          report("in contact", state, *pair, wrong++);
      }
    }
    std::printf("%zu motions said to be free (of %zu), %zu samples: %zu in contact\n", free, asked,
                samples, wrong);
    return wrong;
  }

  [[nodiscard]] std::size_t pairs() const { return pairs_.size(); }

 private:
  double from(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void report(const char* what, const WorldState& state, const std::array<Item, 2>& pair,
              std::size_t before) const {
    if (before >= 5) return;
    std::printf("%s: %s and %s at", what, world_.name_of(pair[0]).c_str(),
                world_.name_of(pair[1]).c_str());
    for (const auto& q : state.q)
      for (const double x : q) std::printf(" %a", x);
    std::printf("\n");
  }

  const world::World& world_;
  const Judge& judge_;
  world::Checker checker_;
  world::Scratch scratch_;
  std::vector<std::array<Item, 2>> pairs_;
  std::mt19937_64 random_;
};

int run(int argc, char** argv) {
  const world::SceneFile scene = world::read_scene(argv[1]);
  const std::size_t count = std::stoull(argv[2]), segments = std::stoull(argv[3]);
  std::map<std::string, std::string> files;
  for (int i = 5; i < argc; ++i) {
    const std::string text = argv[i];
    files[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
  }
  const Judge judge(scene.world, files);
  Trial trial(scene.world, judge, std::stoull(argv[4]));
  std::printf("%s: %zu triangles, %zu meshes not closed, %zu pairs\n", argv[1], judge.triangles(),
              judge.open(), trial.pairs());
  Counts anywhere, near;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 2 == 0)
      trial.judge_state(trial.anywhere(), false, anywhere);
    else
      trial.judge_state(trial.at_contact(i % 4 == 1), true, near);
  }
  for (const auto& [name, c] : {std::pair{"anywhere", anywhere}, {"near contact", near}})
    std::printf(
        "%s: %zu configurations (%zu within twice epsilon of contact), %zu in contact, %zu said to "
        "be; of %zu pairs %zu said to be in contact, %zu missed, %zu false alarms; %.2f us each\n",
        name, c.configurations, c.near, c.contacts, c.said, c.pairs, c.said_pairs, c.missed,
        c.false_alarms,
        1e6 * c.predicate_seconds /
            static_cast<double>(std::max<std::size_t>(1, c.configurations)));
  std::size_t wrong = anywhere.missed + anywhere.false_alarms + near.missed + near.false_alarms;
  if (segments > 0) wrong += trial.judge_motions(segments);
  std::printf("%.0f s of CPU time\n", cpu_seconds());
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) {
    std::fprintf(stderr,
                 "usage: judged-benchmark SCENE CONFIGURATIONS SEGMENTS SEED NAME=FILE...\n");
    return 2;
  }
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "judged-benchmark: %s\n", error.what());
    return 1;
  }
}
