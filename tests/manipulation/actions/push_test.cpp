// Straight pushes among exact meshes: each line that is answered is followed by the judge's
// kinematics and looked at by formulas of this file, which share nothing with the library's.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/base/random.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "push_contact.h"
#include "standing.h"
#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using plan::Answer;
using Kind = world::Feature::Kind;
using Words = std::map<std::string, std::string>;

constexpr double kPushStep = 0.005;  // between samples [rad]
constexpr double kHalf = 0.025;      // of the block's base [m]
constexpr double kTableTop = -0.001, kLow = 0.3, kHigh = 0.9, kSide = 0.7;  // of the table [m]
const Words kAllResting = {{"conf(left)", "home"},
                           {"conf(right)", "home"},
                           {"pose(block)", "start"},
                           {"pose(socket)", "start"},
                           {"pose(wall)", "start"}};

Transform inverse(const Transform& pose) {
  return {pose.linear.transpose(), -(pose.linear.transpose() * pose.translation)};
}

class Push : public ::testing::Test {
 protected:
  Push() {
    world::RobotModel& left = arms_.world.robots[TwoArms::kLeft];
    // A side of the hand pushes, near its end.
    left.features = {{arms_.hand, {"push", Kind::Plane, {0.015, 0, 0.145}, {1, 0, 0}}}};
    for (int k = 0; k < 4; ++k) {
      const Vec3 out(std::round(std::cos(k * M_PI / 2)), std::round(std::sin(k * M_PI / 2)), 0);
      block().features.push_back(
          {"push" + std::to_string(k), Kind::Plane, kHalf * out - Vec3(0, 0, 0.04), out});
    }
  }

  world::Object& block() { return arms_.world.objects[TwoArms::kBlock]; }
  /// Moves a thing, for the judge as well.
  void put(TwoArms::Things thing, const Vec3& at, double turn = 0) {
    arms_.world.objects[thing].pose = {Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix(),
                                       at};
  }

  Answer push(unsigned choice = 0, const Words& words = kAllResting, unsigned attempts = 6,
              const char* support = "table") const {
    return ask(manipulation::bind_externals(arms_.world, {}), "push",
               {"left", "block", support, "home"}, words, attempts, choice);
  }

  /// Carries an answer out. @return how far the block was pushed.
  double carry_out(const Answer& answer) {
    judge::CellState state = arms_.state();
    const std::vector<Motion> motions = motions_of(answer);
    double length = 0;
    int lines = 0;
    for (const Motion& m : motions) {
      EXPECT_EQ(m.robot, "left");
      EXPECT_EQ(m.path.front(), state.q[0]);
      if (m.holds.empty()) {
        for (const std::vector<double>& q : samples_of(m.path, kPushStep)) expect_free(state, q);
        continue;
      }
      EXPECT_EQ(m.holds, (std::map<std::string, std::string>{{"block", "hand"}}));
      ++lines;
      length = follow_line(state, m);
    }
    EXPECT_EQ(lines, 1);
    EXPECT_TRUE(motions.size() == 4 && !motions[1].holds.empty()) << "reach, push, back off, home";
    EXPECT_EQ(state.q[0], arms_.world.robots[0].home);
    const auto said = manipulation::place_of(answer.value, arms_.world, TwoArms::kBlock);
    const Transform& is = state.objects[TwoArms::kBlock].pose;
    EXPECT_FALSE(said.attachment || said.mounted_on || said.absent) << answer.value;
    EXPECT_LT((said.pose.translation - is.translation).norm(), 1e-6) << answer.value;
    EXPECT_LT((said.pose.linear - is.linear).cwiseAbs().maxCoeff(), 1e-6) << answer.value;
    return length;
  }

  void expect_free(judge::CellState& state, const std::vector<double>& q) {
    state.q[0] = q;
    const auto meeting = arms_.cell.find_meeting(state, 0);
    EXPECT_FALSE(meeting) << meeting->names[0] << " and " << meeting->names[1];
  }

