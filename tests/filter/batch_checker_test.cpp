// Batches of configurations against the checker, against kinematics in long double, and mutants of
// the error bounds, which have to be noticed.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/filter/motion_checker.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/robot.h>
#include <kaboum/world/cloud.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "lanes.h"
#include "model.h"

namespace kaboum::filter {
namespace {

using Answer = BatchChecker::Answer;
using collide::BoundingSet;
using geom::ConvexBody;
using geom::Vec3;
using world::World;

/// Seven joints, one of them a slide, one that mimics; links that a ball, a capsule and polytopes
/// hold.
constexpr const char* kArm = R"(<robot name="arm">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/>
  <link name="l5"/><link name="l6"/><link name="tip"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/>
    <origin xyz="0 0 0.3" rpy="0 0 0.2"/><axis xyz="0 0 1"/>
    <limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/>
    <origin xyz="0 0.02 0" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1.8" upper="1.8" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/>
    <origin xyz="0 -0.32 0" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 -1"/>
    <limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/>
    <origin xyz="0.08 0 0.1" rpy="0.3 -0.4 1.1"/><axis xyz="0.6 0 0.8"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j5" type="prismatic"><parent link="l4"/><child link="l5"/>
    <origin xyz="0 0.1 0.2" rpy="0 0.5 0"/><axis xyz="1 0 0"/>
    <limit lower="-0.1" upper="0.3" effort="1" velocity="1"/></joint>
  <joint name="j6" type="continuous"><parent link="l5"/><child link="l6"/>
    <origin xyz="0.1 0 0.1"/><axis xyz="0 1 0"/></joint>
  <joint name="j7" type="revolute"><parent link="l6"/><child link="tip"/>
    <origin xyz="0.05 0 0.12" rpy="0 0 1"/><axis xyz="1 0 0"/><mimic joint="j2" multiplier="-0.7" offset="0.4"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
</robot>)";

ConvexBody ball(const Vec3& center, double radius) { return {"", {{center}, {}}, radius}; }
ConvexBody capsule(const Vec3& a, const Vec3& b, double radius) {
  return {"", {{a, b}, {}}, radius};
}
ConvexBody polytope(std::uint64_t seed, int points, const Vec3& scale, double radius = 0) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3> out;
  for (int i = 0; i < points; ++i)
    out.emplace_back(
        Vec3(normal(random), normal(random), normal(random)).normalized().cwiseProduct(scale));
  return {"", *geom::convex_hull(out), radius};
}
ConvexBody box(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back((k & 1) != 0 ? half.x() : -half.x(), (k & 2) != 0 ? half.y() : -half.y(),
                         (k & 4) != 0 ? half.z() : -half.z());
  return {"", *geom::convex_hull(corners), 0};
}

world::LinkShape shape(std::uint32_t link, std::vector<ConvexBody> bodies) {
  return {link, BoundingSet(std::move(bodies), collide::Direction::Outer, 0), {}};
}

geom::Transform pose(double yaw, double pitch, const Vec3& at) {
  return {robot::rotation_from_rpy(0.1, pitch, yaw), at};
}

void add_object(World& world, const std::string& name, const geom::Transform& at,
                std::vector<ConvexBody> bodies) {
  world::Object object{.name = name,
                       .pose = at,
                       .outer = BoundingSet(std::move(bodies), collide::Direction::Outer, 0),
                       .inner = {},
                       .features = {},
                       .grasps = {}};
  world.objects.push_back(std::move(object));
  world.attachments.emplace_back();
}

/// @param round  links of balls and capsules only, which the vector code knows exactly
World cell(bool round) {
  World out;
  world::RobotModel arm;
  arm.name = "arm";
  arm.kinematics = robot::parse_urdf(kArm, "arm.urdf");
  arm.base = pose(0.7, 0.2, {3, -2, 1});
  arm.home.assign(arm.kinematics.variables.size(), 0.0);
  if (round) {
    arm.shapes.push_back(shape(3, {ball({0, 0, 0.05}, 0.08)}));
    arm.shapes.push_back(shape(7, {ball({0.05, 0.02, 0.1}, 0.05)}));
  } else {
    arm.shapes.push_back(shape(0, {box({0.1, 0.1, 0.15})}));
    arm.shapes.push_back(shape(1, {capsule({0, 0, 0}, {0, 0, 0.1}, 0.09)}));
    arm.shapes.push_back(shape(2, {polytope(1, 40, {0.08, 0.2, 0.08})}));
    arm.shapes.push_back(
        shape(4, {polytope(2, 30, {0.06, 0.06, 0.15}, 0.01), box({0.05, 0.1, 0.02})}));
    arm.shapes.push_back(shape(5, {box({0.2, 0.03, 0.04})}));
    arm.shapes.push_back(shape(7, {polytope(3, 30, {0.05, 0.05, 0.12}), ball({0, 0, 0.1}, 0.06)}));
    for (const auto& [a, b] : {std::array<std::uint32_t, 2>{0, 1}, {1, 2}, {4, 5}, {2, 4}})
      arm.allowed.push_back({a, b, world::AllowedPair::Reason::Stated});
  }
  out.robots.push_back(std::move(arm));
  add_object(out, "table", pose(0.3, 0, {3.8, -2, 0.9}), {box({0.4, 0.6, 0.1})});
  add_object(out, "post", pose(-0.3, 0.1, {2.8, -1.4, 1.4}),
             {capsule({0, 0, -0.4}, {0, 0, 0.4}, 0.05)});
  add_object(out, "stone", pose(1, 0.4, {3.3, -2.5, 1.6}),
             {polytope(5, 25, {0.2, 0.15, 0.1}, 0.02)});
  add_object(out, "pile", pose(0, 0, {2.5, -2.2, 1.3}),
             {ball({0, 0, 0}, 0.15), ball({0, 0.2, 0.1}, 0.1), box({0.05, 0.3, 0.05})});
  return out;
}

std::vector<double> random_rows(const World& world, std::size_t count, std::uint64_t seed,
                                double share = 1) {
  std::mt19937_64 random(seed);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i)
    for (const robot::Variable& v : world.robots[0].kinematics.variables)
      out.push_back(share * std::uniform_real_distribution<double>(v.lower.value_or(-9),
                                                                   v.upper.value_or(9))(random));
  return out;
}

std::vector<std::uint8_t> by_checker(const world::Checker& checker,
                                     const std::vector<double>& rows) {
  const std::size_t n = checker.world().robots[0].kinematics.variables.size();
  world::Scratch scratch;
  world::WorldState state = initial_state(checker.world());
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < rows.size(); i += n) {
    state.q[0].assign(rows.begin() + static_cast<std::ptrdiff_t>(i),
                      rows.begin() + static_cast<std::ptrdiff_t>(i + n));
    out.push_back(checker.is_free(state, scratch) ? 1 : 0);
  }
  return out;
}

