// Answers are looked for among what a call is about, and shared by states: all else has to be kept
// clear of all the same, and nothing that was asked before may matter.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>

#include <Eigen/Geometry>
#include <random>
#include <set>

#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using plan::Answer;

struct ActionCall {
  std::string function;
  std::vector<std::string> arguments;
  std::map<std::string, std::string> words;
};

/// Calls with a wall somewhere, mostly where the left arm has to go, and the right arm anywhere.
std::vector<ActionCall> random_calls(const TwoArms& arms, std::size_t count, bool wall_is_held) {
  std::mt19937_64 random(11);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<ActionCall> out;
  for (std::size_t i = 0; i < count; ++i) {
    ActionCall call;
    call.words = {{"conf(left)", "home"}, {"conf(right)", "home"}, {"pose(socket)", "start"}};
    if (i % 3 != 0) {
      std::vector<double> q = arms.world.robots[TwoArms::kRight].home;
      for (double& x : q) x += between(-0.8, 0.8);
      if (wall_is_held) q[0] += 0.6;  // towards the other arm
      call.words["conf(right)"] = manipulation::word_of(q);
    }
    const Transform at{Eigen::AngleAxisd(between(-3, 3), Vec3::UnitZ()).toRotationMatrix(),
                       {between(0.25, 0.65), between(0, 0.5), between(0.2, 0.8)}};
    call.words["pose(wall)"] = i % 4 == 0 ? "start" : manipulation::word_of(at);
    if (wall_is_held) {
      world::Attachment held;
      held.robot = TwoArms::kRight;
      held.link = arms.hand;
      held.pose.translation = {0, 0, 0.4};
      call.words["pose(wall)"] = manipulation::word_of(arms.world, held);
    }
    const bool holds = i % 2 == 1;
    call.words["pose(block)"] = holds ? arms.word(arms.hold(TwoArms::kLeft, 0)) : "start";
    call.function = holds ? "put" : "fetch";
    call.arguments = holds ? std::vector<std::string>{"left", "block", "socket", "home"}
                           : std::vector<std::string>{"left", "block", "home"};
    out.push_back(std::move(call));
  }
  return out;
}

void expect_same(const Answer& a, const Answer& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.payload, b.payload);
  EXPECT_EQ(a.reason, b.reason);
}

/// Carries the motions out among the exact meshes. @return samples in contact.
int contacts_of(const TwoArms& arms, const ActionCall& call, const Answer& answer) {
  judge::CellState state = arms.state();
  for (std::size_t r = 0; r < 2; ++r)
    state.q[r] = manipulation::configuration_of(
        call.words.at("conf(" + arms.world.robots[r].name + ")"), arms.world.robots[r]);
  for (const std::size_t o : {TwoArms::kBlock, TwoArms::kWall}) {
    const manipulation::ObjectPlace place = manipulation::place_of(
        call.words.at("pose(" + arms.world.objects[o].name + ")"), arms.world, o);
    state.objects[o].pose = place.pose;
    if (place.attachment) state.objects[o].hold = arms.hold_of(*place.attachment);
  }
  int contacts = 0;
  for (const Motion& m : motions_of(answer)) {
    judge::CellState::Place& block = state.objects[TwoArms::kBlock];
    if (m.holds.contains("block") != block.hold.has_value()) {
      const Transform pose = arms.cell.pose_of(state, TwoArms::kBlock);
      if (block.hold) {
        block.pose = pose;
        block.hold.reset();
      } else {
        const Transform hand = arms.cell.pose_of(state, TwoArms::kLeft, arms.hand);
        const Transform inverse{hand.linear.transpose(),
                                -(hand.linear.transpose() * hand.translation)};
        block.hold = judge::Hold{TwoArms::kLeft, arms.hand, judge::product(inverse, pose), {}};
      }
    }
    for (const std::vector<double>& q : samples_of(m.path, 0.01)) {
      state.q[TwoArms::kLeft] = q;
      contacts += arms.cell.find_meeting(state, TwoArms::kLeft) ? 1 : 0;
    }
  }
  return contacts;
}

class Involved : public ::testing::TestWithParam<bool> {};

TEST_P(Involved, WhatIsInTheWayIsKeptClearOfAndNothingAskedBeforeMatters) {
  const TwoArms arms;
  const std::vector<ActionCall> calls = random_calls(arms, 36, GetParam());
  const auto there = manipulation::bind_externals(arms.world, {});
  const auto back = manipulation::bind_externals(arms.world, {});
  std::vector<Answer> answers;
  for (const ActionCall& c : calls)
    answers.push_back(ask(there, c.function, c.arguments, c.words, 2));
  for (std::size_t i = calls.size(); i-- > 0;)
    expect_same(answers[i], ask(back, calls[i].function, calls[i].arguments, calls[i].words, 2));
  int found = 0, failed = 0;
  std::set<std::string> paths;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (i % 6 == 0)
      expect_same(answers[i], ask(manipulation::bind_externals(arms.world, {}), calls[i].function,
                                  calls[i].arguments, calls[i].words, 2));
    (answers[i].kind == Answer::Kind::Value ? found : failed) += 1;
    if (answers[i].kind != Answer::Kind::Value) continue;
    paths.insert(answers[i].payload);
    EXPECT_EQ(contacts_of(arms, calls[i], answers[i]), 0) << i;
  }
  EXPECT_GT(found, 10);
  if (!GetParam()) {
    EXPECT_GT(failed, 2);
  }
  EXPECT_GT(paths.size(), GetParam() ? 1U : 2U) << "other paths where something is in the way";
  EXPECT_LT(static_cast<int>(paths.size()), found) << "the same where nothing is";
}

INSTANTIATE_TEST_SUITE_P(TheWall, Involved, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "InTheOtherHand" : "Rests"; });

}  // namespace
}  // namespace kaboum::test