  /// The push itself: straight, level, with the tool, on the table all the way.
  double follow_line(judge::CellState& state, const Motion& m) {
    judge::CellState::Place& place = state.objects[TwoArms::kBlock];
    const Transform begin = place.pose, hand = arms_.cell.pose_of(state, 0, arms_.hand);
    const Vec3 way = hand.linear * Vec3::UnitX();  // of the hand's plane that pushes
    EXPECT_NEAR(way.z(), 0, 1e-6);
    // The hand's plane is at one of the block's, in the middle, before the first touch.
    const Vec3 apart =
        begin.linear.transpose() * (hand * Vec3(0.015, 0, 0.145) - begin.translation);
    EXPECT_NEAR(std::min(std::abs(apart.x()), std::abs(apart.y())), 0, 1e-6);
    const double gap = std::max(std::abs(apart.x()), std::abs(apart.y())) - kHalf;
    EXPECT_TRUE(gap > 0 && gap < 0.0015) << gap;
    EXPECT_NEAR(apart.z(), -0.04, 1e-6);
    place.hold = {0, arms_.hand, judge::product(inverse(hand), begin), {}};
    Vec3 gone = Vec3::Zero();
    for (const std::vector<double>& q : samples_of(m.path, kPushStep)) {
      expect_free(state, q);
      const Transform now = arms_.cell.pose_of(state, TwoArms::kBlock);
      gone = now.translation - begin.translation;
      EXPECT_LT((gone - gone.dot(way) * way).norm(), 5.1e-4) << "off its line";
      EXPECT_GT(gone.dot(way), -5.1e-4);
      EXPECT_LT((now.linear - begin.linear).cwiseAbs().maxCoeff(), 4.1e-3) << "leans or turns";
      expect_on_table(now);
    }
    EXPECT_LT((gone - gone.dot(way) * way).norm(), 1e-6) << "ends off its line";
    place.pose = arms_.cell.pose_of(state, TwoArms::kBlock);
    place.hold.reset();
    return gone.dot(way);
  }

  virtual void expect_on_table(const Transform& at) {
    for (const double x : {-kHalf, kHalf})
      for (const double y : {-kHalf, kHalf}) {
        const Vec3 corner = at * Vec3(x, y, -0.08);
        EXPECT_TRUE(corner.x() > kLow && corner.x() < kHigh && std::abs(corner.y()) < kSide)
            << corner.transpose();
        EXPECT_GT(corner.z(), kTableTop);
        EXPECT_LT(corner.z(), kTableTop + 0.002);
      }
  }

  TwoArms arms_;
};

TEST_F(Push, EveryChoiceIsAStraightLineOnTheTable) {
  const Answer first = push();
  ASSERT_EQ(first.kind, Answer::Kind::Value) << first.reason;
  EXPECT_GE(first.choices, 15U);
  EXPECT_TRUE(first.chosen);
  std::set<std::string> places;
  std::set<int> ways;
  for (unsigned choice = 0; choice <= first.choices; ++choice) {
    const Answer answer = push(choice);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    SCOPED_TRACE("choice " + std::to_string(choice) + ": " + answer.value);
    EXPECT_GE(carry_out(answer), 0.02 - 1e-6);
    EXPECT_EQ(push(choice).payload, answer.payload);
    places.insert(answer.value);
    const Vec3 gone =
        manipulation::place_of(answer.value, arms_.world, TwoArms::kBlock).pose.translation -
        block().pose.translation;
    ways.insert(std::abs(gone.x()) > std::abs(gone.y()) ? (gone.x() > 0 ? 0 : 2)
                                                        : (gone.y() > 0 ? 1 : 3));
  }
  EXPECT_GE(places.size(), 10U);
  EXPECT_GE(ways.size(), 3U);
}

TEST_F(Push, TurnedBlocksAreMovedAlongTheirOwnSides) {
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    put(TwoArms::kBlock, {random.between(0.42, 0.62), random.between(0.15, 0.5), 0.08},
        random.between(0, 3));
    const Answer answer = push(static_cast<unsigned>(i));
    if (answer.kind != Answer::Kind::Value) {
      EXPECT_EQ(answer.kind, Answer::Kind::NotFound);
      continue;
    }
    SCOPED_TRACE(answer.value);
    carry_out(answer);
  }
}

TEST_F(Push, WhatStandsInTheWayEndsThePush) {
  // A wall behind the block, seen from every side.
  const double free = 0.1;
  double most = 0;
  put(TwoArms::kWall, {0.5 + kHalf + free + 0.01, 0.3, 0.155});
  for (unsigned choice = 0; choice < 16; ++choice) {
    const Answer answer = push(choice);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    SCOPED_TRACE(answer.value);
    carry_out(answer);
    const Vec3 at =
        manipulation::place_of(answer.value, arms_.world, TwoArms::kBlock).pose.translation;
    most = std::max(most, at.x() - 0.5);
  }
  EXPECT_GT(most, 0.02);
  EXPECT_LT(most, free);
}

/// A block of which the scene says where its centre of mass is may stick out over the edge.
class PushOver : public Push {
 protected:
  PushOver() { block().features.push_back({"mass", Kind::Point, {0, 0, 0.01}, {}}); }

