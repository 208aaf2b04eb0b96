// Handing over, mounting, lifting, carrying upright and sweeping, among exact meshes: what the
// paths that are answered do is carried out by the judge, which has none of the library's code.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/world/features.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <string>

#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using plan::Answer;

constexpr double kStep = 0.01;  // between samples [rad]

/// A configuration whose tool looks straight down.
const std::vector<double> kDown = {0, -0.3, 1.5, 0, 1.941592654, 0};

using Words = std::map<std::string, std::string>;

/// The state at first.
const Words kAllAtStart = {{"conf(left)", "home"},
                           {"conf(right)", "home"},
                           {"pose(block)", "start"},
                           {"pose(socket)", "start"},
                           {"pose(wall)", "start"}};

class Actions : public ::testing::Test {
 protected:
  /// The block in a hand, everything else where it is at first.
  Words holding(std::size_t robot, std::size_t grasp, const std::vector<double>& q) {
    const world::Attachment held = arms_.hold(robot, grasp);
    state_ = arms_.state();
    state_.q[robot] = q;
    state_.objects[TwoArms::kBlock].hold = arms_.hold_of(held);
    Words out = {
        {"pose(block)", arms_.word(held)}, {"pose(socket)", "start"}, {"pose(wall)", "start"}};
    for (std::size_t r = 0; r < 2; ++r)
      out["conf(" + arms_.world.robots[r].name + ")"] = manipulation::word_of(state_.q[r]);
    return out;
  }

  Transform hand(std::size_t robot) const { return arms_.cell.pose_of(state_, robot, arms_.hand); }
  Transform block() const { return arms_.cell.pose_of(state_, TwoArms::kBlock); }

  /// Whether a robot's tool is at one of the block's grasps.
  bool at_grasp(std::size_t robot) const {
    for (const world::Grasp& grasp : arms_.world.objects[TwoArms::kBlock].grasps) {
      const Transform held = judge::product(
          judge::product(hand(robot), arms_.world.robots[robot].tools[0].pose), grasp.pose);
      if ((held.translation - block().translation).norm() < 1e-6 &&
          (held.linear - block().linear).cwiseAbs().maxCoeff() < 1e-6)
        return true;
    }
    return false;
  }

  void let_go() {
    judge::CellState::Place& place = state_.objects[TwoArms::kBlock];
    place.pose = block();
    place.hold.reset();
  }

  void take(std::size_t robot) {
    EXPECT_TRUE(at_grasp(robot));
    const Transform at = hand(robot),
                    inverse{at.linear.transpose(), -(at.linear.transpose() * at.translation)};
    judge::CellState::Place& place = state_.objects[TwoArms::kBlock];
    place.hold = {robot, arms_.hand, judge::product(inverse, block()), {}};
  }

  /// Goes where a motion leads; calls `look` at each sample.
  void follow(const Motion& m, const std::function<void()>& look = {}) {
    const std::size_t robot = *arms_.world.find_robot(m.robot);
    ASSERT_FALSE(m.path.empty());
    EXPECT_EQ(m.path.front(), state_.q[robot]);
    const auto& hold = state_.objects[TwoArms::kBlock].hold;
    const bool holds = m.holds.contains("block");
    if (hold && hold->robot == robot && !holds) let_go();
    if (holds && !(hold && hold->robot == robot)) take(robot);
    for (const std::vector<double>& q : samples_of(m.path, kStep)) {
      state_.q[robot] = q;
      const auto meeting = arms_.cell.find_meeting(state_, robot);
      ASSERT_FALSE(meeting) << m.robot << ": " << meeting->names[0] << " and " << meeting->names[1];
      for (std::size_t j = 0; j < q.size(); ++j) {
        const robot::Variable& v = arms_.world.robots[robot].kinematics.variables[j];
        ASSERT_GE(q[j], *v.lower);
        ASSERT_LE(q[j], *v.upper);
      }
      if (look) look();
    }
  }

  /// Where the word of a pose says that the block is, by the judge.
  void expect_block(const std::string& word) {
    judge::CellState stated = state_;
    const manipulation::ObjectPlace place =
        manipulation::place_of(word, arms_.world, TwoArms::kBlock);
    judge::CellState::Place& at = stated.objects[TwoArms::kBlock];
    at.hold.reset();
    if (place.attachment) at.hold = arms_.hold_of(*place.attachment);
    at.pose = place.mounted_on
                  ? judge::product(arms_.world.objects[*place.mounted_on].pose, place.pose)
                  : place.pose;
    const Transform a = arms_.cell.pose_of(stated, TwoArms::kBlock), b = block();
    EXPECT_LT((a.translation - b.translation).norm(), 1e-6) << word;
    EXPECT_LT((a.linear - b.linear).cwiseAbs().maxCoeff(), 1e-6) << word;
  }

  TwoArms arms_;
  plan::ExternalBindings all_ = manipulation::bind_externals(arms_.world, {});
  judge::CellState state_ = arms_.state();
};

TEST_F(Actions, HandOverEndsInTheOtherHandWithBothAtHome) {
  for (const auto& [from, to] : {std::pair{0U, 1U}, std::pair{1U, 0U}}) {
    const auto& robots = arms_.world.robots;
    const Words words = holding(from, 0, robots[from].home);
    const Answer answer =
        ask(all_, "handOver", {robots[from].name, "block", robots[to].name}, words);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    const std::vector<Motion> motions = motions_of(answer);
    ASSERT_EQ(motions.size(), 4U);
    const std::string order[] = {robots[from].name, robots[to].name, robots[from].name,
                                 robots[to].name};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(motions[i].robot, order[i]);
      EXPECT_EQ(motions[i].holds.contains("block"), i == 0 || i == 3);
      follow(motions[i]);
      if (i == 1) {
        EXPECT_TRUE(at_grasp(from) && at_grasp(to)) << "both hold it for a moment";
      }
    }
    EXPECT_EQ(state_.q[0], robots[0].home);
    EXPECT_EQ(state_.q[1], robots[1].home);
    EXPECT_EQ(answer.value.substr(0, 3 + robots[to].name.size()), "on " + robots[to].name);
    expect_block(answer.value);
    // The same question has the same answer.
    EXPECT_EQ(ask(all_, "handOver", {robots[from].name, "block", robots[to].name}, words).payload,
              answer.payload);
  }
}

