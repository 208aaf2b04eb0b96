#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>

#include "engine.h"
#include "random_cell.h"
#include "timing.h"

/// One robot of a scene among random objects: configurations and segments by libworld, and the same
/// states by FCL on the exact meshes and on the bounding sets, in one run.
/// world-benchmark SCENE URDF MESH [CONFIGURATIONS [SEGMENTS]]: the scene's first robot is that of
/// the URDF; each of its objects has the mesh, and is put somewhere by chance.
namespace {

using namespace kaboum;
using collide::Engine;
using collide::Model;

void print(const char* name, const collide::Statistics& s, double against = 0) {
  std::printf("%-46s mean %9.2f us, median %9.2f, 99 %% %9.2f, most %9.2f", name, s.mean, s.median,
              s.p99, s.most);
  if (against > 0) std::printf(" (%.1f times)", s.mean / against);
  std::printf("\n");
}

std::vector<world::WorldState> random_states(const world::Checker& checker, std::size_t count,
                                             std::mt19937_64& random) {
  std::vector<world::WorldState> out(count, initial_state(checker.world()));
  for (world::WorldState& s : out)
    s.q[0] = collide::random_values(checker.world().robots[0].kinematics, random);
  return out;
}

/// Between a state that is free and one that is not, both sides of where it changes.
std::vector<world::WorldState> states_near_contact(const world::Checker& checker, std::size_t count,
                                                   std::mt19937_64& random) {
  std::vector<world::WorldState> out;
  world::Scratch scratch;
  while (out.size() < count) {
    std::vector<world::WorldState> ends = random_states(checker, 2, random);
    const bool first = checker.find_contact(ends[0], scratch).has_value();
    if (first == checker.find_contact(ends[1], scratch).has_value()) continue;
    world::WorldState middle = ends[0];
    for (int step = 0; step < 9; ++step) {
      for (std::size_t i = 0; i < middle.q[0].size(); ++i)
        middle.q[0][i] = 0.5 * (ends[0].q[0][i] + ends[1].q[0][i]);
      ends[checker.find_contact(middle, scratch).has_value() == first ? 0 : 1] = middle;
    }
    out.push_back(ends[random() % 2]);
  }
  return out;
}

struct Models {
  Model triangles{"triangles", false, 0, {}, {}}, sets{"bounding sets", true, 0, {}, {}};
};

Models models_of(const world::World& world, const robot::RobotFile& file,
                 const geom::Mesh& object) {
  Models out;
  out.triangles = collide::triangles_of(world, file, object);
  for (const world::LinkShape& shape : world.robots[0].shapes)
    for (std::size_t i = 0; i < shape.outer.size(); ++i)
      out.sets.robot.push_back({shape.link, geom::surface_of(shape.outer.body(i))});
  for (const world::Object& o : world.objects) {
    for (std::size_t i = 0; i < o.outer.size(); ++i)
      out.sets.scene.push_back(collide::placed(geom::surface_of(o.outer.body(i)), o.pose));
  }
  std::printf("%zu bodies of the robot, %zu objects with %zu bodies (mesh of %zu triangles)\n",
              out.sets.robot.size(), world.objects.size(), out.sets.scene.size(),
              object.triangles.size());
  return out;
}

/// The states by libworld and by FCL. @return how many contacts of the meshes libworld misses.
std::size_t compare(const char* title, const world::Checker& checker,
                    const std::vector<world::WorldState>& states, const Models& models) {
  std::printf("%s\n", title);
  const std::size_t count = states.size();
  std::vector<double> times;
  std::vector<char> ours(count), exact(count), fcl(count), trees(count);
  world::Scratch scratch;
  const auto own = collide::times_of(
      count, [&](std::size_t i) { ours[i] = checker.is_free(states[i], scratch) ? 0 : 1; }, times);
  print("libworld", own);
  const auto run = [&](const char* name, std::unique_ptr<Engine> engine,
                       std::vector<char>& answers) {
    const auto s = collide::times_of(
        count,
        [&](std::size_t i) {
          engine->place(forward(checker.world().robots[0].kinematics, states[i].q[0]));
          answers[i] = engine->collide() ? 1 : 0;
        },
        times);
    print(name, s, own.mean);
    return s;
  };
  run("FCL, exact meshes", collide::make_fcl(models.triangles), exact);
  run("FCL, bounding sets", collide::make_fcl(models.sets), fcl);
  run("trees of boxes, FCL with libccd, bounding sets", collide::make_fcl_tree(models.sets), trees);
  // Sets hold the meshes: who misses a contact of these by the sets is wrong about one of them.
  const auto count_missed = [&](const char* name, const std::vector<char>& by_sets) {
    std::size_t missed = 0;
    for (std::size_t i = 0; i < count; ++i) missed += exact[i] != 0 && by_sets[i] == 0 ? 1 : 0;
    std::printf("%s misses %zu contacts of the exact meshes\n", name, missed);
  };
  std::vector<char> others(count);
  // Bullet takes up to a second for a pair of meshes in contact.
  run("Bullet, bounding sets", collide::make_bullet(models.sets), others);
  count_missed("Bullet, bounding sets,", others);
  run("ODE, exact meshes", collide::make_ode(models.triangles), others);
  run("ODE, bounding sets", collide::make_ode(models.sets), others);
  count_missed("FCL, bounding sets,", fcl);
  std::size_t missed = 0, more = 0, contacts = 0, other = 0;
  for (std::size_t i = 0; i < count; ++i) {
    contacts += exact[i] != 0 ? 1 : 0;
    missed += exact[i] != 0 && ours[i] == 0 ? 1 : 0;
    more += exact[i] == 0 && ours[i] != 0 ? 1 : 0;
    other += fcl[i] != ours[i] ? 1 : 0;
  }
  std::printf(
      "%zu of %zu in contact by exact meshes: %zu missed; %zu in contact by the sets only; "
      "FCL on the sets differs in %zu\n",
      contacts, count, missed, more, other);
  return missed;
}

/// Segments of up to 0.5 rad per joint that are free at their ends. @return samples of those said
/// to be free that are in contact by the exact meshes.
std::size_t check_segments(const world::Checker& checker, std::size_t count,
                           std::mt19937_64& random, const Models& models) {
  const robot::Robot& robot = checker.world().robots[0].kinematics;
  std::uniform_real_distribution<double> from(-0.5, 0.5);
  world::Scratch scratch;
  std::vector<robot::Path> paths;
  while (paths.size() < count) {
    std::vector<world::WorldState> ends = random_states(checker, 2, random);
    ends[1].q[0] = ends[0].q[0];
    for (double& q : ends[1].q[0]) q += from(random);
    if (checker.find_contact(ends[0], scratch) || checker.find_contact(ends[1], scratch)) continue;
    paths.push_back({ends[0].q[0], ends[1].q[0]});
  }
  std::vector<world::MotionAnswer> answers(count);
  std::vector<double> times;
  const world::WorldState start = initial_state(checker.world());
  print(
      "a segment at every instant",
      collide::times_of(
          count, [&](std::size_t i) { answers[i] = check_motion(checker, start, 0, paths[i], {}); },
          times));
  double free_time = 0;
  std::size_t free = 0, in_contact = 0, intervals = 0;
  const auto engine = collide::make_fcl(models.triangles);
  for (std::size_t i = 0; i < count; ++i) {
    if (answers[i].outcome != world::MotionAnswer::Outcome::Free) continue;
    ++free;
    free_time += times[i];
    intervals += answers[i].intervals;
    for (int k = 0; k <= 500; ++k) {
      std::vector<double> q = paths[i][0];
      for (std::size_t j = 0; j < q.size(); ++j) q[j] += k / 500.0 * (paths[i][1][j] - q[j]);
      engine->place(forward(robot, q));
      in_contact += engine->collide() ? 1 : 0;
    }
  }
  const auto least = static_cast<double>(std::max<std::size_t>(free, 1));
  std::printf(
      "of %zu segments %zu are free: %.1f us each, %.1f intervals; %zu of their samples "
      "in contact by exact meshes\n",
      count, free, free_time / least, static_cast<double>(intervals) / least, in_contact);
  return in_contact;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const std::size_t count = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 2000;
  const std::size_t segments = argc > 5 ? std::strtoull(argv[5], nullptr, 10) : 500;
  world::SceneFile scene = world::read_scene(argv[1]);
  world::World& world = scene.world;
  const robot::RobotFile file = robot::read_robot(argv[2]);
  const geom::Mesh object = io::read_mesh(argv[3]).mesh;
  world::RobotModel& robot = world.robots.at(0);
  // Engines look at the robot against the objects only; so does libworld here.
  robot.allowed.clear();
  for (std::uint32_t a = 0; a < robot.kinematics.links.size(); ++a)
    for (std::uint32_t b = a + 1; b < robot.kinematics.links.size(); ++b)
      robot.allowed.push_back({a, b, world::AllowedPair::Reason::Stated});
  std::mt19937_64 random(7);
  collide::scatter_objects(world, random);
  const world::Checker checker(world);
  const std::vector<world::WorldState> anywhere = random_states(checker, count, random),
                                       near = states_near_contact(checker, count, random);
  const Models models = models_of(world, file, object);
  std::size_t wrong = compare("Configurations anywhere:", checker, anywhere, models);
  wrong += compare("Configurations near contact:", checker, near, models);
  wrong += check_segments(checker, segments, random, models);
  return wrong == 0 ? 0 : 1;
}