/// Rows next to where a configuration begins or ceases to be free, `offsets` apart from it on the
/// way between two random ones.
std::vector<double> rows_at_contact(const world::Checker& checker, std::size_t count,
                                    std::uint64_t seed, const std::vector<double>& offsets) {
  const World& world = checker.world();
  const std::size_t n = world.robots[0].kinematics.variables.size();
  std::vector<double> out;
  for (std::size_t round = 0; out.size() < count * n && round < 100 * count; ++round) {
    const std::vector<double> ends = random_rows(world, 2, seed + round);
    const auto at = [&](double share) {
      std::vector<double> q(n);
      for (std::size_t i = 0; i < n; ++i) q[i] = ends[i] + share * (ends[n + i] - ends[i]);
      return q;
    };
    const auto is_free = [&](double share) { return by_checker(checker, at(share))[0]; };
    const auto first = is_free(0);
    if (first == is_free(1)) continue;
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (is_free(middle) == first ? low : high) = middle;
    }
    for (const double offset : offsets)
      for (const double share : {low - offset, low + offset}) {
        const std::vector<double> q = at(std::clamp(share, 0.0, 1.0));
        out.insert(out.end(), q.begin(), q.end());
      }
  }
  return out;
}

std::vector<Answer> answers_of(const detail::Model& model, Instructions set,
                               const std::vector<double>& rows) {
  std::vector<Answer> out(rows.size() / model.variables);
  detail::LaneMemory memory(model);
  detail::filter_rows(model, set, rows.data(), nullptr, out.size(), memory, out.data());
  return out;
}

/// Answers that are wrong: free and in contact, in contact and free.
std::array<std::size_t, 2> wrong_answers(const std::vector<Answer>& answers,
                                         const std::vector<std::uint8_t>& free) {
  std::array<std::size_t, 2> out{};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    out[0] += answers[i] == Answer::Free && free[i] == 0 ? 1 : 0;
    out[1] += answers[i] == Answer::Contact && free[i] == 1 ? 1 : 0;
  }
  return out;
}

TEST(BatchChecker, AnswersAsTheCheckerDoes) {
  const World world = cell(false);
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  for (const std::vector<double>& rows :
       {random_rows(world, 6000, 1),
        rows_at_contact(checker, 1500, 100, {0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3})}) {
    std::vector<std::uint8_t> free(rows.size() / batch.variables());
    const BatchCounts counts = batch.decide(rows, free);
    EXPECT_EQ(free, by_checker(checker, rows));
    EXPECT_EQ(counts.free + counts.contact, free.size());
    EXPECT_GT(counts.free, free.size() / 20);
    EXPECT_GT(counts.contact, free.size() / 20);
  }
}

/// Fixed joints that go far out and come back leave rounding that is large against all that is
/// left.
TEST(BatchChecker, AnswersAsTheCheckerDoesBehindFixedJointsThatCancel) {
  constexpr double kFar = 1e8;
  robot::Robot robot;
  robot.name = "arm";
  for (const char* name : {"base", "l1", "l2", "l3"}) robot.links.emplace_back().name = name;
  robot.variables.push_back({"j", -3.0, 3.0});
  robot::Joint turn, out, back;
  turn.name = "j";
  turn.type = robot::JointType::Revolute;
  turn.axis = Vec3(1, 2, -1.5).normalized();
  out.name = "out";
  out.parent = 1;
  out.origin = {robot::rotation_from_rpy(0.3, 0.2, 0.7), {kFar, 0.7 * kFar, -0.3 * kFar}};
  back.name = "back";
  back.parent = 2;
  const Eigen::Matrix3d turned = out.origin.linear.transpose();
  back.origin = {turned, -(turned * out.origin.translation) + turned * Vec3(1e-3, 0, 0)};
  robot.joints = {turn, out, back};
  World world;
  world::RobotModel arm;
  arm.name = "arm";
  arm.kinematics = robot;
  arm.home = {0.0};
  arm.shapes.push_back(shape(3, {ball({0, 0, 0}, 1e-4)}));
  world.robots.push_back(arm);
  world::Scratch scratch;
  world::WorldState state = initial_state(world);
  state.q[0][0] = 1;
  const auto place = world::Checker(world).places(state, {{0, 0}}, scratch).front().place;
  EXPECT_GT(place.error(), 1e-16 * kFar);
  add_object(world, "stone", {Eigen::Matrix3d::Identity(), place.pose().translation},
             {ball({0, 0, 0}, 1e-4)});
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  std::vector<double> rows;
  for (double q = 0.7; q < 1.3; q += 1e-4) rows.push_back(q);
  std::vector<Answer> answers(rows.size());
  batch.filter(rows, answers);
  EXPECT_EQ(wrong_answers(answers, by_checker(checker, rows)), (std::array<std::size_t, 2>{0, 0}));
  // With the error of what is left alone, contacts would be missed.
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 10);
  EXPECT_GT(model.outer[0].radius, 1e-4 + 2.5 * place.error());
}

TEST(BatchChecker, DecidesManyByFloats) {
  const World world = cell(false);
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  const std::vector<double> rows = random_rows(world, 4000, 2);
  std::vector<std::uint8_t> free(rows.size() / batch.variables());
  EXPECT_LT(batch.decide(rows, free).exactly, free.size() * 2 / 3);
}

TEST(BatchChecker, KeepsMargins) {
  World world = cell(false);
  world.margins.all = 0.03;
  world.margins.between[{world::Item{0, 3}, world::Item{world::Item::kObject, 0}}] = 0.2;
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  const std::vector<double> rows = rows_at_contact(checker, 1500, 7, {1e-6, 1e-4, 1e-3});
  std::vector<std::uint8_t> free(rows.size() / batch.variables());
  batch.decide(rows, free);
  EXPECT_EQ(free, by_checker(checker, rows));
}

TEST(BatchChecker, LeavesValuesBeyondLimitsToTheChecker) {
  const World world = cell(false);
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  std::vector<double> rows = random_rows(world, 300, 3, 1.5);
  rows[5] = 1e8;
  std::vector<std::uint8_t> free(rows.size() / batch.variables());
  batch.decide(rows, free);
  EXPECT_EQ(free, by_checker(checker, rows));
  rows[3] = NAN;
  EXPECT_THROW(batch.decide(rows, free), Error);
  EXPECT_THROW(batch.decide({rows.data(), 3}, free), Error);
}

TEST(BatchChecker, SeesContactsThatItsRobotHasNoPartIn) {
  World world = cell(true);
  world.robots.push_back(world.robots[0]);
  world.robots[1].name = "other";
  world.robots[1].base.translation = world.objects[3].pose.translation - Vec3(0, 0, 0.3);
  for (const double up : {0.0, 5.0}) {
    world.robots[1].base.translation.z() += up;
    const world::Checker checker(world);
    const BatchChecker batch(checker, initial_state(world), 0, {});
    const std::vector<double> rows = random_rows(world, 500, 4);
    std::vector<std::uint8_t> free(rows.size() / batch.variables());
    batch.decide(rows, free);
    EXPECT_EQ(free, by_checker(checker, rows));
  }
}