TEST_F(Actions, WhatIsNotHeldIsNotHandedOver) {
  Words words = holding(0, 0, arms_.world.robots[0].home);
  EXPECT_EQ(ask(all_, "handOver", {"right", "block", "left"}, words).kind,
            Answer::Kind::Impossible);
  EXPECT_EQ(ask(all_, "handOver", {"left", "block", "left"}, words).kind, Answer::Kind::Impossible);
  words["pose(block)"] = "start";
  EXPECT_EQ(ask(all_, "handOver", {"left", "block", "right"}, words).kind,
            Answer::Kind::Impossible);
}

TEST_F(Actions, RefusalsNameWhatWasListed) {
  Words words = {{"conf(left)", "home"},
                 {"conf(right)", "home"},
                 {"pose(socket)", "start"},
                 {"pose(wall)", "start"},
                 {"pose(block)", "at 3 0.35 0.2 0 0 0 1"}};
  const Answer far = ask(all_, "reach", {"left", "block"}, words);
  EXPECT_EQ(far.kind, Answer::Kind::Impossible);
  EXPECT_NE(far.reason.find("none of the 5 grasps listed for block"), std::string::npos)
      << far.reason;
  EXPECT_FALSE(far.chosen);
  EXPECT_FALSE(far.listed) << "3 m away, no grasp is in reach";
  // Where the listed grasps are barely out of reach, another one might be within.
  Answer barely = Answer::holds(true);
  for (int cm = 80; cm < 300 && barely.kind != Answer::Kind::Impossible; cm += 5) {
    words["pose(block)"] = "at " + std::to_string(0.01 * cm) + " 0.35 0.2 0 0 0 1";
    barely = ask(all_, "reach", {"left", "block"}, words);
  }
  EXPECT_EQ(barely.kind, Answer::Kind::Impossible);
  EXPECT_TRUE(barely.listed) << barely.reason;
  words["pose(block)"] = "start";
  const Answer near = ask(all_, "reach", {"left", "block"}, words);
  EXPECT_EQ(near.kind, Answer::Kind::Value) << near.reason;
  EXPECT_TRUE(near.chosen) << "other grasps might do";
  const Answer home = ask(all_, "move", {"left", "home"}, words);
  EXPECT_EQ(home.kind, Answer::Kind::Value) << home.reason;
  EXPECT_TRUE(home.fixed && !home.chosen);
}

/// The block in another frame, an arm's length beside it: all that is asked is the same.
TEST_F(Actions, WhatIsBeyondReachDoesNotHangOnTheObjectsFrame) {
  const Vec3 shift(0, 0, 0.8);
  world::World moved = arms_.world;
  world::Object& block = moved.objects[TwoArms::kBlock];
  std::vector<geom::ConvexBody> bodies;
  for (std::size_t i = 0; i < block.outer.size(); ++i) {
    bodies.push_back(block.outer.body(i));
    for (Vec3& v : bodies.back().core.vertices) v += shift;
  }
  block.outer = {bodies, collide::Direction::Outer, block.outer.epsilon()};
  block.inner.reset();
  const Transform back{Eigen::Matrix3d::Identity(), -shift};
  block.pose = block.pose * back;
  for (world::Grasp& grasp : block.grasps) grasp.pose = grasp.pose * back;
  const plan::ExternalBindings other = manipulation::bind_externals(moved, {});
  int beyond = 0, barely = 0;
  for (int dm = 10; dm <= 40; dm += 1) {
    const auto verdict = [&](const plan::ExternalBindings& all, double z) {
      const Words words = {{"conf(left)", "home"},
                           {"conf(right)", "home"},
                           {"pose(socket)", "start"},
                           {"pose(wall)", "start"},
                           {"pose(block)", "at " + std::to_string(0.1 * dm) + " 0.35 " +
                                               std::to_string(z) + " 0 0 0 1"}};
      return ask(all, "reach", {"left", "block"}, words);
    };
    const Answer here = verdict(all_, 0.2), there = verdict(other, 0.2 - shift.z());
    EXPECT_EQ(here.kind, there.kind) << dm;
    EXPECT_EQ(here.listed, there.listed) << dm;
    if (here.kind == Answer::Kind::Impossible) ++(here.listed ? barely : beyond);
  }
  EXPECT_GT(beyond, 3);
  EXPECT_GT(barely, 0);
}

TEST_F(Actions, AnswersSayAmongHowManyGraspsTheyChose) {
  Words words = kAllAtStart;
  for (unsigned choice = 0; choice <= 5; ++choice) {
    const Answer answer = ask(all_, "fetch", {"left", "block", "home"}, words, 6, choice);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    EXPECT_EQ(answer.choices, 5U);
    EXPECT_TRUE(answer.chosen);
  }
  // What cannot be put down says how it is held.
  words = holding(0, 0, arms_.world.robots[0].home);
  words["pose(socket)"] = "at 5 0 0.2 0 0 0 1";
  const Answer put = ask(all_, "put", {"left", "block", "socket", "home"}, words, 2);
  EXPECT_EQ(put.kind, Answer::Kind::NotFound);
  EXPECT_NE(put.reason.find("block, held by its grasp 'top',"), std::string::npos) << put.reason;
}