  void expect_on_table(const Transform& at) override {
    const Vec3 mass = at * Vec3(0, 0, 0.01), bottom = at * Vec3(0, 0, -0.08);
    EXPECT_GE(std::min({mass.x() - kLow, kHigh - mass.x(), kSide - std::abs(mass.y())}), 0.01);
    EXPECT_TRUE(bottom.z() > kTableTop && bottom.z() < kTableTop + 0.002);
    farthest_ = std::max(farthest_, std::abs(mass.y()) + kHalf - kSide);
  }
  double farthest_ = -1;  ///< over the edge
};

TEST_F(PushOver, WhatWasPushedToTheEdgeMayBePushedOn) {
  Words words = kAllResting;
  block().pose.translation = {0.5, 0.6, 0.08};
  std::string at;
  for (unsigned i = 0; i < 6; ++i) {
    const Answer answer = push(i, words);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << i << ": " << at << ": " << answer.reason;
    words["pose(block)"] = at = answer.value;
  }
}

TEST_F(PushOver, TheCenterOfMassStaysAboveTheTable) {
  put(TwoArms::kBlock, {0.5, 0.6, 0.08});
  for (unsigned choice = 0; choice < 8; ++choice) {
    const Answer answer = push(choice);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    SCOPED_TRACE(answer.value);
    carry_out(answer);
  }
  EXPECT_GT(farthest_, 0.01);
  EXPECT_LT(farthest_, kHalf - 0.01);
}

TEST_F(Push, WhatIsImpossibleIsProved) {
  const auto expect = [&](const Answer& answer, Answer::Kind kind, const std::string& reason) {
    EXPECT_EQ(answer.kind, kind) << answer.reason;
    EXPECT_NE(answer.reason.find(reason), std::string::npos) << answer.reason;
  };
  Words words = kAllResting;
  words["pose(block)"] = arms_.word(arms_.hold(TwoArms::kRight, 0));
  expect(push(0, words), Answer::Kind::Impossible, "does not rest");
  words["pose(block)"] = arms_.word(arms_.hold(TwoArms::kLeft, 0));
  expect(push(0, words), Answer::Kind::Impossible, "does not rest");
  words["pose(block)"] = "away";
  expect(push(0, words), Answer::Kind::Impossible, "is away");
  const Answer elsewhere = push(0, kAllResting, 6, "socket");
  expect(elsewhere, Answer::Kind::Impossible, "does not stand with all its base on socket");
  EXPECT_TRUE(elsewhere.listed);
  expect(push(0, kAllResting, 6, "block"), Answer::Kind::Impossible, "is not there");
  // In the air, leaning, and with its base half over the edge.
  for (const char* pose : {"at 0.5 0.3 0.084 0 0 0 1", "at 0.5 0.3 0.08 0.0099998 0 0 0.99995",
                           "at 0.5 0.69 0.08 0 0 0 1", "at 0.5 0.3 0.06 0.7071068 0 0 0.7071068"}) {
    words["pose(block)"] = pose;
    expect(push(0, words), Answer::Kind::Impossible, "does not stand");
  }
  // Nothing lies behind these: another seed, another attempt say the same.
  block().features.resize(2);
  expect(push(), Answer::Kind::Impossible, "lists no planes 'push…' of block");
  EXPECT_TRUE(push().listed);
}

TEST_F(Push, AHandThatHoldsSomethingPushesNothing) {
  Words words = kAllResting;
  words["pose(socket)"] = "on left/hand 0 0 0.3 0 0 0 1";
  const Answer answer = push(0, words);
  EXPECT_EQ(answer.kind, Answer::Kind::Impossible) << answer.reason;
  EXPECT_NE(answer.reason.find("left holds socket"), std::string::npos) << answer.reason;
}

