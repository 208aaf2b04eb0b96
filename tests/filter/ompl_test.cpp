// OMPL's planners over certified checks; the paths are judged by the checker.

#include <gtest/gtest.h>

#ifdef KABOUM_HAS_OMPL

#include <kaboum/filter/ompl.h>
#include <kaboum/robot/robot.h>
#include <kaboum/world/cloud.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <thread>

namespace kaboum::filter {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

constexpr const char* kPlanarArm = R"(<robot name="arm">
  <link name="base"/><link name="upper"/><link name="lower"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/></joint>
</robot>)";

/// A planar arm among posts, all of points.
world::World planar_cell() {
  world::World out;
  world::RobotModel robot;
  robot.name = "arm";
  robot.kinematics = robot::parse_urdf(kPlanarArm, "arm.urdf");
  robot.home = {0, 0};
  for (const std::uint32_t link : {1U, 2U})
    robot.shapes.push_back(
        {link,
         {{{"", {{{0.05, 0, 0}, {0.5, 0, 0}}, {}}, 0.03}}, collide::Direction::Outer, 0},
         {}});
  robot.allowed.push_back({1, 2, world::AllowedPair::Reason::Stated});
  out.robots.push_back(std::move(robot));
  std::vector<geom::Vec3> points;
  for (const auto& [x, y] : {std::pair(0.6, 0.35), {0.1, 0.75}, {-0.5, 0.5}})
    for (int i = 0; i < 40; ++i)
      points.emplace_back(x + 0.02 * std::cos(0.157 * i), y + 0.02 * std::sin(0.157 * i), 0);
  add_cloud(out, {.name = "posts", .points = points, .radius = 0.02});
  return out;
}

struct PlanarSetup {
  world::World world = planar_cell();
  world::Checker checker{world};
  std::shared_ptr<const OmplRobot> robot =
      std::make_shared<OmplRobot>(checker, initial_state(world), 0);
  std::shared_ptr<ob::RealVectorStateSpace> space = robot->make_space();
  og::SimpleSetup setup{space};

  PlanarSetup() {
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    // Once for all: OMPL takes no other one later.
    [[maybe_unused]] static const bool seeded = (ompl::RNG::setSeed(1), true);
    use_certified_checks(setup.getSpaceInformation(), robot);
  }
  [[nodiscard]] ob::ScopedState<ob::RealVectorStateSpace> at(double a, double b) const {
    ob::ScopedState<ob::RealVectorStateSpace> out(space);
    out->values[0] = a;
    out->values[1] = b;
    return out;
  }
};

TEST(Ompl, PathsAreFreeAtEveryInstant) {
  for (const bool roadmap : {false, true}) {
    PlanarSetup s;
    const auto& si = s.setup.getSpaceInformation();
    if (roadmap)
      s.setup.setPlanner(std::make_shared<og::PRM>(si));
    else
      s.setup.setPlanner(std::make_shared<og::RRTConnect>(si));
    s.setup.setStartAndGoalStates(s.at(0, 0), s.at(2, 0.5));
    ASSERT_FALSE(si->checkMotion(s.at(0, 0).get(), s.at(2, 0.5).get()));
    ASSERT_EQ(s.setup.solve(20.0), ob::PlannerStatus::EXACT_SOLUTION);
    s.setup.simplifySolution();
    robot::Path path;
    for (const ob::State* state : s.setup.getSolutionPath().getStates())
      path.push_back(ompl_detail::values_of(state, *s.robot));
    ASSERT_GT(path.size(), 2U);
    const auto answer = check_motion(s.checker, initial_state(s.world), 0, path, {});
    EXPECT_EQ(answer.outcome, world::MotionAnswer::Outcome::Free);
  }
}

TEST(Ompl, SpacesAreWithinLimits) {
  world::World world = planar_cell();
  robot::Robot& robot = world.robots[0].kinematics;
  robot.joints[1].type = robot::JointType::Prismatic;
  const auto bounds = [&] {
    const world::Checker checker(world);
    const ob::RealVectorBounds found =
        OmplRobot(checker, initial_state(world), 0).make_space()->getBounds();
    return std::array{found.low[1], found.high[1]};
  };
  EXPECT_EQ(bounds(), (std::array{-1.0, 1.0}));
  robot.variables[1].lower = 2;
  EXPECT_EQ(bounds(), (std::array{2.0, 3.0}));
  robot.variables[1].lower = {};
  robot.variables[1].upper = -2;
  EXPECT_EQ(bounds(), (std::array{-3.0, -2.0}));
}