/// Other choices put things elsewhere: beside the point, with all of the base on the face.
TEST_F(Actions, OtherChoicesPutThingsElsewhere) {
  const Words words = holding(0, 0, kDown);
  const std::vector<std::string> arguments = {"left", "block", "socket", "home"};
  std::set<std::string> places;
  for (unsigned choice = 0; choice <= 3; ++choice) {
    WordState state(words);
    const Answer answer = all_.at("put")({arguments, state, 1000U + choice, 0, choice});
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    EXPECT_EQ(answer.choices, 8U);
    places.insert(answer.value);
    const manipulation::ObjectPlace place =
        manipulation::place_of(answer.value, arms_.world, TwoArms::kBlock);
    for (const double x : {-0.025, 0.025})
      for (const double y : {-0.025, 0.025}) {
        const Vec3 corner = place.pose * Vec3(x, y, -0.08);
        EXPECT_LE(std::abs(corner.x() - 0.55), 0.05 - TwoArms::kEpsilon);
        EXPECT_LE(std::abs(corner.y() - 0.05), 0.05 - TwoArms::kEpsilon);
      }
  }
  EXPECT_EQ(places.size(), 4U);
}

/// A base that may not bridge the support's slots stands on the points alone, however it is turned.
TEST_F(Actions, NarrowThingsStandOnThePointsAlone) {
  const Words words = holding(0, 0, kDown);
  const std::vector<std::string> arguments = {"left", "block", "socket", "home"};
  const geom::Mesh face = box_at({0.1, 0.1, 0.04}, Vec3::Zero());
  world::Object &block = arms_.world.objects[TwoArms::kBlock],
                &socket = arms_.world.objects[TwoArms::kSocket];
  const auto stands_beside = [&](double epsilon) {
    socket.outer = {{{"", face}}, collide::Direction::Outer, epsilon};
    const plan::ExternalBindings externals = manipulation::bind_externals(arms_.world, {});
    int beside = 0;
    for (unsigned choice = 0; choice <= 3; ++choice) {
      WordState state(words);
      const Answer answer = externals.at("put")({arguments, state, 1000U + choice, 0, choice});
      EXPECT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
      if (answer.kind != Answer::Kind::Value) continue;
      const Vec3 at =
          manipulation::place_of(answer.value, arms_.world, TwoArms::kBlock).pose.translation;
      beside += (at - Vec3(0.55, 0.05, at.z())).norm() > 1e-6 ? 1 : 0;
    }
    return beside > 0;
  };
  // The block is 50 mm wide, less twice its own ε: more than four times the first ε.
  for (const double turn : {0.0, 0.25 * M_PI}) {
    block.pose.linear = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    EXPECT_TRUE(stands_beside(0.0122)) << turn;
    EXPECT_FALSE(stands_beside(0.0126)) << turn;
  }
  // Now on a foot of 40 mm, as high as 5 mm.
  block.outer = {{{"", box_at({0.05, 0.05, 0.155}, {0, 0, 0.0025})},
                  {"", box_at({0.04, 0.04, 0.16}, Vec3::Zero())}},
                 collide::Direction::Outer,
                 TwoArms::kEpsilon};
  EXPECT_TRUE(stands_beside(0.0098));
  EXPECT_FALSE(stands_beside(0.0102));
}

/// What fails among the things that a call names fails whatever else there is: nothing else is
/// read. What succeeds among them has looked at everything.
TEST_F(Actions, WhatFailsAmongWhatItNamesReadsNothingElse) {
  Words words = holding(0, 0, arms_.world.robots[0].home);
  const std::vector<std::string> arguments = {"left", "block", "socket", "home"};
  const auto read_by = [&](unsigned attempt, bool early, Answer::Kind kind) {
    WordState state(words);
    const Answer answer = all_.at("put")({arguments, state, 7, attempt, 0, early});
    EXPECT_EQ(answer.kind, kind) << answer.reason;
    std::vector<std::string> read = state.read();
    std::ranges::sort(read);
    read.erase(std::ranges::unique(read).begin(), read.end());
    return read;
  };
  const std::vector<std::string> named = {"conf(left)", "pose(block)", "pose(socket)"},
                                 all = {"conf(left)", "conf(right)", "pose(block)", "pose(socket)",
                                        "pose(wall)"};
  EXPECT_EQ(read_by(0, false, Answer::Kind::Value), all);
  words["pose(socket)"] = "at 5 0 0.2 0 0 0 1";
  EXPECT_EQ(read_by(0, false, Answer::Kind::NotFound), named);
  EXPECT_EQ(read_by(1, false, Answer::Kind::NotFound), named);
  // Before the search it reads on before it looks for paths.
  EXPECT_EQ(read_by(0, true, Answer::Kind::NotFound), all);
  // So it is, whatever the others are: in the way, or held by somebody.
  for (const char* wall : {"start", "away", "at 0.527 0.05 -0.06 0 0 0 1"}) {
    words["pose(wall)"] = wall;
    EXPECT_EQ(read_by(0, false, Answer::Kind::NotFound), named);
  }
}

