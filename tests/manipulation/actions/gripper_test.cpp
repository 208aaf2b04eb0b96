// Fingers that close on things and open from them: what is answered is carried out among exact
// meshes by the judge, and what must not touch is refused.

#include <gtest/gtest.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/gripper.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <numbers>

#include "goals.h"
#include "lines.h"
#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using plan::Answer;
using Words = std::map<std::string, std::string>;

/// The left arm of TwoArms with two fingers, which one joint moves along x of the hand, or three
/// about its axis; a block between them, and what stands beside it.
class Fingers {
 public:
  struct Shape {
    int fingers = 2;
    double width = 0.05;  ///< of the block [m]
    double pad = 0.006;   ///< thickness [m]
    double open = 0.04;   ///< value of the joint: from the middle to a pad [m]
    double within = 0.001;
    std::optional<Vec3> post = {};  ///< beside the block, in its frame: the middle of a thin one
  };
  static constexpr double kTip = 0.24;

  explicit Fingers(const Shape& s) : shape(s) {
    world::RobotModel& robot = arms.world.robots[0];
    robot::Robot& chain = robot.kinematics;
    const auto variable = static_cast<std::uint32_t>(chain.variables.size());
    chain.variables.push_back({"finger", 0.0, 0.06});
    robot.home.push_back(s.open);
    world::Gripper gripper{"fingers", 0, {}};
    gripper.joints = {variable};
    for (int k = 0; k < s.fingers; ++k) {
      const double angle = 2 * std::numbers::pi * k / s.fingers;
      const Transform turn{Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix(),
                           Vec3::Zero()};
      const std::string name = std::to_string(k);
      const std::uint32_t finger = add_link("finger" + name, arms.hand, turn, variable);
      const std::uint32_t pad = add_link("pad" + name, finger, {}, std::nullopt);
      add_shape(finger, {0.008, 0.02, 0.08}, {s.pad + 0.004, 0, kTip - 0.04});
      add_shape(pad, {s.pad, 0.02, 0.04}, {s.pad / 2, 0, kTip - 0.02});
      gripper.pads.push_back(pad);
    }
    robot.grippers = {gripper};
    robot.allowed = world::connected_links(robot);
    world::Object& block = arms.world.objects[TwoArms::kBlock];
    block.outer = {{{"", box_at({s.width, s.width, 0.16}, Vec3::Zero())}},
                   collide::Direction::Outer,
                   TwoArms::kEpsilon};
    block.grasps.resize(1);
    block.grasps[0].opening = {{"finger", s.width / 2 - 0.0005}};
    block.grasps[0].within = s.within;
    // The other arm and what is not needed are far away.
    arms.world.objects[TwoArms::kSocket].pose.translation = {0.5, -0.4, 0.021};
    arms.world.objects[TwoArms::kWall].outer = {{{"", box_at({0.004, 0.02, 0.16}, Vec3::Zero())}},
                                                collide::Direction::Outer,
                                                TwoArms::kEpsilon};
    if (s.post)
      arms.world.objects[TwoArms::kWall].pose.translation = block.pose.translation + *s.post;
  }

  /// As exact meshes.
  void build_cell() {
    cell = {};
    for (std::size_t r = 0; r < 2; ++r) {
      const world::RobotModel& model = arms.world.robots[r];
      cell.add_robot(model.name, model.kinematics, model.base);
      for (const auto& pair : model.allowed)
        cell.allow(model.name + "/" + model.kinematics.links[pair.a].name,
                   model.name + "/" + model.kinematics.links[pair.b].name);
    }
    for (std::size_t r = 0; r < 2; ++r)
      for (const world::LinkShape& link : arms.world.robots[r].shapes)
        cell.add_link(r, link.link, link.outer.body(0).core);
    for (const world::Object& o : arms.world.objects) cell.add_object(o.name, o.outer.body(0).core);
  }

  /// A suction cup in place of fingers, fixed to the hand. @param reaches  beyond the hand [m]
  void add_cup(double reaches) {
    world::RobotModel& robot = arms.world.robots[0];
    robot.kinematics.variables.pop_back();
    robot.home.pop_back();
    const std::uint32_t cup = add_link("cup", arms.hand, {}, std::nullopt);
    add_shape(cup, {0.02, 0.02, 0.004}, {0, 0, 0.155 + reaches - 0.002});
    robot.grippers = {{"cup", 0, {}, {cup}}};
    robot.allowed = world::connected_links(robot);
    arms.world.objects[TwoArms::kBlock].grasps[0].opening.clear();
  }