TEST(BatchChecker, LeavesWhatIsCarriedToTheChecker) {
  World world = cell(false);
  world.attachments[3] = world::Attachment{0, 7, {}, {}};
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  const std::vector<double> rows = random_rows(world, 300, 5);
  std::vector<std::uint8_t> free(rows.size() / batch.variables());
  EXPECT_EQ(batch.decide(rows, free).exactly, free.size());
  EXPECT_EQ(free, by_checker(checker, rows));
}

TEST(Lanes, AnswersAreTheSameForAllInstructions) {
  const World world = cell(false);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 150);
  const std::vector<double> rows = random_rows(world, 5003, 6);
  const std::vector<Answer> expected = answers_of(model, Instructions::Baseline, rows);
  detail::LaneMemory memory(model);
  std::vector<float> centers(3 * model.outer.size() * 50), others(centers.size());
  detail::place_outer_balls(model, Instructions::Baseline, rows.data(), 50, memory, centers.data());
  for (const Instructions set : instruction_sets()) {
    EXPECT_EQ(answers_of(model, set, rows), expected) << name_of(set);
    detail::place_outer_balls(model, set, rows.data(), 50, memory, others.data());
    EXPECT_EQ(std::memcmp(centers.data(), others.data(), centers.size() * sizeof(float)), 0);
  }
}

TEST(Lanes, SinesErrByLessThanIsClaimed) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1000, 1000), few(-0.8, 0.8);
  std::vector<double> angles;
  for (int i = 0; i < 200'000; ++i) angles.push_back(i % 2 == 0 ? any(random) : few(random));
  for (int i = -600; i < 600; ++i)
    for (const double off : {-1e-9, 0.0, 1e-9}) angles.push_back(i * 0.25 * std::numbers::pi + off);
  for (const Instructions set : instruction_sets()) {
    std::vector<float> sines(angles.size()), cosines(angles.size());
    detail::sines_of(set, angles.data(), angles.size(), sines.data(), cosines.data());
    long double most = 0;
    for (std::size_t i = 0; i < angles.size(); ++i)
      most = std::max({most, std::abs(sines[i] - std::sin(static_cast<long double>(angles[i]))),
                       std::abs(cosines[i] - std::cos(static_cast<long double>(angles[i])))});
    EXPECT_LT(most, 4 * 0x1p-24L) << name_of(set);
    EXPECT_GT(most, 0.5 * 0x1p-24L);
  }
}

/// Motions that are free, or not, at samples and by check_motion.
TEST(BatchChecker, MotionsThatAreFreeAreFreeAtEveryInstant) {
  for (const bool round : {false, true}) {
    const World world = cell(round);
    const world::Checker checker(world);
    const BatchChecker batch(checker, initial_state(world), 0, {});
    const std::size_t n = batch.variables(), count = 400;
    const std::vector<double> from = random_rows(world, count, 11),
                              ends = random_rows(world, count, 12);
    std::vector<double> to;
    for (std::size_t i = 0; i < from.size(); ++i)
      to.push_back(from[i] + (i / n % 3 == 0 ? 1 : 0.15) * (ends[i] - from[i]));
    std::vector<std::uint8_t> free(count);
    const BatchCounts counts = batch.decide_motions(from, to, free, {});
    EXPECT_EQ(counts.free + counts.contact, count);
    EXPECT_GT(counts.free, count / 20);
    EXPECT_GT(counts.contact, count / 20);
    EXPECT_LT(counts.exactly, count * 3 / 4);
    world::Scratch scratch;
    world::WorldState state = initial_state(world);
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = [&](double share) {
        std::vector<double> q(n);
        for (std::size_t k = 0; k < n; ++k)
          q[k] = from[i * n + k] + share * (to[i * n + k] - from[i * n + k]);
        return q;
      };
      bool seen = false;
      for (int k = 0; k <= 400 && !seen; ++k) {
        state.q[0] = at(k / 400.0);
        seen = !checker.is_free(state, scratch);
      }
      if (seen) {
        EXPECT_EQ(free[i], 0) << i;
      }
      if (!seen && free[i] == 0) {  // between samples, or nearer than the resolution
        const auto exact = check_motion(checker, state, 0, {at(0), at(1)}, {});
        EXPECT_EQ(exact.outcome, world::MotionAnswer::Outcome::Contact) << i;
      }
    }
  }
}

/// Batches of motions say what check_motion says, at resolutions that matter as well; vector code
/// that knows no resolution would call some free that come too near.
TEST(BatchChecker, MotionsAreAsCheckMotionHasThem) {
  const World world = cell(false);
  const world::Checker checker(world);
  const BatchChecker batch(checker, initial_state(world), 0, {});
  const std::size_t n = batch.variables(), count = 500;
  const std::vector<double> from = random_rows(world, count, 41),
                            ends = random_rows(world, count, 42);
  std::vector<double> to;
  for (std::size_t i = 0; i < from.size(); ++i) to.push_back(from[i] + 0.1 * (ends[i] - from[i]));
  world::MotionOptions fine;
  fine.resolution = 1e-9;
  std::vector<std::uint8_t> finest(count);
  batch.decide_motions(from, to, finest, fine);
  std::size_t nearer = 0;
  for (const double resolution : {1e-5, 0.02, 0.2}) {
    world::MotionOptions options;
    options.resolution = resolution;
    std::vector<std::uint8_t> free(count);
    batch.decide_motions(from, to, free, options);
    options.where = false;
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = [&](const std::vector<double>& of) {
        return std::vector<double>(of.begin() + static_cast<std::ptrdiff_t>(i * n),
                                   of.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
      };
      const auto exact =
          check_motion(checker, initial_state(world), 0, {row(from), row(to)}, options);
      EXPECT_EQ(free[i] != 0, exact.outcome == world::MotionAnswer::Outcome::Free)
          << i << " at " << resolution;
      nearer += free[i] != finest[i] ? 1 : 0;
    }
  }
  EXPECT_GT(nearer, 5U);
  fine.resolution = 0;
  EXPECT_THROW(batch.decide_motions(from, to, finest, fine), Error);
}

/// Straight ways from rows: w of row + s·w, within the limits.
std::vector<double> ways_from(const detail::Model& model, const std::vector<double>& rows,
                              double longest, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<double> out;
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.push_back(longest * share(random) *
                  std::min(1.0, std::min(rows[i] - model.low[i % model.variables],
                                         model.high[i % model.variables] - rows[i])));
  return out;
}