TEST_F(Actions, LiftIsStraightUp) {
  const Words words = holding(0, 0, kDown);
  const Transform before = block();
  const Answer answer = ask(all_, "lift", {"left", "block"}, words);
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  const std::vector<Motion> motions = motions_of(answer);
  ASSERT_EQ(motions.size(), 1U);
  double height = 0;
  follow(motions[0], [&] {
    const Vec3 gone = block().translation - before.translation;
    EXPECT_LT(std::hypot(gone.x(), gone.y()), 0.01);
    EXPECT_GT(gone.z(), height - 1e-3);  // it does not go down
    height = std::max(height, gone.z());
  });
  EXPECT_LT((block().translation - before.translation - Vec3(0, 0, 0.1)).norm(), 1e-6);
  EXPECT_LT((block().linear - before.linear).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(answer.value, manipulation::word_of(state_.q[0]));
  // Under a plate there is no room: not found, never a path through it.
  Words under = words;
  under["pose(wall)"] = "at 0.27 0.35 1.06 0 0.7071068 0 0.7071068";
  state_ = arms_.state();
  EXPECT_NE(ask(all_, "lift", {"left", "block"}, under, 2).kind, Answer::Kind::Value);
  EXPECT_EQ(ask(all_, "lift", {"right", "block"}, words, 2).kind, Answer::Kind::Impossible);
}

TEST_F(Actions, PutUprightLeansNoMoreThanItMay) {
  const Words words = holding(0, 0, kDown);
  const std::string end = manipulation::word_of(kDown);
  const Answer answer = ask(all_, "putUpright", {"left", "block", "socket", end}, words);
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  const std::vector<Motion> motions = motions_of(answer);
  ASSERT_GE(motions.size(), 2U);
  double most = 0;
  std::size_t looked = 0;
  for (const Motion& m : motions)
    follow(m, [&] {
      const Vec3 up = block().linear * Vec3::UnitZ();
      most = std::max(most, std::atan2(std::hypot(up.x(), up.y()), up.z()));
      ++looked;
    });
  EXPECT_LE(most, 0.26);
  EXPECT_GT(looked, 50U);
  EXPECT_EQ(state_.q[0], kDown);
  expect_block(answer.value);
  // It stands on the socket's top, as far above as is stated.
  const Vec3 foot = block() * Vec3(0, 0, -0.08), top(0.55, 0.05, 0.041);
  EXPECT_LT((foot - top - Vec3(0, 0, 1e-3 + 2 * TwoArms::kEpsilon)).norm(), 1e-6);
  // From a configuration in which it leans already there is none.
  const Words leaning = holding(0, 0, arms_.world.robots[0].home);
  const Answer no = ask(all_, "putUpright", {"left", "block", "socket", end}, leaning, 2);
  EXPECT_NE(no.kind, Answer::Kind::Value);
  EXPECT_NE(no.reason.find("cannot start: 'block upright' is off by"), std::string::npos)
      << no.reason;
  // But it can be put there without.
  EXPECT_EQ(ask(all_, "put", {"left", "block", "socket", end}, leaning).kind, Answer::Kind::Value);
}

TEST_F(Actions, WhatTheSceneWantsUprightIsCarriedSoByEveryAction) {
  world::World world = arms_.world;
  world.objects[TwoArms::kBlock].upright = 0.15;
  const plan::ExternalBindings upright = manipulation::bind_externals(world, {});
  const Words words = holding(0, 0, kDown);
  const std::string end = manipulation::word_of(kDown);
  const auto most_lean = [&](const plan::ExternalBindings& bindings, const std::string& action,
                             const std::vector<std::string>& arguments) {
    static_cast<void>(holding(0, 0, kDown));
    const Answer answer = ask(bindings, action, arguments, words);
    if (answer.kind != Answer::Kind::Value) return -1.0;
    double most = 0;
    for (const Motion& m : motions_of(answer))
      follow(m, [&] {
        const Vec3 up = block().linear * Vec3::UnitZ();
        if (state_.objects[TwoArms::kBlock].hold)
          most = std::max(most, std::atan2(std::hypot(up.x(), up.y()), up.z()));
      });
    return most;
  };
  const std::vector<std::string> put{"left", "block", "socket", end},
      tilt{"left", manipulation::word_of(arms_.world.robots[0].home)};
  const double lean = most_lean(upright, "put", put);
  EXPECT_GE(lean, 0);
  EXPECT_LE(lean, 0.15);
  // At home the hand tilts it: without, the robot goes there.
  EXPECT_GT(most_lean(all_, "move", tilt), 0.3);
  EXPECT_EQ(most_lean(upright, "move", tilt), -1);
  // Nothing carries it on from where it leans already, and nothing takes it where it would.
  const Words leaning = holding(0, 0, arms_.world.robots[0].home);
  for (const char* action : {"put", "lift", "handOver"}) {
    const std::string name = action;
    const std::vector<std::string> arguments =
        name == "put"    ? std::vector<std::string>{"left", "block", "socket", end}
        : name == "lift" ? std::vector<std::string>{"left", "block"}
                         : std::vector<std::string>{"left", "block", "right"};
    EXPECT_NE(ask(upright, name, arguments, leaning).kind, Answer::Kind::Value) << name;
  }
}

TEST_F(Actions, SatisfyGoesToAMateWhereverItIs) {
  world::World world = arms_.world;
  const auto feature = [&](const std::string& name) { return world::find_feature(world, name); };
  using kinematics::Relation;
  world::ConstraintSet mate{"above-socket", {}};
  mate.constraints.push_back(
      {Relation::Distance, feature("block.origin"), feature("socket.xy"), 0.25, 1e-3, 0.02});
  mate.constraints.push_back(
      {Relation::Coincident, feature("block.origin"), feature("socket.z"), 0, 1e-3, 0.02});
  mate.constraints.push_back(
      {Relation::Angle, feature("socket.z"), feature("block.z"), 0, 1e-3, 0.02});
  world.constraints.push_back(mate);
  const plan::ExternalBindings bindings = manipulation::bind_externals(world, {});
  Words words = holding(0, 0, kDown);
  for (const char* socket : {"start", "at 0.45 0.2 0.02 0 0 0 1"}) {
    words = holding(0, 0, kDown);
    words["pose(socket)"] = socket;
    const Answer answer = ask(bindings, "satisfy", {"left", "above-socket"}, words, 3);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    EXPECT_TRUE(answer.chosen);
    for (const Motion& m : motions_of(answer))
      for (const std::vector<double>& q : m.path) state_.q[0] = q;
    EXPECT_EQ(answer.value, manipulation::word_of(state_.q[0]));
    const Vec3 at = std::string(socket) == "start"
                        ? Vec3(arms_.world.objects[TwoArms::kSocket].pose.translation)
                        : Vec3(0.45, 0.2, 0.02);
    EXPECT_LT((block().translation - at).head<2>().norm(), 1.1e-3);
    EXPECT_NEAR(std::abs(block().translation.z() - at.z()), 0.25, 1.1e-3);
    EXPECT_GT(block().linear(2, 2), std::cos(0.021));
  }
  // Without the block there is nothing that could be there.
  words["pose(block)"] = "start";
  const Answer none = ask(bindings, "satisfy", {"left", "above-socket"}, words);
  EXPECT_EQ(none.kind, Answer::Kind::Impossible);
  EXPECT_NE(none.reason.find("is not between what moves with left now"), std::string::npos);
  EXPECT_THROW(ask(bindings, "satisfy", {"left", "above-sockets"}, words), Error);
  // What no motion is decided for is a fault of the scene, not of how things are.
  mate.constraints = {
      {Relation::Coincident, feature("block.xy"), feature("socket.origin"), 0, 1e-3, 0.02}};
  world.constraints = {mate};
  EXPECT_THROW(ask(manipulation::bind_externals(world, {}), "satisfy", {"left", "above-socket"},
                   holding(0, 0, kDown)),
               Error);
}

TEST_F(Actions, AMateOnASurfaceIsAnywhereOnItAndMeetsWhatItPrefers) {
  world::World world = arms_.world;
  using kinematics::Relation;
  using Kind = world::Feature::Kind;
  world.objects[TwoArms::kSocket].features.push_back(
      {"floor",
       Kind::Surface,
       {0, 0, 0.02},
       Vec3::UnitZ(),
       {{-0.02, -0.03, 0.02}, {0.02, -0.03, 0.02}, {0.02, 0.03, 0.02}, {-0.02, 0.03, 0.02}},
       0});
  const auto feature = [&](const std::string& name) { return world::find_feature(world, name); };
  world::ConstraintSet mate{"on-floor", {}};
  mate.constraints = {
      {Relation::Distance, feature("block/bottom"), feature("socket/floor"), 0.004, 1e-3, 0.02},
      {Relation::Angle, feature("block.z"), feature("socket.z"), 0, 1e-3, 0.01}};
  mate.preferred = {{Relation::Angle, feature("block.x"), feature("socket.x"), 0.5, 1e-3, 0.02},
                    {Relation::Angle, feature("block.x"), feature("socket.x"), 1.5, 1e-3, 0.02}};
  world.constraints.push_back(mate);
  const plan::ExternalBindings bindings = manipulation::bind_externals(world, {});
  std::set<std::array<bool, 2>> quarters;
  for (unsigned choice = 0; choice <= 8; ++choice) {
    const Words words = holding(0, 0, kDown);
    const Answer answer =
        ask(bindings, "mate", {"left", "block", "socket", "on-floor", "home"}, words, 6, choice);
    ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
    EXPECT_EQ(answer.choices, 8U);
    const std::vector<Motion> motions = motions_of(answer);
    for (const Motion& m : motions) {
      follow(m);
      // It is let go at the end of the last motion with the block.
      const bool last = &m == &motions.back() || !(&m + 1)->holds.contains("block");
      if (m.holds.contains("block") && last) {
        const Transform socket = arms_.world.objects[TwoArms::kSocket].pose;
        const Vec3 bottom = block() * Vec3(0, 0, -0.08) - socket.translation;
        EXPECT_NEAR(bottom.z(), 0.024, 1.1e-3);
        EXPECT_LT(std::abs(bottom.x()), 0.021);
        EXPECT_LT(std::abs(bottom.y()), 0.031);
        quarters.insert({bottom.x() > 0, bottom.y() > 0});
        EXPECT_GT(block().linear(2, 2), std::cos(0.011));
        EXPECT_NEAR(std::acos(block().linear(0, 0)), 0.5, 0.021) << "the first preference";
      }
    }
  }
  EXPECT_EQ(quarters.size(), 4U);
  // Where no configuration meets the constraints, nothing is claimed; where the arm is too short,
  // that is proved.
  Words words = holding(0, 0, kDown);
  words["pose(socket)"] = "at 3 0 0.02 0 0 0 1";
  const Answer far = ask(bindings, "mate", {"left", "block", "socket", "on-floor", "home"}, words);
  EXPECT_EQ(far.kind, Answer::Kind::Impossible);
  EXPECT_NE(far.reason.find("does not reach so far as 'on-floor' asks: distance 'bottom' 'floor'"),
            std::string::npos)
      << far.reason;
}

TEST_F(Actions, TablesIAndII) {
  Words words = {
      {"pose(block)", "start"}, {"pose(socket)", "start"}, {"pose(wall)", "at 5 5 5 0 0 0 1"}};
  for (std::size_t r = 0; r < 2; ++r) words["conf(" + arms_.world.robots[r].name + ")"] = "home";
  const auto holds = [&](const std::string& function, const std::vector<std::string>& arguments) {
    return ask(all_, function, arguments, words).kind == Answer::Kind::Value;
  };
  EXPECT_TRUE(holds("isReachable", {"block", "left"}));
  EXPECT_TRUE(holds("isReachable", {"left", "block"}));
  EXPECT_FALSE(holds("graspMotionCollides", {"left", "block", "wall"}));
  EXPECT_FALSE(holds("graspMotionCollides", {"left", "block", "block"}));
  // The wall through the block.
  const Vec3 at = arms_.world.objects[TwoArms::kBlock].pose.translation;
  words["pose(wall)"] = manipulation::word_of(Transform{Eigen::Matrix3d::Identity(), at});
  EXPECT_TRUE(holds("graspMotionCollides", {"left", "block", "wall"}));
  // One motion, whatever a question's seed is made of: walls beside it are in its way, or not.
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> beside(-0.45, 0.45);
  int collide = 0, free = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 by(beside(random), beside(random), 0.2 + std::abs(beside(random)));
    words["pose(wall)"] = manipulation::word_of(Transform{Eigen::Matrix3d::Identity(), at + by});
    // From where a straight way is not free, a path is found at random.
    std::vector<double> from = arms_.world.robots[0].home;
    for (double& x : from) x += 5 * beside(random);
    words["conf(left)"] = manipulation::word_of(from);
    words["pose(socket)"] = manipulation::word_of(
        Transform{Eigen::Matrix3d::Identity(), at + Vec3(beside(random), beside(random), 0.25)});
    const std::vector<std::string> arguments{"left", "block", "wall"};
    const auto kind_of = [&](std::uint64_t seed, unsigned attempt) {
      WordState state(words);
      return all_.at("graspMotionCollides")({arguments, state, seed, attempt}).kind;
    };
    const Answer::Kind first = kind_of(7, 0);
    EXPECT_EQ(kind_of(99, 0), first);
    EXPECT_EQ(kind_of(1234, 0), first);
    if (first != Answer::Kind::NotFound) {
      EXPECT_EQ(kind_of(99, 2), first);
    }
    collide += first == Answer::Kind::Value ? 1 : 0;
    free += first == Answer::Kind::Impossible ? 1 : 0;
  }
  EXPECT_GT(collide, 5);
  EXPECT_GT(free, 5);
  words["conf(left)"] = "home";
  words["pose(socket)"] = "start";
  words["pose(wall)"] = "away";
  EXPECT_FALSE(holds("graspMotionCollides", {"left", "block", "wall"}));
  // Out of reach: nothing fetches it freely either.
  words["pose(block)"] = "at 9 9 9 0 0 0 1";
  words["pose(wall)"] = "at 5 5 5 0 0 0 1";
  EXPECT_FALSE(holds("isReachable", {"block", "left"}));
  EXPECT_TRUE(holds("graspMotionCollides", {"left", "block", "wall"}));
  EXPECT_THROW(holds("graspMotionCollides", {"block", "wall"}), Error);
  EXPECT_THROW(holds("isReachable", {"wall", "left"}), Error);
  EXPECT_THROW(holds("isReachable", {"left"}), Error);
}