  /// Has the first pad slide along its finger, from this far aside while nothing is held. [m]
  void add_sweep(double aside) {
    world::RobotModel& robot = arms.world.robots[0];
    const auto variable = static_cast<std::uint32_t>(robot.kinematics.variables.size());
    robot.kinematics.variables.push_back({"sweep", -0.1, 0.1});
    robot.home.push_back(aside);
    robot::Joint& joint = robot.kinematics.joints[*robot.kinematics.find_link("pad0") - 1];
    joint.type = robot::JointType::Prismatic;
    joint.axis = Vec3::UnitY();
    joint.variable = variable;
    robot.grippers[0].joints.push_back(variable);
    robot.allowed = world::connected_links(robot);
    arms.world.objects[TwoArms::kBlock].grasps[0].opening.emplace_back("sweep", 0);
  }

  /// What a call answers with everything at first but for what `words` says.
  Answer ask_for(const std::string& function, const std::vector<std::string>& arguments,
                 Words words = {}) {
    words.merge(Words{{"conf(left)", "home"},
                      {"conf(right)", "home"},
                      {"pose(block)", "start"},
                      {"pose(socket)", "start"},
                      {"pose(wall)", "start"}});
    return ask(manipulation::bind_externals(arms.world, {}), function, arguments, words, 3);
  }

  Shape shape;
  TwoArms arms;
  judge::Cell cell;

 private:
  std::uint32_t add_link(const std::string& name, std::uint32_t parent, const Transform& origin,
                         std::optional<std::uint32_t> variable) {
    robot::Robot& chain = arms.world.robots[0].kinematics;
    robot::Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.origin = origin;
    joint.axis = Vec3::UnitX();
    if (variable) {
      joint.type = robot::JointType::Prismatic;
      joint.variable = *variable;
    }
    chain.joints.push_back(joint);
    chain.links.emplace_back();
    chain.links.back().name = name;
    return static_cast<std::uint32_t>(chain.links.size() - 1);
  }

  void add_shape(std::uint32_t link, const Vec3& size, const Vec3& center) {
    arms.world.robots[0].shapes.push_back(
        {link, {{{"", box_at(size, center)}}, collide::Direction::Outer, TwoArms::kEpsilon}, {}});
  }
};

/// Carries motions out: every sample is looked at, and only pads may touch what is held.
struct Execution {
  explicit Execution(Fingers& f) : fingers(f), state(f.arms.state()) {
    f.build_cell();
    for (std::size_t o = 0; o < state.objects.size(); ++o)
      state.objects[o].pose = f.arms.world.objects[o].pose;
  }

  void follow(const Answer& answer) {
    for (const nlohmann::json& part : nlohmann::json::parse(answer.payload)) {
      const auto path = part.at("path").get<robot::Path>();
      ASSERT_EQ(path.front(), state.q[0]);
      auto& place = state.objects[TwoArms::kBlock];
      const bool holds = part.contains("holds");
      if (holds && !place.hold) {
        ASSERT_EQ(part.value("closes", ""), "block") << "it is held from when fingers close on it";
        const Transform hand = fingers.cell.pose_of(state, 0, fingers.arms.hand);
        const Transform back{hand.linear.transpose(),
                             -(hand.linear.transpose() * hand.translation)};
        place.hold = judge::Hold{0, fingers.arms.hand, judge::product(back, place.pose),
                                 fingers.arms.world.robots[0].grippers[0].pads, false};
      } else if (!holds && place.hold) {
        ASSERT_TRUE(opened) << "it is let go when fingers have opened";
        place.pose = fingers.cell.pose_of(state, TwoArms::kBlock);
        place.hold.reset();
      }
      const bool moves_fingers = part.contains("closes") || part.contains("opens");
      for (const std::vector<double>& q : samples_of(path, moves_fingers ? 1e-4 : 0.01)) {
        for (std::size_t j = 0; j < q.size(); ++j) {
          const bool is_finger = j >= 6;
          if (is_finger != moves_fingers) {
            ASSERT_EQ(q[j], path.front()[j]) << "fingers or the arm, not both";
          }
        }
        state.q[0] = q;
        const auto meeting = fingers.cell.find_meeting(state, 0);
        ASSERT_FALSE(meeting) << meeting->names[0] << " and " << meeting->names[1];
        ++samples;
      }
      closed = closed || part.contains("closes");
      opened = part.contains("opens");
    }
  }