/// Rows that are called free with their ways, and are not free somewhere on these.
std::size_t count_wrong(const world::Checker& checker, const std::vector<double>& rows,
                        const std::vector<double>& ways, const std::vector<Answer>& answers) {
  constexpr int kPlaces = 20;
  const std::size_t n = rows.size() / answers.size();
  std::vector<double> places;
  for (std::size_t i = 0; i < answers.size(); ++i)
    for (int p = -kPlaces; answers[i] == Answer::Free && p <= kPlaces; ++p)
      for (std::size_t k = 0; k < n; ++k)
        places.push_back(rows[i * n + k] + p / double{kPlaces} * ways[i * n + k]);
  const std::vector<std::uint8_t> free = by_checker(checker, places);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < free.size(); i += 2 * kPlaces + 1)
    wrong += std::ranges::count(std::span(free).subspan(i, 2 * kPlaces + 1), 0) > 0 ? 1 : 0;
  return wrong;
}

/// Where points are in a stretch is bounded; bounds that are too small are noticed.
TEST(Lanes, StretchesHoldAllTheirConfigurations) {
  const World world = cell(true);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 10);
  detail::Model slow = model, straight = model;
  for (detail::Step& step : slow.steps) step.factor *= 0.1F;  // less of a way, and of its bend
  straight.bend = 0;
  EXPECT_EQ(model.bend, 1);  // it has a slide
  std::mt19937_64 random(3);
  const auto filtered = [](const detail::Model& of, Instructions set,
                           const std::vector<double>& rows, const std::vector<double>& ways) {
    std::vector<Answer> out(rows.size() / of.variables);
    detail::LaneMemory memory(of);
    detail::filter_rows(of, set, rows.data(), ways.data(), out.size(), memory, out.data());
    return out;
  };
  std::size_t free = 0, of_slow = 0, of_straight = 0;
  for (const double longest : {0.05, 0.5}) {
    const std::vector<double> rows = rows_at_contact(
        checker, 12000, 13, {longest * 2e-3, longest * 2e-2, longest * 6e-2, longest * 0.2});
    const std::vector<double> ways = ways_from(model, rows, longest, random);
    const std::vector<Answer> answers = filtered(model, instruction_sets().back(), rows, ways);
    for (const Instructions set : instruction_sets())
      EXPECT_EQ(filtered(model, set, rows, ways), answers) << name_of(set);
    free += static_cast<std::size_t>(std::ranges::count(answers, Answer::Free));
    EXPECT_EQ(count_wrong(checker, rows, ways, answers), 0U);
    of_slow +=
        count_wrong(checker, rows, ways, filtered(slow, instruction_sets().back(), rows, ways));
    of_straight +=
        count_wrong(checker, rows, ways, filtered(straight, instruction_sets().back(), rows, ways));
  }
  EXPECT_GT(free, 300U);
  EXPECT_GT(of_slow, 5U);
  EXPECT_GT(of_straight, 5U);
}

/// Kinematics in long double, by Rodrigues' formula: another way than the vector code's.
std::array<long double, 3> place_by_long_double(const world::RobotModel& robot,
                                                const std::vector<double>& q, std::uint32_t link,
                                                const Vec3& point) {
  using Vec = Eigen::Matrix<long double, 3, 1>;
  Vec p = point.cast<long double>();
  for (std::uint32_t l = link; l > 0; l = robot.kinematics.joints[l - 1].parent) {
    const robot::Joint& joint = robot.kinematics.joints[l - 1];
    const Vec axis = joint.axis.cast<long double>().normalized();
    const long double x =
        joint.type == robot::JointType::Fixed
            ? 0
            : static_cast<long double>(joint.multiplier) * q[joint.variable] + joint.offset;
    if (joint.type == robot::JointType::Revolute)
      p = p * std::cos(x) + axis.cross(p) * std::sin(x) + axis * axis.dot(p) * (1 - std::cos(x));
    if (joint.type == robot::JointType::Prismatic) p += x * axis;
    p = joint.origin.linear.cast<long double>() * p + joint.origin.translation.cast<long double>();
  }
  p = robot.base.linear.cast<long double>() * p;
  return {p.x(), p.y(), p.z()};
}

TEST(Lanes, BallsAreWithinTheirErrorOfWhereTheyAre) {
  const World world = cell(true);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 10);
  ASSERT_EQ(model.outer.size(), 2);
  const std::array<std::uint32_t, 2> links{3, 7};
  const std::array<Vec3, 2> centers{Vec3(0, 0, 0.05), Vec3(0.05, 0.02, 0.1)};
  const std::array<double, 2> radii{0.08, 0.05};
  // Random values, then steps towards the worst of them.
  std::vector<double> rows = random_rows(world, 5000, 8), worst;
  detail::LaneMemory memory(model);
  std::mt19937_64 random(2);
  for (int round = 0; round < 4; ++round) {
    const std::size_t count = rows.size() / model.variables;
    std::vector<float> placed(3 * 2 * count);
    detail::place_outer_balls(model, instruction_sets().back(), rows.data(), count, memory,
                              placed.data());
    std::array<long double, 2> most{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::vector<double> q(
          rows.begin() + static_cast<std::ptrdiff_t>(i * model.variables),
          rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * model.variables));
      for (std::size_t b = 0; b < 2; ++b) {
        const auto exact = place_by_long_double(world.robots[0], q, links[b], centers[b]);
        long double off = 0;
        for (std::size_t k = 0; k < 3; ++k)
          off += std::pow(placed[3 * (2 * i + b) + k] - exact[k], 2);
        off = std::sqrt(off);
        EXPECT_LT(off, model.outer[b].radius - radii[b]);
        if (off > most[b]) {
          most[b] = off;
          if (b == 1) worst = q;
        }
      }
    }
    EXPECT_GT(most[1], 2e-8);  // the oracle sees rounding
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i] = std::clamp(worst[i % model.variables] + std::normal_distribution<double>(
                                                            0, std::pow(0.1, round + 1))(random),
                           model.low[i % model.variables], model.high[i % model.variables]);
  }
}

/// Of links that are a ball: what else holds them is not larger than it.
void shrink_to_balls(detail::Model& model) {
  for (detail::ShapeModel& s : model.shapes) {
    detail::BodyModel& body = model.bodies[s.bodies.begin];
    s.whole.radius = body.ball.radius = model.outer[body.balls.begin].radius;
  }
}