/// A wall stands across the socket's middle; beside it there is room for the block.
TEST_F(Actions, WhatFindsNoRoomAtAPointStandsElsewhereOnItsFace) {
  Words words = holding(0, 0, kDown);
  words["pose(wall)"] = "at 0.527 0.05 -0.06 0 0 0 1";
  state_.objects[TwoArms::kWall].pose.translation = {0.527, 0.05, -0.06};
  EXPECT_EQ(ask(all_, "put", {"left", "block", "socket", "home"}, words, 1).kind,
            Answer::Kind::NotFound);
  const Answer answer = ask(all_, "put", {"left", "block", "socket", "home"}, words, 8);
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  EXPECT_TRUE(answer.chosen);
  for (const Motion& m : motions_of(answer)) follow(m);
  expect_block(answer.value);
  // All of its base is on the socket's face.
  for (const double x : {-0.025, 0.025})
    for (const double y : {-0.025, 0.025}) {
      const Vec3 corner = block() * Vec3(x, y, -0.08);
      EXPECT_LE(std::abs(corner.x() - 0.55), 0.05 - TwoArms::kEpsilon);
      EXPECT_LE(std::abs(corner.y() - 0.05), 0.05 - TwoArms::kEpsilon);
      EXPECT_NEAR(corner.z(), 0.041 + 1e-3 + 2 * TwoArms::kEpsilon, 1e-6);
    }
  // Where the wall covers the face there is no room, and that is no proof.
  words["pose(wall)"] = "at 0.55 0.05 -0.06 0 0 0 1";
  const Answer none = ask(all_, "put", {"left", "block", "socket", "home"}, words, 3);
  EXPECT_EQ(none.kind, Answer::Kind::NotFound);
  EXPECT_NE(none.reason.find("other places there were tried"), std::string::npos) << none.reason;
}

