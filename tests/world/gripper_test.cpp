// Grippers with joints and pads in scenes: what is read, what is refused, and which contacts are
// left out while pads hold something.

#include <kaboum/world/checker.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/motion_check.h>

#include <algorithm>

#include "refused.h"

namespace kaboum::world {
namespace {

using test::expect_refused;
using test::SceneFiles;

/// The last link is a finger, and its pad; the hand is the one before.
const std::string kTool = R"("tools": [{"name": "flange", "link": "l2"}], )";
const std::string kGripper =
    kTool +
    R"("grippers": [{"name": "hand", "tool": "flange", "pads": ["l3"], "joints": ["j3"], "force": 20}])";

std::string box(const SceneFiles& files, const std::string& y, const std::string& grasp) {
  return R"("objects": [{"name": "box", "pose": {"position": [2.5, )" + y +
         R"(, 0.1]}, "outer": )" + files.ref("box.glb") + R"(, "grasps": [)" + grasp + "]}]";
}

std::string side(const std::string& y = "0.7",
                 const std::string& how = R"("opening": {"j3": 0.5}, "within": 0.01)") {
  return R"({"name": "side", "position": [1.5, )" + y + ", 0], " + how + "}";
}

const std::string kHeld =
    R"(, "attachments": [{"object": "box", "robot": "arm", "gripper": "hand", "grasp": "side"}])";

bool meets(const std::vector<Contact>& contacts, const World& world, const std::string& a,
           const std::string& b) {
  return std::ranges::any_of(contacts, [&](const Contact& c) {
    const std::string x = world.name_of(c.items[0]), y = world.name_of(c.items[1]);
    return (x == a && y == b) || (x == b && y == a);
  });
}

TEST(Gripper, HoldsByItsPadsAndOpensAsTheGraspSays) {
  const SceneFiles files;
  const World world = files.world(files.scene(box(files, "0.7", side()) + kHeld, kGripper));
  const Gripper& hand = world.robots[0].grippers.at(0);
  EXPECT_EQ(hand.pads, (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(hand.joints, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(hand.force, 20);
  ASSERT_TRUE(world.attachments.at(0));
  const Attachment& held = *world.attachments[0];
  EXPECT_FALSE(held.link_touches);
  EXPECT_EQ(held.touching, hand.pads);
  EXPECT_EQ(held.grasp, "side");
  EXPECT_EQ(name_pads(world, held), "arm/l3");
  WorldState state = initial_state(world);
  EXPECT_EQ(state.q[0], (std::vector<double>{0, 0, 0.5}));
  EXPECT_EQ(finger_room(world, 0, state.attachments), (std::vector<double>{0, 0, 0.01}));
  // Let go, it is open, and the pad counts like anything else.
  state.attachments[0].reset();
  set_grippers(world, state);
  EXPECT_EQ(state.q[0], (std::vector<double>{0, 0, 0}));
}

TEST(Gripper, OnlyItsPadsMayTouchWhatItHolds) {
  const SceneFiles files;
  Scratch scratch;
  const auto contacts = [&](const World& world, const WorldState& state) {
    return Checker(world).find_contacts(state, scratch, {});
  };
  {
    const World world = files.world(files.scene(box(files, "0.7", side()) + kHeld, kGripper));
    WorldState state = initial_state(world);
    EXPECT_TRUE(contacts(world, state).empty()) << "the pad touches, and may";
    state.attachments[0]->touching.clear();
    EXPECT_TRUE(meets(contacts(world, state), world, "arm/l3", "box"));
    state = initial_state(world);
    const Transform held = state.attachments[0]->pose;
    state.attachments[0].reset();
    state.poses[0] = world.objects[0].pose;
    EXPECT_TRUE(meets(contacts(world, state), world, "arm/l3", "box")) << "nothing is held";
    // What is mounted on it is not held.
    const Attachment along = carried_along(*world.attachments[0], {});
    EXPECT_FALSE(along.link_touches);
    EXPECT_TRUE(along.touching.empty() && along.fingers.empty() && along.grasp.empty());
    EXPECT_EQ(along.pose.translation, held.translation);
  }
  {
    // Nearer: the hand touches it too.
    const World world = files.world(files.scene(box(files, "0.5", side("0.5")) + kHeld, kGripper));
    EXPECT_TRUE(meets(contacts(world, initial_state(world)), world, "arm/l2", "box"));
  }
  {
    // A pad that touches another thing.
    const std::string two = box(files, "0.7", side());
    const World world = files.world(files.scene(
        two.substr(0, two.size() - 1) +
            R"(, {"name": "other", "pose": {"position": [2.6, -0.42, 0.1]}, "outer": )" +
            files.ref("box.glb") + "}]" + kHeld,
        kGripper));
    WorldState state = initial_state(world);
    const auto now = contacts(world, state);
    EXPECT_TRUE(meets(now, world, "arm/l3", "other"));
    EXPECT_FALSE(meets(now, world, "arm/l3", "box"));
  }
}

/// Fingers stop where they touch: what is decided of a motion is so wherever they are within that.
TEST(Gripper, RoomOfFingersCountsInMotions) {
  const SceneFiles files;
  const World world = files.world(files.scene(box(files, "0.7", side()) + kHeld, kGripper));
  const Checker checker(world);
  const WorldState state = initial_state(world);
  WorldState beside = state;
  beside.attachments[0].reset();
  beside.poses[0].translation = {2.5, 0.5 + 0.0625 + 0.02, 0.1};  // along the straight finger
  const robot::Path still{{0, 0, 0}, {0, 0, 0}};
  MotionOptions options;
  EXPECT_EQ(check_motion(checker, beside, 0, still, options).outcome, MotionAnswer::Outcome::Free);
  options.around = {0, 0, 0.01};
  EXPECT_EQ(check_motion(checker, beside, 0, still, options).outcome, MotionAnswer::Outcome::Free);
  const std::vector<Item> things{{Item::kObject, 0}};
  EXPECT_TRUE(find_obstacles(checker, beside, 0, still, things, options).empty());
  options.around = {0, 0, 0.05};
  EXPECT_EQ(check_motion(checker, beside, 0, still, options).outcome,
            MotionAnswer::Outcome::Contact);
  EXPECT_EQ(find_obstacles(checker, beside, 0, still, things, options), things);
}

TEST(Gripper, MistakesAreNamed) {
  const SceneFiles files;
  const auto gripper = [&](const std::string& members) {
    return files.scene(
        box(files, "0.7", side()),
        kTool + R"("grippers": [{"name": "hand", "tool": "flange")" + members + "}]");
  };
  expect_refused(files, gripper(R"(, "links": ["l3"], "joints": ["j3"])"), {"states its 'pads'"});
  expect_refused(files, gripper(R"(, "links": ["l3"], "pads": ["l3"])"), {"'links' or 'pads'"});
  expect_refused(files, gripper(R"(, "pads": [], "joints": ["j3"])"), {"at least one pad"});
  expect_refused(files, gripper(R"(, "pads": ["l3", "l3"], "joints": ["j3"])"), {"there twice"});
  expect_refused(files, gripper(R"(, "pads": ["l3"])"), {"'j3' moves the pad 'l3'", "'joints'"});
  expect_refused(files, gripper(R"(, "pads": ["base"], "joints": ["j3"])"), {"does not hang"});
  expect_refused(files, gripper(R"(, "pads": ["l3"], "joints": ["j3", "j1"])"),
                 {"'j1' moves the tool itself"});
  expect_refused(files,
                 files.scene(box(files, "0.7", side()),
                             R"("tools": [{"name": "flange", "link": "base"}], "grippers": [{"name":
                             "hand", "tool": "flange", "pads": ["l1"], "joints": ["j1", "j3"]}])"),
                 {"moves no pad against the tool"});
  expect_refused(files, gripper(R"(, "pads": ["l3"], "joints": ["j3"], "force": 0)"),
                 {"a force above 0"});
  const auto grasp = [&](const std::string& how) {
    return files.scene(box(files, "0.7", side("0.7", how)), kGripper);
  };
  expect_refused(files, grasp(R"("rank": 1)"), {"'side' states no 'opening' of the joint 'j3'"});
  expect_refused(files, grasp(R"("opening": {"j3": 4})"), {"beyond its limits"});
  expect_refused(files, grasp(R"("opening": {"j3": 0.5, "j4": 1})"), {"has the joint 'j4'"});
  expect_refused(files, grasp(R"("opening": {"j3": 0.5}, "within": -1)"), {"from 0 to 0.1"});
  expect_refused(files, grasp(R"("within": 0.01)"), {"'opening', which is not stated"});
  expect_refused(files, grasp(R"("opening": {"j3": 0.5}, "pads": ["l4"])"), {"names the pad 'l4'"});
  expect_refused(files, files.scene(box(files, "0.7", side() + ", " + side()), kGripper),
                 {"'side' is used twice"});
  expect_refused(files, files.scene(box(files, "0.7", side("0.7", R"("pads": ["l3"])"))),
                 {"no gripper with pads may use this grasp"});
  expect_refused(
      files,
      files.scene(box(files, "0.7", side()) +
                      R"(, "attachments": [{"object": "box", "robot": "arm", "gripper": "hand"}])",
                  kGripper),
      {"held by a 'grasp'"});
}

}  // namespace
}  // namespace kaboum::world