/// The bounds matter: without them answers are wrong next to contacts, which no others are.
TEST(Lanes, BoundsThatAreTakenAwayAreMissed) {
  const World world = cell(true);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 10);
  const std::vector<double> rows =
      rows_at_contact(checker, 3000, 50, {1e-9, 1e-8, 3e-8, 1e-7, 3e-7, 1e-6});
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  const auto wrong = [&](const detail::Model& m) {
    return wrong_answers(answers_of(m, instruction_sets().back(), rows), free);
  };
  EXPECT_EQ(wrong(model), (std::array<std::size_t, 2>{0, 0}));
  const std::array<float, 2> radii{0.08F, 0.05F};
  detail::Model outer = model, inner = model;
  for (std::size_t b = 0; b < 2; ++b) {
    outer.outer[b].radius = radii[b];
    inner.inner[b].radius = radii[b];
  }
  shrink_to_balls(outer);
  for (detail::Obstacle& o : outer.obstacles) o.radius -= 8e-6F;
  for (detail::ObstacleGroup& g : outer.groups)
    for (float& half : g.half) half -= 8e-6F;
  for (detail::Obstacle& o : inner.obstacles) o.inner_radius += 8e-6F;
  EXPECT_GT(wrong(outer)[0], 10U);
  EXPECT_GT(wrong(inner)[1], 10U);
}

TEST(Lanes, WitnessesThatLieAreNoticed) {
  const World world = cell(false);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
  ASSERT_FALSE(model.witnesses.empty());
  detail::Model alone = model;  // without directions
  for (detail::BodyModel& b : alone.bodies) b.corners = {};
  detail::Model mutant = model, none = alone;
  for (detail::Witness& w : mutant.witnesses) w.offset -= 0.01F;
  for (detail::ShapePair& pair : none.shape_pairs) pair.witnesses = {};
  const std::vector<double> rows = random_rows(world, 20000, 21);
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  const auto open = [&](const detail::Model& m) {
    return std::ranges::count(answers_of(m, instruction_sets().back(), rows), Answer::Open);
  };
  EXPECT_EQ(wrong_answers(answers_of(model, instruction_sets().back(), rows), free)[0], 0U);
  EXPECT_GT(wrong_answers(answers_of(mutant, instruction_sets().back(), rows), free)[0], 5U);
  EXPECT_LT(open(alone), open(none));
}

/// Faces of boxes that links are in front of decide what balls leave open; corners that are said to
/// be nearer to the link than they are give wrong answers.
TEST(Lanes, CornersThatLieAreNoticed) {
  const World world = cell(false);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
  detail::Model mutant = model, none = model;
  for (detail::ShapeModel& s : mutant.shapes) s.corner_radius -= 0.003F;
  for (detail::ShapeModel& s : none.shapes) s.corner_radius = 100;
  const std::vector<double> rows = rows_at_contact(checker, 6000, 77, {1e-6, 1e-5, 1e-4, 1e-3});
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  const auto count = [&](const detail::Model& m, Answer answer) {
    return std::ranges::count(answers_of(m, instruction_sets().back(), rows), answer);
  };
  EXPECT_EQ(wrong_answers(answers_of(model, instruction_sets().back(), rows), free)[0], 0U);
  EXPECT_GT(wrong_answers(answers_of(mutant, instruction_sets().back(), rows), free)[0], 20U);
  EXPECT_GT(count(model, Answer::Free), count(none, Answer::Free) + 10);
  for (const Instructions set : instruction_sets())
    EXPECT_EQ(answers_of(model, set, rows), answers_of(model, instruction_sets().back(), rows));
}

/// Directions along which bodies are apart decide what balls leave open; bodies that are said to be
/// smaller than they are give wrong answers.
TEST(Lanes, DirectionsThatLieAreNoticed) {
  for (const bool round : {false, true}) {
    const World world = cell(round);
    const world::Checker checker(world);
    const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
    detail::Model mutant = model, none = model;
    for (detail::BodyModel& b : mutant.bodies) b.offset -= 0.003F;
    for (detail::BodyModel& b : none.bodies) b.corners = {};
    const std::vector<double> rows = rows_at_contact(checker, 3000, 78, {1e-6, 1e-5, 1e-4, 1e-3});
    const std::vector<std::uint8_t> free = by_checker(checker, rows);
    const std::vector<Answer> answers = answers_of(model, instruction_sets().back(), rows);
    const auto count = [&](const detail::Model& m, Answer answer) {
      return std::ranges::count(answers_of(m, instruction_sets().back(), rows), answer);
    };
    EXPECT_EQ(wrong_answers(answers, free)[0], 0U);
    EXPECT_GT(wrong_answers(answers_of(mutant, instruction_sets().back(), rows), free)[0], 20U);
    if (!round) {
      EXPECT_GT(count(model, Answer::Free), count(none, Answer::Free) + 30);
    }
    for (const Instructions set : instruction_sets())
      EXPECT_EQ(answers_of(model, set, rows), answers) << name_of(set);
  }
}

/// Bodies whose difference holds a ball round the origin meet; with a ball that is smaller than
/// nothing there are wrong answers.
TEST(Lanes, MeetingsThatLieAreNoticed) {
  const World world = cell(false);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
  detail::Model mutant = model, none = model;
  for (detail::BodyModel& b : mutant.bodies) b.error = -0.003F;
  for (detail::BodyModel& b : none.bodies) b.error = 100;
  const std::vector<double> rows = rows_at_contact(checker, 6000, 79, {1e-7, 1e-5, 1e-3, 1e-2});
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  const std::vector<Answer> answers = answers_of(model, instruction_sets().back(), rows);
  EXPECT_EQ(wrong_answers(answers, free), (std::array<std::size_t, 2>{0, 0}));
  EXPECT_GT(wrong_answers(answers_of(mutant, instruction_sets().back(), rows), free)[1], 20U);
  EXPECT_GT(
      std::ranges::count(answers, Answer::Contact),
      std::ranges::count(answers_of(none, instruction_sets().back(), rows), Answer::Contact) + 300);
  for (const Instructions set : instruction_sets())
    EXPECT_EQ(answers_of(model, set, rows), answers) << name_of(set);
}

/// Balls round all shapes of a frame leave out pairs; balls that are too small are noticed.
TEST(Lanes, ClustersThatLieAreNoticed) {
  World world = cell(false);
  std::vector<world::LinkShape>& shapes = world.robots[0].shapes;
  shapes.push_back(shape(7, {box({0.02, 0.1, 0.02})}));
  shapes.push_back(shape(2, {capsule({0, 0, 0}, {0, 0.1, 0.1}, 0.03)}));
  for (const std::uint32_t a : {6U, 7U})
    for (std::uint32_t b = 0; b < a; ++b)
      if (a == 7 ? b != 5 : b == 5)
        world.robots[0].allowed.push_back({b, a, world::AllowedPair::Reason::Stated});
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
  ASSERT_GT(model.clusters.size(), 2U);
  const auto with_groups =
      std::ranges::count(model.cluster_pairs, true, &detail::ClusterPair::with_group);
  ASSERT_GT(with_groups, 2);
  ASSERT_LT(static_cast<std::size_t>(with_groups), model.cluster_pairs.size());
  const std::vector<double> rows = random_rows(world, 20000, 80);
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  EXPECT_EQ(wrong_answers(answers_of(model, instruction_sets().back(), rows), free),
            (std::array<std::size_t, 2>{0, 0}));
  for (const bool with_group : {false, true}) {
    detail::Model mutant = model;
    for (detail::ClusterPair& pair : mutant.cluster_pairs)
      if (pair.with_group == with_group) pair.margin -= 0.15F;
    EXPECT_GT(wrong_answers(answers_of(mutant, instruction_sets().back(), rows), free)[0], 20U);
  }
}