TEST_F(Actions, JoinSlidesAlongTheSeatsNormal) {
  const Words words = holding(0, 0, kDown);
  const Answer answer = ask(all_, "join", {"left", "block", "socket", "home"}, words);
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  const std::vector<Motion> motions = motions_of(answer);
  ASSERT_EQ(motions.size(), 4U);
  const Vec3 seat(0.55, 0.05, 0.041);
  const auto foot = [&] { return Vec3(block() * Vec3(0, 0, -0.08)); };
  follow(motions[0]);
  EXPECT_NEAR(foot().z() - seat.z(), 0.07 + 1e-3 + 2 * TwoArms::kEpsilon, 1e-6);  // the entry
  follow(motions[1], [&] {
    EXPECT_LT(std::hypot(foot().x() - seat.x(), foot().y() - seat.y()), 1e-3);
    EXPECT_GT((block().linear * Vec3::UnitZ()).z(), 1 - 1e-4);
  });
  EXPECT_LT((foot() - seat - Vec3(0, 0, 1e-3 + 2 * TwoArms::kEpsilon)).norm(), 1e-6);
  EXPECT_EQ(answer.value.substr(0, 10), "in socket ");
  expect_block(answer.value);
  const Transform tool = hand(0);
  follow(motions[2], [&] {
    const Vec3 back = tool.linear.transpose() * (hand(0).translation - tool.translation);
    EXPECT_LT(std::hypot(back.x(), back.y()), 1e-3) << "straight back";
    EXPECT_LT(back.z(), 1e-3);
  });
  follow(motions[3]);
  EXPECT_EQ(state_.q[0], arms_.world.robots[0].home);
  expect_block(answer.value);
  // Mounted, it is no longer there to be mounted; nor is it mounted on itself.
  Words mounted = words;
  mounted["pose(block)"] = answer.value;
  EXPECT_EQ(ask(all_, "join", {"left", "block", "socket", "home"}, mounted).kind,
            Answer::Kind::Impossible);
  EXPECT_EQ(ask(all_, "join", {"left", "block", "block", "home"}, words).kind,
            Answer::Kind::Impossible);
}