  Fingers& fingers;
  judge::CellState state;
  bool closed = false, opened = false;
  std::size_t samples = 0;
};

TEST(Fingers, CloseHoldAndOpen) {
  for (const int count : {2, 3, 4})
    for (const double width : {0.02, 0.035, 0.05})
      for (const double within : {0.0, 0.001, 0.003}) {
        // Corners of the block stand out between three fingers; four pads meet about a thin one.
        if ((count == 3 && within > 0.001) || (count == 4 && width < 0.03)) continue;
        SCOPED_TRACE(std::to_string(count) + " fingers, " + std::to_string(width));
        Fingers f({.fingers = count, .width = width, .pad = 0.012, .within = within});
        const Answer fetched = f.ask_for("fetch", {"left", "block", "home"});
        ASSERT_EQ(fetched.kind, Answer::Kind::Value) << fetched.reason;
        EXPECT_TRUE(fetched.value.ends_with(" by top")) << fetched.value;
        Execution run(f);
        run.follow(fetched);
        EXPECT_TRUE(run.closed);
        EXPECT_EQ(run.state.q[0].back(), width / 2 - 0.0005);
        const Answer put =
            f.ask_for("put", {"left", "block", "socket", "home"}, {{"pose(block)", fetched.value}});
        ASSERT_EQ(put.kind, Answer::Kind::Value) << put.reason;
        run.follow(put);
        EXPECT_EQ(run.state.q[0], f.arms.world.robots[0].home);
        EXPECT_FALSE(run.state.objects[TwoArms::kBlock].hold);
        EXPECT_GT(run.samples, 500U);
      }
}

/// In two steps, as domains have them: where a call says that the robot is, fingers are as what it
/// holds decides.
TEST(Fingers, GraspAndReleaseCloseAndOpen) {
  Fingers f({});
  const Answer reached = f.ask_for("reach", {"left", "block"});
  ASSERT_EQ(reached.kind, Answer::Kind::Value) << reached.reason;
  const Answer grasped = f.ask_for("grasp", {"left", "block", reached.value});
  ASSERT_EQ(grasped.kind, Answer::Kind::Value) << grasped.reason;
  Execution run(f);
  run.follow(reached);
  run.follow(grasped);
  EXPECT_TRUE(run.closed);
  const Answer released =
      f.ask_for("release", {"left", "block", reached.value},
                {{"pose(block)", grasped.value}, {"conf(left)", reached.value}});
  ASSERT_EQ(released.kind, Answer::Kind::Value) << released.reason;
  EXPECT_EQ(released.value, "start");
  run.follow(released);
  EXPECT_TRUE(run.opened);
  // Nothing else is taken meanwhile.
  const Answer again =
      f.ask_for("grasp", {"left", "block", reached.value}, {{"pose(block)", grasped.value}});
  EXPECT_EQ(again.kind, Answer::Kind::Impossible);
}

void expect_refused(const Fingers::Shape& shape, const std::string& a, const std::string& b) {
  Fingers f(shape);
  const Answer answer = f.ask_for("fetch", {"left", "block", "home"});
  ASSERT_NE(answer.kind, Answer::Kind::Value) << answer.payload;
  EXPECT_NE(answer.reason.find("does not close on block"), std::string::npos) << answer.reason;
  EXPECT_TRUE(answer.reason.find(a) != std::string::npos &&
              answer.reason.find(b) != std::string::npos)
      << answer.reason;
}

TEST(Fingers, WhatIsNoPadMustNotTouchTheThing) {
  // Pads so thin that the fingers behind them would touch.
  expect_refused({.pad = 0.0004}, "left/finger", "block");
}

TEST(Fingers, PadsMustNotTouchAnythingElse) {
  // Between the open pad and where it holds: it would close through the post.
  for (const double x : {0.030, 0.034}) expect_refused({.post = Vec3(x, 0, 0.06)}, "left/", "wall");
}

/// A finger with two joints: its pad comes inwards by one, along the block by the other. On the
/// straight way between both ends it passes a post, which it meets where the one is done first.
TEST(Fingers, AnyCombinationOfJointsIsFree) {
  for (const bool stands : {false, true}) {
    Fingers f({.post = Vec3(stands ? 0.029 : 0.2, -0.05, 0.07)});
    f.add_sweep(0.04);
    const Answer answer = f.ask_for("fetch", {"left", "block", "home"});
    if (!stands) {
      ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
      Execution run(f);
      run.follow(answer);
      continue;
    }
    EXPECT_NE(answer.kind, Answer::Kind::Value);
    EXPECT_NE(answer.reason.find("left/pad0 and wall"), std::string::npos) << answer.reason;
  }
}