/// A box that slides face to face to an equal one behind two turns that cancel: the errors of its
/// frames are all that the bound is for. Without it there are wrong answers.
TEST(Lanes, TheErrorOfDirectionsIsNeeded) {
  robot::Robot arm;
  arm.name = "arm";
  for (const char* name : {"base", "l1", "l2", "l3"}) arm.links.emplace_back().name = name;
  arm.variables = {{"t", -3.0, 3.0}, {"s", -2.0, 2.0}};
  robot::Joint turn, back, slide;
  turn.name = "t";
  turn.type = robot::JointType::Revolute;
  turn.axis = Vec3::UnitZ();
  back = turn;
  back.name = "b";
  back.parent = 1;
  back.multiplier = -1;
  back.origin.translation = {0.9, 0.3, 0.2};
  slide.name = "s";
  slide.type = robot::JointType::Prismatic;
  slide.axis = Vec3::UnitX();
  slide.variable = 1;
  slide.parent = 2;
  slide.origin.translation = {0.1, 0, 0.1};
  arm.joints = {turn, back, slide};
  World world;
  world::RobotModel robot;
  robot.name = "arm";
  robot.kinematics = arm;
  robot.home = {0, 0};
  robot.shapes.push_back(shape(3, {box({0.1, 0.12, 0.09})}));
  world.robots.push_back(robot);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::size_t wrong = 0, wrong_without = 0;
  for (int k = 0; k < 60; ++k) {
    const double t = 3 * uniform(random);
    World cell = world;
    world::Scratch scratch;
    world::WorldState state = initial_state(cell);
    state.q[0] = {t, 0};
    const Vec3 at =
        world::Checker(cell).places(state, {{0, 0}}, scratch).front().place.pose().translation;
    add_object(cell, "o",
               {Eigen::Matrix3d::Identity(), at + Vec3(0.5 + 0.3 * uniform(random), 0, 0)},
               {box({0.1, 0.12, 0.09})});
    const double touch = cell.objects[0].pose.translation.x() - at.x() - 0.2;
    const world::Checker checker(cell);
    detail::Model model = detail::make_model(checker, initial_state(cell), 0, 30);
    std::vector<double> rows;
    for (int i = -60; i <= 10; ++i) {
      rows.push_back(t);
      rows.push_back(touch - i * 2e-8);
    }
    const std::vector<std::uint8_t> free = by_checker(checker, rows);
    wrong += wrong_answers(answers_of(model, instruction_sets().back(), rows), free)[0];
    for (detail::BodyModel& b : model.bodies) b.offset = 0;
    for (auto& one : model.shapes) one.corner_radius = 1;  // faces say nothing
    wrong_without += wrong_answers(answers_of(model, instruction_sets().back(), rows), free)[0];
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(wrong_without, 10U);
}

/// Balls about one place, up to what float squares cannot tell: nothing is said by directions.
TEST(Lanes, DirectionsWithoutALengthSayNothing) {
  for (const double t : {1e-23, 1e-22, 1e-20, 1e-12}) {
    robot::Robot arm;
    arm.name = "arm";
    for (const char* name : {"base", "l1"}) arm.links.emplace_back().name = name;
    arm.variables = {{"t", -3.0, 3.0}};
    robot::Joint joint;
    joint.name = "t";
    joint.type = robot::JointType::Revolute;
    joint.axis = Vec3::UnitZ();
    joint.origin.translation = Vec3::Constant(0.1 * t);
    arm.joints = {joint};
    World world;
    world::RobotModel robot;
    robot.name = "arm";
    robot.kinematics = arm;
    robot.home = {0};
    // No column of the rotation has two signs.
    robot.base.linear =
        Eigen::Matrix3d::Constant(1e-10) + (1 - 1e-10) * Eigen::Matrix3d::Identity();
    robot.shapes.push_back(shape(1, {ball(Vec3::Constant(t), 0.1), ball(Vec3::Constant(t), 0.09)}));
    world.robots.push_back(robot);
    add_object(world, "o", {Eigen::Matrix3d::Identity(), Vec3::Constant(-t)},
               {ball({0, 0, 0}, 0.1)});
    const world::Checker checker(world);
    const BatchChecker batch(checker, initial_state(world), 0, {});
    const std::vector<double> rows{0.0, 0.0, 1.0};
    std::vector<Answer> answers(rows.size());
    batch.filter(rows, answers);
    for (const Answer answer : answers) EXPECT_NE(answer, Answer::Free) << t;
  }
}

/// Rows that are open are so for pairs that are named: all others are apart, and these decide.
TEST(Lanes, OpenPairsDecideRows) {
  const World world = cell(false);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 30);
  std::vector<double> rows = random_rows(world, 3000, 23);
  const std::vector<double> near = rows_at_contact(checker, 3000, 79, {1e-6, 1e-4, 1e-3});
  rows.insert(rows.end(), near.begin(), near.end());
  rows[0] = 50;  // beyond its limits
  const std::size_t n = model.variables, count = rows.size() / n;
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  std::vector<Answer> answers(count);
  detail::LaneMemory memory(model);
  detail::OpenPairs pairs(count);
  const std::vector<double> blocks = detail::in_blocks(rows.data(), count, n);
  detail::filter_blocks(model, instruction_sets().back(), blocks.data(), nullptr, count, memory,
                        answers.data(), 0, detail::Look::All, &pairs);
  world::Scratch scratch;
  world::WorldState state = initial_state(world);
  EXPECT_EQ(answers[0], Answer::Open);
  EXPECT_FALSE(pairs.of(0));
  std::array<std::size_t, 2> seen{};
  for (std::size_t i = 1; i < count; ++i) {
    if (answers[i] != Answer::Open) continue;
    const auto left = pairs.of(i);
    ASSERT_TRUE(left);  // no more pairs than there is room for
    std::vector<std::array<world::Item, 2>> items;
    for (const std::uint32_t k : *left) items.push_back(model.items[k]);
    state.q[0].assign(rows.begin() + static_cast<std::ptrdiff_t>(i * n),
                      rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    EXPECT_EQ(checker.are_apart(state, items, scratch), free[i] != 0);
    ++seen[free[i]];
    // What meets is among them.
    for (const world::Contact& contact : checker.find_contacts(state, scratch, {}))
      EXPECT_TRUE(std::ranges::any_of(items, [&](const auto& pair) {
        return pair == contact.items ||
               (pair[0] == contact.items[1] && pair[1] == contact.items[0]);
      }));
  }
  EXPECT_GT(seen[0], 100U);
  EXPECT_GT(seen[1], 10U);
}

/// Motions one by one: what vector code says of them is so, and the same for all instructions.
TEST(MotionChecker, AnswersAsCheckMotionDoes) {
  World world = cell(false);
  // Nothing is known of it but by balls.
  add_object(world, "boulder", pose(0, 0.3, {3.2, -1.6, 1.5}),
             {polytope(11, 400, {0.1, 0.2, 0.1})});
  const world::Checker checker(world);
  const std::size_t count = 1200;
  // A third of them begin next to contacts.
  std::vector<double> from = rows_at_contact(checker, 400, 61, {1e-3, 5e-3});
  const std::vector<double> others = random_rows(world, count, 61);
  from.insert(from.end(), others.begin() + static_cast<std::ptrdiff_t>(from.size()), others.end());
  const std::vector<double> ends = random_rows(world, count, 62);
  const std::size_t n = world.robots[0].kinematics.variables.size();
  std::vector<BatchChecker> batches;
  std::vector<MotionChecker> checkers;
  for (const Instructions set : instruction_sets())
    batches.emplace_back(checker, initial_state(world), 0,
                         BatchChecker::Options{.instructions = set});
  for (const BatchChecker& batch : batches) checkers.emplace_back(batch);
  std::array<std::size_t, 3> answers{};
  std::size_t open_free = 0, open_not_free = 0;
  for (const double resolution : {1e-5, 0.005}) {
    world::MotionOptions options;
    options.resolution = resolution;
    options.where = false;
    for (std::size_t i = 0; i < count; ++i) {
      const double share = i % 4 == 0 ? 1 : i % 4 == 1 ? 0.3 : i % 4 == 2 ? 0.05 : 1e-3;
      std::vector<double> a(from.begin() + static_cast<std::ptrdiff_t>(i * n),
                            from.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
      std::vector<double> b = a;
      for (std::size_t k = 0; k < n; ++k) b[k] += share * (ends[i * n + k] - a[k]);
      const bool free = check_motion(checker, initial_state(world), 0, {a, b}, options).outcome ==
                        world::MotionAnswer::Outcome::Free;
      const Answer answer = checkers.back().filter(a, b, resolution);
      const std::vector<std::array<double, 2>> open(checkers.back().open().begin(),
                                                    checkers.back().open().end());
      ++answers[static_cast<std::size_t>(answer)];
      if (answer != Answer::Open) {
        EXPECT_EQ(answer == Answer::Free, free) << i;
        const Answer back = checkers.back().filter(b, a, resolution);
        EXPECT_TRUE(back == answer || back == Answer::Open) << i;
      }
      for (MotionChecker& other : checkers) {
        EXPECT_EQ(other.filter(a, b, resolution), answer) << i;
        EXPECT_TRUE(std::ranges::equal(other.open(), open)) << i;
        EXPECT_EQ(other.is_free(a, b, options), free) << i;
      }
      if (checkers.back().filter(a, b, resolution) != Answer::Open) continue;
      std::size_t intervals = 0;
      const bool apart = checkers.back().are_open_free(a, b, options, intervals);
      EXPECT_GT(intervals, 0U);
      EXPECT_TRUE(free || !apart) << i;
      ++(apart ? open_free : open_not_free);
    }
  }
  for (const std::size_t some : answers) EXPECT_GT(some, 20U);
  EXPECT_GT(open_free, 5U);
  EXPECT_GT(open_not_free, 10U);
}

TEST(MotionChecker, WhatVectorCodeKnowsNothingOf) {
  const World world = cell(false);
  const world::Checker checker(world);
  const world::WorldState state = initial_state(world);
  const BatchChecker batch(checker, state, 0, {});
  MotionChecker motions(batch);
  const std::size_t n = world.robots[0].kinematics.variables.size();
  const std::vector<double> rows = random_rows(world, 200, 63);
  std::size_t narrower = 0;
  world::MotionOptions roomy;
  roomy.where = false;
  roomy.around.assign(n, 0.3);
  for (std::size_t i = 0; i < 200; ++i) {
    const std::vector<double> a(rows.begin() + static_cast<std::ptrdiff_t>(i * n),
                                rows.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    std::vector<double> b = a;
    b[0] += 0.05;
    // A resolution of nothing, or less, makes nothing free.
    for (const double resolution : {0.0, -0.05, -1.0})
      EXPECT_EQ(motions.filter(a, b, resolution), Answer::Open);
    // Nor is one so coarse that things out of reach matter.
    EXPECT_EQ(motions.filter(a, b, 10), Answer::Open);
    const bool free = check_motion(checker, state, 0, {a, b}, roomy).outcome ==
                      world::MotionAnswer::Outcome::Free;
    EXPECT_EQ(motions.is_free(a, b, roomy), free) << i;
    std::vector<std::uint8_t> decided(1);
    batch.decide_motions(a, b, decided, roomy);
    EXPECT_EQ(decided[0] != 0, free) << i;
    world::MotionOptions usual;
    usual.where = false;
    narrower += !free && motions.is_free(a, b, usual) ? 1 : 0;
    // What is open of one motion says nothing of another.
    if (motions.filter(a, b, 1e-5) != Answer::Open) continue;
    std::size_t intervals = 0;
    EXPECT_THROW(motions.are_open_free(b, a, usual, intervals), Error);
  }
  EXPECT_GT(narrower, 5U);
}

/// Points on a table and on a ball, and some that are apart from all others.
std::vector<Vec3> scan(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  std::normal_distribution<double> normal;
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 5 < 2)
      out.emplace_back(3.7 + 0.4 * share(random), -2 + 0.6 * share(random), 0.95);
    else if (i % 5 < 4)
      out.push_back(Vec3(2.6, -1.5, 1.4) +
                    0.25 * Vec3(normal(random), normal(random), normal(random)).normalized());
    else
      out.emplace_back(3 + 1.5 * share(random), -2 + 1.5 * share(random), 1 + 1.5 * share(random));
  }
  return out;
}

World cell_with_cloud(bool round, std::size_t count, double radius) {
  World out = cell(round);
  out.objects.clear();
  out.attachments.clear();
  add_cloud(out, {.name = "scan",
                  .points = scan(count, 31),
                  .radius = radius,
                  .pose = pose(0.1, 0.05, {0.02, -0.03, 0.01})});
  return out;
}

TEST(BatchChecker, AnswersAmongPointsAreThoseOfTheChecker) {
  for (const auto& [count, radius] : {std::pair<std::size_t, double>{65, 0.05}, {3000, 0.01}}) {
    for (const double margin : {0.0, 0.02}) {
      World world = cell_with_cloud(false, count, radius);
      world.margins.all = margin;
      const world::Checker checker(world);
      const BatchChecker batch(checker, initial_state(world), 0, {});
      for (const std::vector<double>& rows :
           {random_rows(world, 3000, 1),
            rows_at_contact(checker, 600, 100, {1e-9, 1e-6, 1e-4, 1e-3})}) {
        std::vector<std::uint8_t> free(rows.size() / batch.variables());
        const BatchCounts counts = batch.decide(rows, free);
        EXPECT_EQ(free, by_checker(checker, rows));
        EXPECT_GT(counts.free, free.size() / 100);
        EXPECT_LT(counts.exactly, free.size());
      }
      const std::size_t motions = 150;
      const std::vector<double> from = random_rows(world, motions, 61),
                                ends = random_rows(world, motions, 62);
      std::vector<double> to;
      for (std::size_t i = 0; i < from.size(); ++i)
        to.push_back(from[i] + 0.05 * (ends[i] - from[i]));
      std::vector<std::uint8_t> free(motions);
      batch.decide_motions(from, to, free, {});
      const std::size_t n = batch.variables();
      for (std::size_t i = 0; i < motions; ++i) {
        const auto row = [&](const std::vector<double>& of) {
          return std::vector<double>(of.begin() + static_cast<std::ptrdiff_t>(i * n),
                                     of.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
        };
        const auto exact = check_motion(checker, initial_state(world), 0, {row(from), row(to)}, {});
        EXPECT_EQ(free[i] != 0, exact.outcome == world::MotionAnswer::Outcome::Free) << i;
      }
    }
  }
}

/// Trees hold their points; and what is said with trees that do not, or radii that are too small or
/// too large, is wrong next to contacts.
TEST(Lanes, CloudsThatLieAreNoticed) {
  constexpr double kRadius = 0.01;
  const World world = cell_with_cloud(true, 2000, kRadius);
  const world::Checker checker(world);
  const detail::Model model = detail::make_model(checker, initial_state(world), 0, 10);
  ASSERT_EQ(model.cloud_points.size(), 2000);
  ASSERT_EQ(model.groups.size(), 1);
  const detail::CloudModel& cloud = model.groups[0].cloud;
  std::size_t held = 0;
  for (std::uint32_t i = cloud.nodes.begin; i < cloud.nodes.end; ++i) {
    const detail::CloudNode& node = model.cloud_nodes[i];
    EXPECT_GT(node.next, i);
    for (std::uint32_t below = i; below < node.next; ++below)
      for (std::uint32_t k = model.cloud_nodes[below].points.begin;
           k < model.cloud_nodes[below].points.end; ++k)
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_LE(node.low[axis], model.cloud_points[k].at[axis]);
          EXPECT_GE(node.high[axis], model.cloud_points[k].at[axis]);
        }
    held += node.points.end - node.points.begin;
  }
  EXPECT_EQ(held, 2000U);
  const std::vector<double> rows =
      rows_at_contact(checker, 3000, 50, {1e-9, 1e-8, 3e-8, 1e-7, 3e-7, 1e-6});
  const std::vector<std::uint8_t> free = by_checker(checker, rows);
  const std::vector<Answer> expected = answers_of(model, Instructions::Baseline, rows);
  for (const Instructions set : instruction_sets())
    EXPECT_EQ(answers_of(model, set, rows), expected) << name_of(set);
  EXPECT_EQ(wrong_answers(expected, free), (std::array<std::size_t, 2>{0, 0}));
  const auto wrong = [&](const detail::Model& m) {
    return wrong_answers(answers_of(m, instruction_sets().back(), rows), free);
  };
  const std::array<float, 2> radii{0.08F, 0.05F};
  detail::Model small = model, large = model, cut = model;
  for (std::size_t b = 0; b < 2; ++b) {
    small.outer[b].radius = radii[b];
    large.inner[b].radius = radii[b];
  }
  shrink_to_balls(small);
  small.groups[0].cloud.radius = kRadius - 8e-6F;
  large.groups[0].cloud.inner_radius = kRadius + 8e-6F;
  for (detail::CloudNode& node : cut.cloud_nodes)
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis] += 0.05F;
      node.high[axis] -= 0.05F;
    }
  EXPECT_GT(wrong(small)[0], 10U);
  EXPECT_GT(wrong(large)[1], 10U);
  EXPECT_GT(wrong(cut)[0], 10U);
}

