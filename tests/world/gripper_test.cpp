// Grippers with joints and pads in scenes: what is read, what is refused, and which contacts are
// left out while pads hold something.

#include <kaboum/base/error.h>
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

/// While another robot moves, fingers that hold something may be off as well.
TEST(Gripper, RoomOfFingersThatRestCountsInMotionsOfOthers) {
  const SceneFiles files;
  // Another such arm above the finger; the box is not looked at.
  const auto is_free = [&](double within, double height) {
    World world = files.world(files.scene(box(files, "0.7", side()) + kHeld, kGripper));
    world.attachments[0]->fingers[0].within = within;
    RobotModel other = world.robots[0];
    other.name = "other";
    other.grippers.clear();
    other.base.translation.z() += height;
    world.robots.push_back(other);
    std::erase_if(world.robots[0].shapes, [](const LinkShape& shape) { return shape.link != 3; });
    const Checker checker(world);
    const robot::Path still{{0, 0, 0.5}, {0, 0, 0.5}};
    WorldState state = initial_state(world);
    state.absent = {true};
    const bool free =
        check_motion(checker, state, 1, still, {}).outcome == MotionAnswer::Outcome::Free;
    std::vector<Item> things;
    for (std::size_t s = 0; s < world.robots[0].shapes.size(); ++s) things.push_back({0, s});
    EXPECT_EQ(find_obstacles(checker, state, 1, still, things, {}).empty(), free);
    return free;
  };
  double low = 0, high = 4;
  ASSERT_FALSE(is_free(0, low));
  ASSERT_TRUE(is_free(0, high));
  for (int i = 0; i < 12; ++i) (is_free(0, (low + high) / 2) ? high : low) = (low + high) / 2;
  EXPECT_TRUE(is_free(0.0001, high + 0.01));
  EXPECT_FALSE(is_free(0.1, high + 0.01));
  EXPECT_TRUE(is_free(0.1, high + 1));
}

/// Paths that are given: fingers are within what the grasp allows, and all that it allows is free.
TEST(Gripper, RoomAlongAPathCoversAllThatTheGraspAllows) {
  const SceneFiles files;
  const World world = files.world(files.scene(box(files, "0.7", side()) + kHeld, kGripper));
  const auto room = [&](const robot::Path& path) {
    return finger_room_along(world, 0, world.attachments, path, "waypoint");
  };
  EXPECT_EQ(room({{0, 0, 0.5}, {1, 0, 0.5}}), (std::vector<double>{0, 0, 0.01}));
  const std::vector<double> wider = room({{0, 0, 0.5}, {0, 0, 0.494}});
  EXPECT_GE(wider.at(2), 0.01 + (0.5 - 0.494));
  EXPECT_LT(wider.at(2), 0.0161);
  EXPECT_EQ(holding_joints(0, world.attachments), (std::vector<std::uint32_t>{2}));
  try {
    room({{0, 0, 0.5}, {0, 0, 0.52}});
    ADD_FAILURE() << "fingers are elsewhere";
  } catch (const Error& error) {
    for (const char* part : {"waypoint 2", "'j3'", "'box'", "0.52", "0.01"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  // Nothing is held: fingers go where they like.
  EXPECT_TRUE(finger_room_along(world, 0, {std::nullopt}, {{{0, 0, 2}}}, "waypoint").empty());
}

TEST(Gripper, TheClaimNamesAllThatMayTouch) {
  const SceneFiles files;
  const std::string pads = "free but for the pad arm/l3 with what it holds";
  EXPECT_EQ(pads_claim(files.world(files.scene(box(files, "0.7", side()), kGripper))), pads);
  EXPECT_EQ(
      pads_claim(files.world(files.scene(
          box(files, "0.7", side()) + R"(, "allowed_contacts": [["box", "arm/l1"]])", kGripper))),
      pads + ", and contacts that the scene allows");
  std::string two = kGripper;
  two.replace(two.find(R"("link": "l2"})"), 13,
              R"("link": "l2"}, {"name": "elbow", "link": "l1"})");
  EXPECT_EQ(pads_claim(files.world(files.scene(box(files, "0.7", side()), two))),
            pads + ", the link arm/l1 with what it holds or pushes");
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
  // What inverse kinematics puts somewhere is above the fingers.
  const std::string one = R"("tools": [{"name": "flange", "link": "l2"})";
  std::string tip = kGripper;
  tip.replace(0, one.size(), one + R"(, {"name": "tip", "link": "l3"})");
  expect_refused(files, files.scene(box(files, "0.7", side()), tip),
                 {"'j3' of a gripper moves the link 'l3'", "a tool is on a link"});
  const auto feature = [&](const std::string& name) {
    return files.scene(
        box(files, "0.7", side()),
        kGripper + R"(, "features": [{"name": ")" + name +
            R"(", "link": "l3", "plane": {"point": [1, 0, 0], "normal": [1, 0, 0]}}])");
  };
  expect_refused(files, feature("push"), {"moves the link 'l3'", "a plane 'push…'"});
  EXPECT_NO_THROW(files.world(feature("front")));
  // Pads alone may touch what is held.
  for (const char* by : {R"("tool": "flange")", R"("link": "l2")", R"("link": "l3")"})
    expect_refused(
        files,
        files.scene(box(files, "0.7", side()) +
                        R"(, "attachments": [{"object": "box", "robot": "arm", )" + by + "}]",
                    kGripper),
        {"pads alone may touch", "by a 'gripper' and a 'grasp'"});
}

}  // namespace
}  // namespace kaboum::world