TEST(Fingers, PadsMustNotTouchEachOther) {
  expect_refused({.fingers = 4, .width = 0.02}, "left/pad0", "left/pad");
}

/// A gripper without joints: what it is closed by is switched on, and its pad alone may touch.
TEST(Fingers, SuctionHasAPad) {
  for (const double reaches : {0.0015, 0.0025}) {  // from the hand; the block is 2 mm away
    Fingers f({.fingers = 0});
    f.add_cup(reaches);
    const Answer answer = f.ask_for("fetch", {"left", "block", "home"});
    // It comes without touching: contact is for what is held.
    ASSERT_EQ(answer.kind == Answer::Kind::Value, reaches < TwoArms::kGap) << answer.reason;
    if (answer.kind != Answer::Kind::Value) continue;
    EXPECT_TRUE(answer.value.ends_with(" by top"));
    EXPECT_EQ(answer.payload.find("closes"), std::string::npos);
    const world::Attachment held =
        *manipulation::place_of(answer.value, f.arms.world, TwoArms::kBlock).attachment;
    EXPECT_FALSE(held.link_touches);
    EXPECT_EQ(world::name_pads(f.arms.world, held), "left/cup");
    const Answer put =
        f.ask_for("put", {"left", "block", "socket", "home"}, {{"pose(block)", answer.value}});
    EXPECT_EQ(put.kind, Answer::Kind::Value) << put.reason;
  }
}

TEST(Fingers, RoomThatFingersStopInIsFreeAsWell) {
  // Beside the finger that has closed, between it and where it was: nearer than it may be off.
  const auto beside = [](double gap, double within) {
    const double outside = 0.025 - 0.0005 + 0.006 + 0.008;
    Fingers f({.open = 0.0275, .within = within, .post = Vec3(outside + 0.003 + gap, 0, 0.06)});
    return f.ask_for("fetch", {"left", "block", "home"}).kind == Answer::Kind::Value;
  };
  EXPECT_TRUE(beside(0.006, 0.001));
  EXPECT_FALSE(beside(0.006, 0.005));
}

/// Fingers whose opening is where they are while nothing is held: they close as any do.
TEST(Fingers, ThoseThatAreThereAlreadyCloseAsWell) {
  const auto fetched = [](double within) {
    const double open = 0.026, outside = open + 0.006 + 0.008;
    Fingers f({.open = open, .within = within, .post = Vec3(outside + 0.005, 0, 0.06)});
    f.arms.world.objects[TwoArms::kBlock].grasps[0].opening = {{"finger", open}};
    return f.ask_for("fetch", {"left", "block", "home"});
  };
  const Answer answer = fetched(0.0005);
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  std::size_t closing = 0;
  for (const nlohmann::json& part : nlohmann::json::parse(answer.payload))
    if (part.contains("closes")) {
      ++closing;
      const auto path = part.at("path").get<robot::Path>();
      EXPECT_EQ(path.size(), 2U);
      EXPECT_EQ(path.front(), path.back());
    }
  EXPECT_EQ(closing, 1U);
  // Where they may stop is free, too: the post is nearer than that.
  const Answer loose = fetched(0.005);
  EXPECT_NE(loose.kind, Answer::Kind::Value) << loose.payload;
}

/// What the scene has in the hand at first, and was put down since, is not in it any more.
TEST(Fingers, CloseOnWhatIsThereNow) {
  Fingers f({});
  world::World& world = f.arms.world;
  world::Grasp other = world.objects[TwoArms::kBlock].grasps[0];
  other.name = "other";
  other.opening = {{"finger", 0.032}};
  world.objects[TwoArms::kWall].grasps = {other};
  world.attachments[TwoArms::kWall] = world::hold_by(world, 0, f.arms.hand, {}, other);
  const Answer answer =
      f.ask_for("graspVolume", {"left", "block"}, {{"pose(wall)", "at 0.9 0.9 0.9 0 0 0 1"}});
  ASSERT_EQ(answer.kind, Answer::Kind::Value) << answer.reason;
  EXPECT_EQ(answer.value.find("wall"), std::string::npos) << answer.value;
  const auto motions = nlohmann::json::parse(answer.value.substr(answer.value.find('[')));
  EXPECT_EQ(motions.front().at("path").at(0).back(), 0.04) << "it comes open";
  EXPECT_EQ(motions.back().at("path").at(0).back(), 0.0245) << "it holds the block";
}