/// A roadmap answers a second query with what the first one found.
TEST(Ompl, RoadmapsAreKept) {
  PlanarSetup s;
  const auto& si = s.setup.getSpaceInformation();
  const auto prm = std::make_shared<og::PRM>(si);
  s.setup.setPlanner(prm);
  s.setup.setStartAndGoalStates(s.at(0, 0), s.at(2, 0.5));
  ASSERT_EQ(s.setup.solve(20.0), ob::PlannerStatus::EXACT_SOLUTION);
  const auto milestones = prm->milestoneCount();
  prm->clearQuery();
  s.setup.getProblemDefinition()->clearSolutionPaths();
  s.setup.setStartAndGoalStates(s.at(2, 0.4), s.at(0.1, 0));
  ASSERT_EQ(s.setup.solve(20.0), ob::PlannerStatus::EXACT_SOLUTION);
  EXPECT_GE(prm->milestoneCount(), milestones);
  robot::Path path;
  for (const ob::State* state : s.setup.getSolutionPath().getStates())
    path.push_back(ompl_detail::values_of(state, *s.robot));
  EXPECT_EQ(check_motion(s.checker, initial_state(s.world), 0, path, {}).outcome,
            world::MotionAnswer::Outcome::Free);
}

TEST(Ompl, AnswersAreTheCheckers) {
  PlanarSetup s;
  const auto& si = s.setup.getSpaceInformation();
  si->setup();
  world::Scratch scratch;
  ompl::RNG random(7);
  std::size_t valid = 0, partly = 0;
  for (int i = 0; i < 300; ++i) {
    const auto from = s.at(random.uniformReal(-3, 3), random.uniformReal(-6, 6)),
               to = s.at(from->values[0] + random.uniformReal(-0.5, 0.5),
                         from->values[1] + random.uniformReal(-0.5, 0.5));
    const std::vector<double> a = ompl_detail::values_of(from.get(), *s.robot),
                              b = ompl_detail::values_of(to.get(), *s.robot);
    world::WorldState state = initial_state(s.world);
    state.q[0] = a;
    EXPECT_EQ(si->isValid(from.get()), s.checker.is_free(state, scratch));
    const auto exact = check_motion(s.checker, state, 0, {a, b}, {});
    const bool free = exact.outcome == world::MotionAnswer::Outcome::Free && std::abs(b[0]) <= 3;
    EXPECT_EQ(si->checkMotion(from.get(), to.get()), free);
    auto last_state = s.at(0, 0);
    std::pair<ob::State*, double> last{last_state.get(), -1};
    EXPECT_EQ(si->getMotionValidator()->checkMotion(from.get(), to.get(), last), free);
    valid += free ? 1 : 0;
    if (free) continue;
    EXPECT_GE(last.second, 0);
    EXPECT_LT(last.second, 1);
    if (last.second > 0) {
      ++partly;
      const std::vector<double> end = ompl_detail::values_of(last_state.get(), *s.robot);
      for (int k = 0; k <= 100; ++k) {
        for (int v = 0; v < 2; ++v) state.q[0][v] = a[v] + 0.01 * k * (end[v] - a[v]);
        EXPECT_TRUE(s.checker.is_free(state, scratch)) << k;
      }
    }
  }
  EXPECT_GT(valid, 50U);
  EXPECT_GT(partly, 5U);
  EXPECT_EQ(si->getMotionValidator()->getValidMotionCount(), 2 * valid);
  EXPECT_FALSE(si->isValid(s.at(3.1, 0).get()));  // beyond a limit
}

TEST(Ompl, ThreadsShareIt) {
  PlanarSetup s;
  std::vector<std::thread> threads;
  std::vector<std::size_t> free(4, 0);
  for (std::size_t t = 0; t < free.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 300; ++i) {
        const double a = -3 + 0.02 * i;
        free[t] += s.robot->is_free({a, 1}) ? 1 : 0;
        free[t] += s.robot->free_share({a, 1}, {-a, 2}) < 1 ? 0 : 1000;
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::size_t count : free) EXPECT_EQ(count, free[0]);
}

TEST(Ompl, OtherSpacesAreRefused) {
  const PlanarSetup s;
  const auto si =
      std::make_shared<ob::SpaceInformation>(std::make_shared<ob::RealVectorStateSpace>(3));
  EXPECT_THROW(use_certified_checks(si, s.robot), Error);
}

}  // namespace
}  // namespace kaboum::filter

#else

TEST(Ompl, NeedsLibomplDev) { GTEST_SKIP() << "libompl-dev is not installed"; }

#endif