/// Each of the constraints of a push is kept by the push, and broken by a motion that breaks
/// nothing but it.
TEST_F(Push, ConstraintsAreOfTheLine) {
  using motion::ConstraintAnswer;
  const Motion line = motions_of(push())[1];
  judge::CellState state = arms_.state();
  state.q[0] = line.path.front();
  const Transform begin = block().pose, hand = arms_.cell.pose_of(state, 0, arms_.hand);
  state.q[0] = line.path.back();
  const Transform last = arms_.cell.pose_of(state, 0, arms_.hand);
  const double length = (last.translation - hand.translation).norm();
  const Vec3 way = (last.translation - hand.translation) / length,
             center = begin * Vec3(0, 0, -0.08);
  ASSERT_GT(length, 0.1);
  world::Attachment held;
  held.robot = 0;
  held.link = arms_.hand;
  held.pose = judge::product(inverse(hand), begin);
  const auto kept = manipulation::push_constraints(held, begin, center, way, length);
  const auto outcome = [&](const robot::Path& path, std::span<const motion::PathConstraint> c) {
    return motion::check_constraints(arms_.world.robots[0], path, c).outcome;
  };
  EXPECT_EQ(outcome(line.path, kept), ConstraintAnswer::Outcome::Kept);
  ASSERT_EQ(kept.size(), 4U);
  EXPECT_EQ(outcome({line.path.front(), line.path.back()}, std::span(kept).first(1)),
            ConstraintAnswer::Outcome::Broken)
      << "joints go straight, the tool does not";
  const auto half = manipulation::push_constraints(held, begin, center, way, 0.5 * length);
  EXPECT_EQ(outcome(line.path, half), ConstraintAnswer::Outcome::Broken);
  EXPECT_EQ(outcome(line.path, std::span(half).first(1)), ConstraintAnswer::Outcome::Kept);
  const robot::Path back(line.path.rbegin(), line.path.rend());
  EXPECT_EQ(outcome(back, manipulation::push_constraints(held, begin, center, -way, length)),
            ConstraintAnswer::Outcome::Broken)
      << "the other way";
  // The last joint turns the block about the vertical, the one before leans it.
  for (const std::size_t joint : {4U, 5U}) {
    robot::Path off{line.path.front(), line.path.front()};
    off.back()[joint] += 0.01;
    const bool turns = std::abs(hand.linear(2, 2)) > 0.9 && joint == 5;
    EXPECT_EQ(outcome(off, std::span(kept).subspan(2, 1)),
              turns ? ConstraintAnswer::Outcome::Kept : ConstraintAnswer::Outcome::Broken);
    if (turns) {
      EXPECT_EQ(outcome(off, std::span(kept).last(1)), ConstraintAnswer::Outcome::Broken);
    }
  }
}

TEST_F(Push, NothingIsPushedBesideItsCenterNorBySlantingPlanes) {
  for (world::Feature& f : block().features)
    if (f.name.starts_with("push")) f.point += 0.06 * Vec3::UnitZ().cross(f.direction);
  const Answer beside = push();
  EXPECT_EQ(beside.kind, Answer::Kind::NotFound) << beside.reason;
  for (world::Feature& f : block().features)
    if (f.name.starts_with("push")) f.direction = (f.direction + 0.01 * Vec3::UnitZ()).normalized();
  const Answer slanting = push();
  EXPECT_EQ(slanting.kind, Answer::Kind::Impossible) << slanting.reason;
  EXPECT_NE(slanting.reason.find("no plane 'push…' of block is upright"), std::string::npos)
      << slanting.reason;
  EXPECT_TRUE(slanting.listed);
}

TEST_F(Push, AnArmWithoutAPlaneThatPushesPushesNothing) {
  arms_.world.robots[0].features.clear();
  const Answer answer = push();
  EXPECT_EQ(answer.kind, Answer::Kind::Impossible) << answer.reason;
  EXPECT_NE(answer.reason.find("lists no planes 'push…' of left"), std::string::npos);
  EXPECT_TRUE(answer.listed);
}

TEST_F(Push, ALinkThatNothingMovesPushesNothing) {
  arms_.world.robots[0].features[0].link = 0;
  try {
    push();
    FAIL() << "the base pushes";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("no joint moves the link 'base'"), std::string::npos)
        << error.what();
  }
}

TEST_F(Push, TheFarthestIsWhereTheBaseComesToTheEdge) {
  const world::Object& table = arms_.world.objects[TwoArms::kTable];
  const manipulation::PushedObject pushed(block(), block().pose, table, table.pose, 1e-3);
  ASSERT_EQ(pushed.refusal(), "");
  // By hand: to the side, forwards, and aslant. What it may be off on its way is left out: 0.5 mm
  // to two sides, and what 0.004 rad move a corner. That this is enough is tested where the
  // constraints are (push_stand_test.cpp).
  const double slack =
      TwoArms::kEpsilon + std::hypot(0.0005, 0.0005) + 0.004 * std::hypot(kHalf, kHalf);
  EXPECT_NEAR(pushed.farthest(Vec3::UnitY()), kSide - 0.3 - kHalf - slack, 1.1e-5);
  EXPECT_NEAR(pushed.farthest(-Vec3::UnitY()), kSide + 0.3 - kHalf - slack, 1.1e-5);
  EXPECT_NEAR(pushed.farthest(Vec3::UnitX()), kHigh - 0.5 - kHalf - slack, 1.1e-5);
  EXPECT_NEAR(
      pushed.farthest(Vec3(1, 1, 0).normalized()),
      std::sqrt(2.0) * std::min(kHigh - 0.5, kSide - 0.3) - std::sqrt(2.0) * (kHalf + slack),
      1.1e-5);
}

}  // namespace
}  // namespace kaboum::test
