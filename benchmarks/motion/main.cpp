#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/motion/find_path.h>
#include <kaboum/motion/trajectory.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/scene.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>

#include "collision/random_cell.h"
#include "engine.h"

/// Paths for a robot of a scene among random objects: find_path, and RRT-Connect of OMPL with
/// configurations by the same predicates at its usual resolution, in one run; all by CPU time.
/// motion-benchmark SCENE URDF MESH [QUERIES]: the scene's first robot is that of the
/// URDF; its objects have the mesh, and are put somewhere by chance.
namespace {

using namespace kaboum;
namespace ob = ompl::base;
namespace og = ompl::geometric;
using Outcome = motion::PathAnswer::Outcome;
using Values = std::vector<double>;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print(const char* name, std::vector<double> seconds) {
  if (seconds.empty()) return;
  std::sort(seconds.begin(), seconds.end());
  double sum = 0;
  for (const double s : seconds) sum += s;
  const auto below = [&](double share) {
    return 1e3 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  std::printf("%-58s median %9.3f ms, mean %9.3f, 90 %% %9.3f, most %9.3f (%zu)\n", name,
              below(0.5), 1e3 * sum / static_cast<double>(seconds.size()), below(0.9), below(1),
              seconds.size());
}

struct Query {
  Values start, goal;
};

/// Ends that are free.
std::vector<Query> random_queries(const world::Checker& checker, std::size_t count,
                                  std::mt19937_64& random) {
  std::vector<Query> out(count);
  world::WorldState state = initial_state(checker.world());
  world::Scratch scratch;
  std::size_t tries = 0;
  for (Query& query : out)
    for (Values* end : {&query.start, &query.goal}) do {
        *end = state.q[0] = collide::random_values(checker.world().robots[0].kinematics, random);
        if (++tries > 100'000) throw Error(ErrorCode::LimitReached, "nearly nothing is free");
      } while (checker.find_contact(state, scratch));
  std::printf("%.0f %% of random configurations are free\n",
              200.0 * static_cast<double>(count) / static_cast<double>(tries));
  return out;
}

/// Samples at 1 kHz of a path's execution that are in contact by the exact meshes.
std::size_t contacts_on(const robot::Path& path, const robot::Robot& robot,
                        collide::Engine& engine) {
  const std::size_t count = path.front().size();
  const motion::Trajectory trajectory(path, {Values(count, 1), Values(count, 5)}, 1000);
  std::size_t out = 0;
  for (std::size_t k = 0; k < trajectory.samples(); ++k) {
    engine.place(forward(robot, trajectory.sample(k)));
    out += engine.collide() ? 1 : 0;
  }
  return out;
}

/// Times of finding, made shorter or not; what becomes of OMPL's paths when they are decided.
void run_ompl(const world::Checker& checker, const std::vector<Query>& queries) {
  const robot::Robot& robot = checker.world().robots[0].kinematics;
  const auto count = static_cast<unsigned>(robot.variables.size());
  std::vector<double> found, shorter;
  std::size_t certain[2] = {0, 0}, straight = 0;
  for (const Query& query : queries) {
    world::WorldState state = initial_state(checker.world());
    world::Scratch scratch;
    const auto space = std::make_shared<ob::RealVectorStateSpace>(count);
    ob::RealVectorBounds bounds(count);
    for (unsigned i = 0; i < count; ++i) {
      bounds.setLow(i, std::max(robot.variables[i].lower.value_or(-3), -3.2));
      bounds.setHigh(i, std::min(robot.variables[i].upper.value_or(3), 3.2));
    }
    space->setBounds(bounds);
    og::SimpleSetup setup(space);
    setup.setStateValidityChecker([&](const ob::State* s) {
      const double* values = s->as<ob::RealVectorStateSpace::StateType>()->values;
      state.q[0].assign(values, values + count);
      return !checker.find_contact(state, scratch);
    });
    ob::ScopedState<> start(space), goal(space);
    for (unsigned i = 0; i < count; ++i) {
      start[i] = query.start[i];
      goal[i] = query.goal[i];
    }
    setup.setStartAndGoalStates(start, goal);
    setup.setPlanner(std::make_shared<og::RRTConnect>(setup.getSpaceInformation()));
    const double begin = cpu_seconds();
    if (!setup.solve(10.0)) continue;
    found.push_back(cpu_seconds() - begin);
    const auto decide = [&] {
      robot::Path path;
      for (const ob::State* s : setup.getSolutionPath().getStates()) {
        const double* values = s->as<ob::RealVectorStateSpace::StateType>()->values;
        path.emplace_back(values, values + count);
      }
      straight += path.size() == 2 ? 1 : 0;
      return check_motion(checker, state, 0, path, {}).outcome == world::MotionAnswer::Outcome::Free
                 ? 1
                 : 0;
    };
    certain[0] += decide();
    straight = 0;
    const double middle = cpu_seconds();
    setup.simplifySolution();
    shorter.push_back(found.back() + cpu_seconds() - middle);
    certain[1] += decide();
  }
  print("OMPL, RRT-Connect, configurations only", found);
  print("and simplified", shorter);
  std::printf("of OMPL's paths %zu, simplified %zu of %zu are free at every instant\n", certain[0],
              certain[1], found.size());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) return 2;
  const std::size_t count = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 100;
  world::SceneFile scene = world::read_scene(argv[1]);
  world::World& world = scene.world;
  const robot::RobotFile file = robot::read_robot(argv[2]);
  const geom::Mesh object = io::read_mesh(argv[3]).mesh;
  const robot::Robot& robot = world.robots.at(0).kinematics;
  std::mt19937_64 random(7);
  collide::scatter_objects(world, random);
  const world::Checker checker(world);
  const std::vector<Query> queries = random_queries(checker, count, random);
  std::vector<double> times, round;
  std::size_t straight = 0, contacts = 0, samples = 0;
  const auto engine = collide::make_fcl(collide::triangles_of(world, file, object));
  motion::Spent spent;
  double work = 0, seconds = 0;
  for (const Query& query : queries) {
    const double begin = cpu_seconds();
    const motion::PathAnswer answer =
        motion::find_path(checker, initial_state(world), 0, query.start, {{query.goal}}, {});
    const double took = cpu_seconds() - begin;
    work += answer.spent.work;
    seconds += took;
    spent.configurations += answer.spent.configurations;
    spent.motions += answer.spent.motions;
    spent.intervals += answer.spent.intervals;
    spent.nodes += answer.spent.nodes;
    if (answer.outcome != Outcome::Found) {
      std::printf("not found: %s after %.2f s\n", name_of(answer.outcome), took);
      continue;
    }
    straight += answer.straight ? 1 : 0;
    times.push_back(took);
    if (!answer.straight) round.push_back(took);
    contacts += contacts_on(answer.path, robot, *engine);
    ++samples;
  }
  print("find_path, free at every instant, made shorter", times);
  print("of these round something", round);
  std::printf(
      "%zu of %zu found, %zu straight; %zu samples at 1 kHz in contact by the exact meshes; work "
      "of "
      "%.2f in %.2f s: %zu configurations, %zu motions, %zu intervals, %zu nodes\n",
      samples, count, straight, contacts, work, seconds, spent.configurations, spent.motions,
      spent.intervals, spent.nodes);
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl::RNG::setSeed(1);
  run_ompl(checker, queries);
  return contacts == 0 ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "motion-benchmark: %s\n", error.what());
  return 3;
}