/// The same cell with every box so much larger on each side.
judge::Cell enlarged(const TwoArms& arms, double by) {
  judge::Cell out;
  const auto larger = [&](const geom::Mesh& mesh) {
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& v : mesh.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    return box_at(high - low + Vec3::Constant(2 * by), 0.5 * (low + high));
  };
  for (const world::RobotModel& robot : arms.world.robots)
    out.add_robot(robot.name, robot.kinematics, robot.base);
  for (std::size_t r = 0; r < arms.world.robots.size(); ++r)
    for (const world::LinkShape& shape : arms.world.robots[r].shapes)
      out.add_link(r, shape.link, larger(shape.outer.body(0).core));
  for (const world::Object& o : arms.world.objects)
    out.add_object(o.name, larger(o.outer.body(0).core));
  return out;
}

TEST_F(Actions, SweptCollidesIsNeverWronglyFreeAndRarelyWronglyNot) {
  const judge::Cell large = enlarged(arms_, 0.01);
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  int free = 0, certain = 0, near = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<double> to = arms_.world.robots[0].home;
    for (std::size_t j = 0; j < to.size(); ++j)
      to[j] = std::clamp(to[j] + 0.5 * normal(random), -2.1, 2.1);
    to = manipulation::configuration_of(manipulation::word_of(to), arms_.world.robots[0]);
    Transform at;
    at.linear = Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random))
                    .normalized()
                    .toRotationMatrix();
    at.translation = {0.45 + 0.3 * unit(random), 0.35 + 0.4 * unit(random),
                      0.8 + 0.3 * unit(random)};
    const std::string wall = manipulation::word_of(at);
    const Words words = {{"conf(left)", "home"}, {"conf(right)", "home"}, {"pose(wall)", wall}};
    WordState state(words);
    const std::vector<std::string> arguments = {"left", manipulation::word_of(to), "wall"};
    const Answer answer = all_.at("sweptCollides")({arguments, state, 1, 0});
    judge::CellState now = arms_.state();
    for (judge::CellState::Place& place : now.objects) place.away = true;
    now.objects[TwoArms::kWall] = {
        manipulation::place_of(wall, arms_.world, TwoArms::kWall).pose, {}, false};
    bool meets = false, may = false;
    for (const std::vector<double>& q : samples_of({now.q[0], to}, 0.004)) {
      now.q[0] = q;
      meets = meets || arms_.cell.find_meeting(now, 0).has_value();
      may = may || large.find_meeting(now, 0).has_value();
    }
    if (meets) {
      EXPECT_EQ(answer.kind, Answer::Kind::Value) << i;
    }
    if (!may) {
      EXPECT_EQ(answer.kind, Answer::Kind::Impossible) << i << ": 2 cm apart";
    }
    ++(meets ? certain : may ? near : free);
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(certain, 20);
}

TEST_F(Actions, SweptCollidesReadsTheOtherRobotToo) {
  // The arm goes to the other side; the other one is there, or has gone.
  const std::vector<double> over = {-1.2, -0.3, 1.5, 0, 1.2, 0};
  const std::vector<std::string> arguments = {"left", manipulation::word_of(over), "wall"};
  const auto answer = [&](const std::vector<double>& right) {
    WordState state({{"conf(left)", "home"},
                     {"conf(right)", manipulation::word_of(right)},
                     {"pose(wall)", "start"}});
    return all_.at("sweptCollides")({arguments, state, 1, 0}).kind;
  };
  judge::CellState now = arms_.state();
  for (judge::CellState::Place& place : now.objects) place.away = true;
  for (const std::vector<double>& right : {std::vector<double>{0, -0.3, 1.5, 0, 1.2, 0},
                                           std::vector<double>{-2.5, -0.3, 1.5, 0, 1.2, 0},
                                           std::vector<double>{0.9, -0.3, 1.5, 0, 1.2, 0}}) {
    bool meets = false;
    now.q[1] = right;
    for (const std::vector<double>& q : samples_of({arms_.world.robots[0].home, over}, 0.004)) {
      now.q[0] = q;
      meets = meets || arms_.cell.find_meeting(now, 0).has_value();
    }
    EXPECT_EQ(answer(right) == Answer::Kind::Value, meets);
  }
}

/// The block's only grasp is at a side, anywhere round its axis and up to 2 cm higher.
TwoArms with_family() {
  TwoArms arms;
  std::vector<world::Grasp>& grasps = arms.world.objects[TwoArms::kBlock].grasps;
  grasps = {grasps[1]};
  grasps[0].turn = world::FreeTurn{};
  grasps[0].slides = {{Vec3::UnitZ(), 0, 0.02}};
  return arms;
}