/// Pads that may touch the thing while they hold it may not once it is let go, nor before.
TEST(Fingers, PadsMustNotTouchWhatIsNotHeld) {
  Fingers closes({});
  const Answer reached = closes.ask_for("reach", {"left", "block"});
  ASSERT_EQ(reached.kind, Answer::Kind::Value) << reached.reason;
  const Answer grasped = closes.ask_for("grasp", {"left", "block", reached.value});
  ASSERT_EQ(grasped.kind, Answer::Kind::Value) << grasped.reason;
  // Of a gripper that "opens" inwards, into the block.
  Fingers inwards({.open = 0.022});
  const Answer released = inwards.ask_for("release", {"left", "block", reached.value},
                                          {{"pose(block)", grasped.value}});
  EXPECT_NE(released.kind, Answer::Kind::Value) << released.payload;
  EXPECT_NE(released.reason.find("when it has opened from block"), std::string::npos)
      << released.reason;
  EXPECT_NE(released.reason.find("left/pad"), std::string::npos) << released.reason;
  const Answer again = inwards.ask_for("grasp", {"left", "block", reached.value});
  EXPECT_NE(again.kind, Answer::Kind::Value) << again.payload;
  EXPECT_NE(again.reason.find("before it closes on block"), std::string::npos) << again.reason;
}

/// No set contains fingers that stop where they touch: volumes of such are apart from nothing.
TEST(Fingers, VolumesOfFingersThatHoldAreApartFromNothing) {
  Fingers f({});
  const Answer fetched = f.ask_for("fetch", {"left", "block", "home"});
  ASSERT_EQ(fetched.kind, Answer::Kind::Value) << fetched.reason;
  for (const bool holds : {false, true}) {
    Words words{{"pose(wall)", "at 5 5 5 0 0 0 1"}};
    if (holds) words["pose(block)"] = fetched.value;
    const Answer swept = f.ask_for("sweptVolume", {"left", "home"}, words);
    ASSERT_EQ(swept.kind, Answer::Kind::Value) << swept.reason;
    const Answer wall = f.ask_for("occupiedVolume", {"wall"}, words);
    const bool meets =
        f.ask_for("volumesCollide", {swept.value, wall.value}, words).kind == Answer::Kind::Value;
    EXPECT_EQ(meets, holds);
    EXPECT_EQ(f.ask_for("volumeCollides", {swept.value, "wall"}, words).kind == Answer::Kind::Value,
              holds);
  }
}

/// Inverse kinematics never moves fingers: what is fixed to one is put nowhere, and where the hand
/// is put they stay to the last bit.
TEST(Fingers, AreMovedByNoInverseKinematics) {
  const double open = 0.0400000001234;  // more digits than words have
  Fingers f({.open = open});
  const world::RobotModel& robot = f.arms.world.robots[0];
  const Answer reached = f.ask_for("reach", {"left", "block"});
  ASSERT_EQ(reached.kind, Answer::Kind::Value) << reached.reason;
  const robot::Path way =
      nlohmann::json::parse(reached.payload).back().at("path").get<robot::Path>();
  EXPECT_EQ(way.back().back(), open);
  for (const std::uint32_t link : {f.arms.hand, *robot.kinematics.find_link("finger0")}) {
    const bool is_hand = link == f.arms.hand;
    Transform target = robot.base * forward(robot.kinematics, way.back())[link];
    manipulation::Goals goals;
    manipulation::add_goals(goals, robot, link, target, robot.home, {});
    EXPECT_EQ(!goals.configurations.empty(), is_hand);
    if (!is_hand) {
      EXPECT_FALSE(goals.all);
    }
    for (const std::vector<double>& q : goals.configurations) EXPECT_EQ(q.back(), open);
    target.translation.z() += 0.01;
    const auto line = manipulation::follow_line(robot, link, way.back(), target, 0.01);
    ASSERT_EQ(line.has_value(), is_hand);
    if (line) {
      EXPECT_EQ(line->back().back(), open);
    }
  }
}

}  // namespace
}  // namespace kaboum::test