TEST(BallCover, HoldsAndLiesInBodies) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const ConvexBody body =
        polytope(seed, 20 + 5 * static_cast<int>(seed), {0.1, 0.02, 0.3}, 0.01 * (seed % 2));
    const BoundingSet set({body, capsule({0, 0, 0}, {0.3, 0.2, 0}, 0.02)},
                          collide::Direction::Outer, 0);
    const std::vector<detail::BallCover> covers = detail::cover_by_balls({&set}, 2 + 3 * seed);
    EXPECT_LE(covers[0].outer.size(), 2 + 3 * seed);
    for (std::size_t b = 0; b < 2; ++b)
      for (int i = 0; i < 500; ++i) {
        // Mostly next to corners and edges.
        const auto& v = set.body(b).core.vertices;
        Vec3 p = Vec3::Zero();
        double sum = 0;
        for (const Vec3& corner : v) {
          const double weight = std::pow(share(random), i % 3 == 0 ? 1 : 60);
          p += weight * corner;
          sum += weight;
        }
        p /= sum;
        double least = HUGE_VAL;
        for (const detail::Ball& held : covers[0].outer)
          least = std::min(least, (p - held.center).norm() + set.body(b).radius - held.radius);
        EXPECT_LE(least, 0);
      }
    for (const detail::Ball& inner : covers[0].inner) {
      double reach = HUGE_VAL;  // how far the ball is in one of the bodies, by their planes
      const auto depth = [&](const ConvexBody& of) {
        if (of.core.triangles.empty()) {
          const Vec3 d = of.core.vertices[1] - of.core.vertices[0];
          const double t =
              std::clamp((inner.center - of.core.vertices[0]).dot(d) / d.squaredNorm(), 0.0, 1.0);
          return of.radius - (inner.center - of.core.vertices[0] - t * d).norm() - inner.radius;
        }
        double least = HUGE_VAL;
        for (const auto& t : of.core.triangles) {
          const Vec3& a = of.core.vertices[t[0]];
          const Vec3 n =
              (of.core.vertices[t[1]] - a).cross(of.core.vertices[t[2]] - a).normalized();
          least = std::min(least, n.dot(a - inner.center) + of.radius - inner.radius);
        }
        return least;
      };
      reach = std::max(depth(set.body(0)), depth(set.body(1)));
      EXPECT_GT(reach, -1e-9);
    }
  }
}

}  // namespace
}  // namespace kaboum::filter