/// How the hand of the left arm has the block, at the end of a path.
Transform in_hand(const TwoArms& arms, const std::vector<double>& q) {
  const world::RobotModel& left = arms.world.robots[0];
  const Transform tool =
      judge::product(judge::places(left.kinematics, left.base, q)[arms.hand], left.tools[0].pose);
  const Transform back{tool.linear.transpose(), -(tool.linear.transpose() * tool.translation)};
  return judge::product(back, arms.world.objects[TwoArms::kBlock].pose);
}

/// That a tool stands off the block's axis by `radius`, looks straight at it, and is 0 to 2 cm
/// above where the stated pose has it.
void expect_at_side(const Transform& held) {
  const Vec3 origin = -(held.linear.transpose() * held.translation);  // in the block's frame
  const Vec3 looks = held.linear.transpose().col(2), along = held.linear.transpose().col(0);
  EXPECT_NEAR(origin.head<2>().norm(), 0.025 + TwoArms::kGap, 1e-6);
  EXPECT_LT((looks.head<2>() + origin.head<2>().normalized()).norm(), 1e-6);
  EXPECT_NEAR(std::abs(along.z()), 1, 1e-6);
  const double stated = 0.03 * -along.z();
  EXPECT_GE(origin.z(), stated - 1e-6);
  EXPECT_LE(origin.z(), stated + 0.02 + 1e-6);
}

TEST(GraspFamilies, AreReachedAndTakenAtAnyMember) {
  const TwoArms arms = with_family();
  const plan::ExternalBindings all = manipulation::bind_externals(arms.world, {});
  const Words words = kAllAtStart;
  const Answer there = ask(all, "reach", {"left", "block"}, words);
  ASSERT_EQ(there.kind, Answer::Kind::Value) << there.reason;
  const std::vector<double> q = motions_of(there).back().path.back();
  expect_at_side(in_hand(arms, q));
  const Answer held = ask(all, "grasp", {"left", "block", there.value}, words);
  ASSERT_EQ(held.kind, Answer::Kind::Value) << held.reason;
  // A little off is at none.
  std::vector<double> off = q;
  off[1] += 1e-4;
  EXPECT_EQ(ask(all, "grasp", {"left", "block", manipulation::word_of(off)}, words).kind,
            Answer::Kind::Impossible);
}

TEST(GraspFamilies, ASearchMayPreferOneMemberAfterTheOther) {
  // From above, at any turn.
  TwoArms arms;
  std::vector<world::Grasp>& grasps = arms.world.objects[TwoArms::kBlock].grasps;
  grasps = {grasps[0]};
  grasps[0].turn = world::FreeTurn{};
  const plan::ExternalBindings all = manipulation::bind_externals(arms.world, {});
  const Words words = kAllAtStart;
  const unsigned choices = ask(all, "reach", {"left", "block"}, words).choices;
  EXPECT_EQ(choices, 8U);
  std::set<long> turns;
  for (unsigned choice = 1; choice <= choices; ++choice) {
    const Answer there = ask(all, "reach", {"left", "block"}, words, 6, choice);
    ASSERT_EQ(there.kind, Answer::Kind::Value) << there.reason;
    const Transform held = in_hand(arms, motions_of(there).back().path.back());
    EXPECT_LT((held.translation - grasps[0].pose.translation).norm(), 1e-6);
    EXPECT_NEAR(held.linear(2, 2), -1, 1e-9);
    turns.insert(std::lround(std::atan2(held.linear(1, 0), held.linear(0, 0)) * 1000));
  }
  EXPECT_EQ(turns.size(), 8U);
}

TEST(GraspFamilies, NotFoundIsNoProofButDistanceIs) {
  TwoArms arms = with_family();
  std::map<std::string, std::string> words = {{"conf(left)", "home"},
                                              {"conf(right)", "home"},
                                              {"pose(socket)", "start"},
                                              {"pose(wall)", "start"}};
  const auto kind = [&](const std::string& pose) {
    words["pose(block)"] = pose;
    return ask(manipulation::bind_externals(arms.world, {}), "reach", {"left", "block"}, words)
        .kind;
  };
  // Upside down under the table, and farther away than the arm is long.
  EXPECT_EQ(kind("at 0.5 0.3 -0.2 0 0 0 1"), Answer::Kind::NotFound);
  EXPECT_EQ(kind("at 5 0.3 0.1 0 0 0 1"), Answer::Kind::Impossible);
  // Slides may bring the tool nearer: then it is not said.
  arms.world.objects[TwoArms::kBlock].grasps[0].slides[0] = {Vec3::UnitX(), -3.7, 0};
  EXPECT_EQ(kind("at 5 0.3 0.1 0 0 0 1"), Answer::Kind::NotFound);
}

TEST(GraspFamilies, TheLowestRankIsTakenWhereItDoes) {
  TwoArms arms;
  std::vector<world::Grasp>& grasps = arms.world.objects[TwoArms::kBlock].grasps;
  const Words words = kAllAtStart;
  for (const std::size_t first : {0U, 1U, 2U}) {
    for (world::Grasp& grasp : grasps) grasp.rank = 1;
    grasps[first].rank = 0;
    const Answer there =
        ask(manipulation::bind_externals(arms.world, {}), "reach", {"left", "block"}, words);
    ASSERT_EQ(there.kind, Answer::Kind::Value) << there.reason;
    const Transform held = in_hand(arms, motions_of(there).back().path.back());
    EXPECT_LT((held.translation - grasps[first].pose.translation).norm(), 1e-6) << first;
    EXPECT_LT((held.linear - grasps[first].pose.linear).norm(), 1e-6) << first;
  }
}

}  // namespace
}  // namespace kaboum::test
