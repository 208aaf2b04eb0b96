// Scene files: what is read, and what is refused with its place and a remedy.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/allowed_pairs.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/motion_check.h>

#include "refused.h"

namespace kaboum::world {
namespace {

using test::expect_refused;
using test::SceneFiles;

const std::string kBox = "\"objects\": [{\"name\": \"box\", \"outer\": ";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Scene, IsReadWithAllItsParts) {
  const SceneFiles files;
  const World world = files.world(files.scene(
      R"("objects": [{"name": "box", "pose": {"position": [1, 2, 3], "rpy": [0, 0, 1.5]}, "outer": )" +
          files.ref("box.glb") + R"(, "inner": )" + files.ref("inner.glb") +
          R"(, "features": [{"name": "top", "plane": {"point": [0, 0, 0.5], "normal": [0, 0, 2]}},
            {"name": "tip", "point": [1, 0, 0]}, {"name": "axis", "line": {"point": [0, 0, 0], "direction": [3, 4, 0]}}],
            "grasps": [{"name": "side", "position": [0.25, 0, 0]}]}],
      "regions": [{"name": "tray", "pose": {"quaternion": [0, 0, 0, 1]}, "inner": )" +
          files.ref("tray.glb") + R"(}],
      "allowed_contacts": [["arm/l3", "box"]],
      "attachments": [{"object": "box", "robot": "arm", "gripper": "hand", "grasp": "side"}])",
      R"("base": {"position": [0, 0, 0.5]}, "home": {"j2": 0.5}, "limits": {"j1": [-1, 1]},
      "tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}],
      "grippers": [{"name": "hand", "tool": "flange", "links": ["l2"]}], "allowed_contacts": [["l1", "l3"]])"));
  ASSERT_EQ(world.robots.size(), 1U);
  const RobotModel& arm = world.robots[0];
  EXPECT_EQ(arm.base.translation, Vec3(0, 0, 0.5));
  EXPECT_EQ(arm.home, (std::vector<double>{0, 0.5, 0}));
  EXPECT_EQ(arm.kinematics.variables[0].lower, -1);
  EXPECT_EQ(arm.kinematics.variables[1].lower, -3);
  EXPECT_EQ(arm.shapes.size(), 4U);
  EXPECT_EQ(arm.shapes[1].outer.epsilon(), 0.03);
  EXPECT_EQ(arm.allowed.size(), 4U);  // three that are adjacent
  EXPECT_EQ(arm.allowed.back().reason, AllowedPair::Reason::Stated);
  const Object& box = world.objects.at(0);
  EXPECT_EQ(box.pose.translation, Vec3(1, 2, 3));
  EXPECT_NEAR(box.pose.linear(1, 0), std::sin(1.5), 1e-15);
  EXPECT_TRUE(box.inner);
  EXPECT_EQ(box.features.at(0).direction, Vec3(0, 0, 1));
  EXPECT_EQ(box.features.at(2).kind, Feature::Kind::Line);
  EXPECT_NEAR(box.features.at(2).direction.x(), 0.6, 1e-15);
  EXPECT_EQ(world.regions.at(0).inner.size(), 2U);
  EXPECT_EQ(world.allowed.size(), 1U);
  ASSERT_TRUE(world.attachments.at(0));
  EXPECT_EQ(world.attachments[0]->link, *arm.kinematics.find_link("l3"));
  EXPECT_EQ(world.attachments[0]->pose.translation, Vec3(1.25, 0, 0));
  EXPECT_EQ(world.attachments[0]->touching.size(), 1U);
  EXPECT_EQ(world.name_of({0, 2}), "arm/l2");
}

TEST(Scene, ErrorsNameLineAndColumn) {
  const SceneFiles files;
  const std::string good = files.scene(kBox + files.ref("box.glb") + "}]");
  EXPECT_NO_THROW(files.world(good));
  expect_refused(files, replaced(good, "\"unit\": \"m\"", "\"unit\": 7"),
                 {"line 1, column 29", "a string is expected, not a number"});
  expect_refused(files, replaced(good, "\"objects\"", "\"object\""),
                 {"'object' is not known", "did you mean 'objects'", "column 3"});
  expect_refused(files, replaced(good, "\"unit\": \"m\"", "\"unit\": \"m\", \"unit\": \"m\""),
                 {"line 1, column 34", "'unit' is used twice"});
  expect_refused(files, replaced(good, "\"name\": \"box\"", "\"name\": \"arm\""),
                 {"the name 'arm' is used twice"});
  expect_refused(files, good.substr(0, good.size() / 2), {"the JSON is cut short", "line"});
  expect_refused(files, replaced(good, "\"link\": \"base\"", "\"link\": \"bas\""),
                 {"no link 'bas'", "did you mean"});
  expect_refused(files, replaced(good, "\"kaboum_scene\": 1", "\"kaboum_scene\": 2"),
                 {"line 1, column 18", "version 1"});
  expect_refused(files, replaced(good, "box.glb", "absent.glb"), {"absent.glb: cannot be read"});
  expect_refused(files, replaced(good, "\"name\": \"box\"", "\"nam\\\"e\": \"box\""), {"nam\"e"});
  expect_refused(files, "{}", {"line 1, column 1", "'kaboum_scene' is missing"});
  expect_refused(files, "[1]", {"an object is expected, not an array"});
  std::string deep(1000, '[');
  expect_refused(files, deep, {"more than 64"});
  // Each name is looked for among all others: with 300,000 members that must not take for ever.
  std::string many = R"({"kaboum_scene": 1)";
  for (int i = 0; i < 300'000; ++i) many += ",\"k" + std::to_string(i) + "\":1";
  expect_refused(files, many + "}", {"'k0' is not known"});
}

TEST(Scene, WhatIsStaleOrOfTheWrongKindIsRefused) {
  SceneFiles files;
  const auto with = [&](const std::string& file) {
    return files.scene(kBox + files.ref(file) + "}]");
  };
  const std::string good = with("box.glb");
  // The file changes after the scene was made.
  files.put("box.glb", test::set_of({test::box_mesh({-1, -1, -1}, {1, 1, 1})}, "outer", 0.01));
  expect_refused(files, good,
                 {"box.glb is not the file that this scene was made with", "kaboum-scene update"});
  expect_refused(files, with("inner.glb"), {"inner.glb is an inner set, but an outer one"});
  expect_refused(
      files,
      files.scene("\"regions\": [{\"name\": \"r\", \"inner\": " + files.ref("box.glb") + "}]"),
      {"box.glb is an outer set, but an inner one"});
  geom::ConvexSet inches = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01);
  inches.provenance.unit = "in";
  files.put("inches.glb", inches);
  expect_refused(files, with("inches.glb"), {"inches.glb is in in, the scene in m"});
  files.put("no-epsilon.glb", test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", -1));
  expect_refused(files, with("no-epsilon.glb"), {"states no epsilon"});
  files.put("unsaid.glb", test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "", 0.1));
  expect_refused(files, with("unsaid.glb"), {"not said to be an outer or an inner set"});
  expect_refused(files, with("arm.urdf"), {"no container"});
  // Sets of other links and robots.
  expect_refused(files, replaced(files.scene(), files.ref("l2.glb"), files.ref("l1.glb")),
                 {"in the frame of 'l1', not of link 'l2'"});
  geom::ConvexSet other = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01, "l2");
  other.provenance.source = "arm.urdf";
  other.provenance.source_sha256 = std::string(64, '0');
  files.put("l2.glb", other);
  expect_refused(files, files.scene(),
                 {"l2.glb was made from another file 'arm.urdf' than the robot"});
}

// The mesh of a set changes, or goes away, after the set was made from it.
TEST(Scene, SetsAreMadeFromWhatIsThere) {
  SceneFiles files;
  const auto put = [&](const std::string& name, const std::string& text) {
    files.files[name] = {text.begin(), text.end()};
  };
  put("cup.stl", "a cup");
  put("other.stl", "a pot");
  geom::ConvexSet cup = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01);
  cup.provenance.source = "cup.stl";
  cup.provenance.source_sha256 = files.hash("cup.stl");
  files.put("cup.glb", cup);
  const auto made_from = [&](const std::string& sources) {
    std::string ref = files.ref("cup.glb");
    ref.insert(ref.size() - 1, sources);
    return files.scene(kBox + ref + "}]");
  };
  const std::string good = made_from(R"(, "made_from": [)" + files.ref("cup.stl") + "]");
  SceneNotes notes;
  const auto read = [&](const std::string& f) { return files.read(f); };
  parse_scene(good, "scene.json", read, &notes);
  EXPECT_TRUE(notes.notes.empty());
  expect_refused(files, made_from(R"(, "made_from": [)" + files.ref("other.stl") + "]"),
                 {"cup.glb was made from another file 'cup.stl' than those in 'made_from'"});
  parse_scene(made_from(""), "scene.json", read, &notes);
  ASSERT_EQ(notes.notes.size(), 1U);
  EXPECT_NE(notes.notes[0].find("cup.glb does not say in 'made_from'"), std::string::npos);
  put("cup.stl", "a larger cup");
  expect_refused(files, good,
                 {"cup.stl has changed since cup.glb was made from it; kaboum-scene update"});
  files.files.erase("cup.stl");
  expect_refused(files, good,
                 {"cup.stl: cannot be read", "cup.glb was made from it: bring it back"});
}

// Robots' files may have any name.
TEST(Scene, SetsOfLinksAreOfTheRobotAsItIs) {
  SceneFiles files;
  files.files["arm.xml"] = files.files["arm.urdf"];
  geom::ConvexSet set = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01, "l2");
  set.provenance.source = "arm.xml";
  set.provenance.source_sha256 = files.hash("arm.xml");
  files.put("l2.glb", set);
  const auto scene = [&] {
    return replaced(files.scene(), files.ref("arm.urdf"), files.ref("arm.xml"));
  };
  EXPECT_NO_THROW(files.world(scene()));
  files.files["arm.xml"].push_back('\n');
  expect_refused(files, scene(), {"l2.glb was made from another file 'arm.xml' than the robot"});
}

TEST(Scene, SetsOfShapesForDrawingAreNoneForCollisions) {
  SceneFiles files;
  geom::ConvexSet set = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01, "l2");
  set.provenance.parameters = "--epsilon 1% --geometry visual";
  files.put("l2.glb", set);
  expect_refused(files, files.scene(),
                 {"l2.glb was made of the shapes for drawing", R"("shapes": "visual")"});
  // The links have no shapes for drawing; the sets that are given count.
  SceneNotes notes;
  const std::string visual = files.scene("", R"("shapes": "visual")");
  parse_scene(
      visual, "scene.json", [&](const std::string& f) { return files.read(f); }, &notes);
  ASSERT_EQ(notes.notes.size(), 1U);
  EXPECT_NE(notes.notes[0].find("'base', 'l1', 'l2', 'l3' have shapes for collisions only"),
            std::string::npos);
  set.provenance.parameters = "--epsilon 1%";
  files.put("l2.glb", set);
  expect_refused(files, files.scene("", R"("shapes": "visual")"), {"made of the shapes for coll"});
  expect_refused(files, files.scene("", R"("shapes": "both")"), {"'collision' or 'visual'"});
}

// Nothing is free of everything.
TEST(Scene, EmptySetsAreRefused) {
  SceneFiles files;
  files.put("none.glb", test::set_of({}, "outer", 0.01));
  expect_refused(files, files.scene(kBox + files.ref("none.glb") + "}]"), {"none.glb"});
}

TEST(Scene, PlacesAreWithinReason) {
  const SceneFiles files;
  const auto at = [&](const std::string& pose) {
    return files.scene(kBox + files.ref("box.glb") + R"(, "pose": {"position": )" + pose + "}}]");
  };
  EXPECT_NO_THROW(files.world(at("[1e6, 0, 0]")));
  expect_refused(files, at("[0, 1e300, 0]"), {"from -1e9 to 1e9"});
  // Limits that say nothing are no reason for errors.
  const World world = files.world(files.scene("", R"("limits": {"j1": [-1e300, 1e300]})"));
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  EXPECT_FALSE(checker.find_contact(state, scratch));
  state.q[0][0] = 1e300;
  EXPECT_THROW((void)checker.find_contact(state, scratch), Error);
}

TEST(Scene, NoLinkIsForgotten) {
  const SceneFiles files;
  const std::string less = replaced(
      files.scene(), ",\n      {\"link\": \"l3\", \"outer\": " + files.ref("l3.glb") + "}", "");
  expect_refused(files, less, {"link 'l3' has shapes for collisions, but no set"});
  const std::string said =
      replaced(less, "\"links\": [", "\"links_without_set\": [\"l3\"], \"links\": [");
  SceneNotes notes;
  parse_scene(
      said, "scene.json", [&](const std::string& f) { return files.read(f); }, &notes);
  ASSERT_EQ(notes.notes.size(), 1U);
  EXPECT_NE(notes.notes[0].find("'l3' has no set"), std::string::npos);
}

// A set that names no link may be of anything.
TEST(Scene, SetsOfLinksNameTheirLink) {
  const SceneFiles files;
  expect_refused(files, replaced(files.scene(), files.ref("l3.glb"), files.ref("box.glb")),
                 {"box.glb is in the frame of ''", "not of link 'l3'"});
}

TEST(Scene, UnitsAreThoseOfTheUrdf) {
  const SceneFiles files;
  expect_refused(files, replaced(files.scene(), R"("unit": "m")", R"("unit": "mm")"),
                 {"URDFs are in m"});
  expect_refused(files, replaced(files.scene(), R"("unit": "m")", R"("unit": "parsec")"),
                 {"'parsec' is no unit of length"});
}

TEST(Scene, SheetsThatAreNotCoveredAreSaid) {
  SceneFiles files;
  geom::ConvexSet set = test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0.01);
  set.provenance.covers_surface = false;
  files.put("sheet.glb", set);
  SceneNotes notes;
  parse_scene(
      files.scene(R"("objects": [{"name": "o", "outer": )" + files.ref("sheet.glb") + "}]"),
      "scene.json", [&](const std::string& f) { return files.read(f); }, &notes);
  ASSERT_EQ(notes.notes.size(), 1U);
  EXPECT_NE(notes.notes[0].find("sheet.glb covers the solid only"), std::string::npos);
}

TEST(Scene, ProofsHoldForWhatTheyWereMadeFor) {
  const SceneFiles files;
  const World world = files.world(files.scene());
  const auto proved = [&](const std::string& hash, const std::string& more = "") {
    return files.scene("", more + "\"never_in_contact\": {\"proved_for\": \"" + hash +
                               "\", \"pairs\": [[\"base\", \"l3\"]]}");
  };
  const RobotModel& robot = world.robots[0];
  const auto base = *robot.kinematics.find_link("base"), l3 = *robot.kinematics.find_link("l3");
  const std::string hash = proof_hash(robot, {{base, l3, AllowedPair::Reason::Never}});
  EXPECT_EQ(files.world(proved(hash)).robots[0].allowed.back().reason, AllowedPair::Reason::Never);
  expect_refused(files, proved(hash, "\"limits\": {\"j1\": [-1, 1]}, "),
                 {"were proved for other limits or other sets"});
  // Nor is a pair added by hand that was not proved.
  const std::string more =
      replaced(proved(hash), R"([["base", "l3"]])", R"([["base", "l3"], ["l1", "l3"]])");
  expect_refused(files, more, {"not the pairs that were proved"});
}

TEST(ExaminePairs, AdjacentNeverAndAlways) {
  const SceneFiles files;
  // j2 within ±1: the third link stays clear of the base (which the first link hangs on).
  const World narrow = files.world(
      files.scene("", "\"limits\": {\"j1\": [-3, 3], \"j2\": [-0.5, 0.5], \"j3\": [-0.5, 0.5]}"));
  const auto reason = [](const World& world, const std::string& a, const std::string& b) {
    const auto& robot = world.robots[0];
    for (const LinkPair& pair : examine_pairs(robot, {}))
      if (robot.kinematics.links[pair.a].name == a && robot.kinematics.links[pair.b].name == b)
        return pair;
    return LinkPair{};
  };
  EXPECT_EQ(reason(narrow, "base", "l1").reason, AllowedPair::Reason::Adjacent);
  EXPECT_EQ(reason(narrow, "base", "l3").reason, AllowedPair::Reason::Never);
  EXPECT_EQ(reason(narrow, "l1", "l3").reason, AllowedPair::Reason::Never);
  const World wide = files.world(files.scene());
  const LinkPair folded = reason(wide, "l1", "l3");
  EXPECT_FALSE(folded.reason);
  EXPECT_FALSE(reason(wide, "base", "l3").reason);
  std::vector<AllowedPair> pairs;
  for (const LinkPair& pair : examine_pairs(narrow.robots[0], {}))
    if (pair.reason) pairs.push_back({pair.a, pair.b, *pair.reason});
  const std::string srdf = to_srdf(narrow.robots[0], pairs);
  EXPECT_NE(srdf.find(R"(<disable_collisions link1="base" link2="l3" reason="Never"/>)"),
            std::string::npos);
  // Without the work there is no proof.
  for (const LinkPair& pair : examine_pairs(narrow.robots[0], {.most_boxes = 2})) {
    EXPECT_NE(pair.reason, AllowedPair::Reason::Never);
  }
}

// Contacts are looked for before anything is proved, however little work is allowed.
TEST(ExaminePairs, ContactsAreFoundBySamples) {
  const SceneFiles files;
  const RobotModel robot = files.world(files.scene()).robots[0];
  const auto of = [&](const std::string& a, const std::string& b, const PairOptions& options) {
    for (const LinkPair& pair : examine_pairs(robot, options))
      if (robot.kinematics.links[pair.a].name == a && robot.kinematics.links[pair.b].name == b)
        return pair;
    return LinkPair{};
  };
  EXPECT_TRUE(of("l1", "l3", {.most_boxes = 1}).meets);
  EXPECT_FALSE(of("l1", "l3", {.most_boxes = 1, .samples = 1}).meets);
  EXPECT_FALSE(of("l1", "l3", {.stop = [] { return true; }}).meets);
}

// What turns inside of another link always touches it: proved, and yet looked at.
TEST(ExaminePairs, AlwaysInContactThoughMoving) {
  RobotModel robot;
  robot.kinematics = robot::parse_urdf(R"(<robot name="r"><link name="a"/><link name="b"/>
    <link name="c"/><joint name="x" type="revolute"><parent link="a"/><child link="b"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
    <joint name="y" type="revolute"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>)",
                                       "r.urdf");
  const auto box = [](double size) {
    return BoundingSet(
        test::set_of({test::box_mesh({-size, -size, -1}, {size, size, 1})}, "outer", 0.01));
  };
  robot.shapes = {{0, box(1), {}}, {1, box(0.5), {}}, {2, box(0.5), {}}};
  for (const LinkPair& pair : examine_pairs(robot, {})) {
    if (pair.a != 0 || pair.b != 2) continue;
    EXPECT_TRUE(pair.meets_always);
    EXPECT_FALSE(pair.reason);
    return;
  }
  FAIL();
}

// A carriage on a rail and a wall beside it, both fixed to the cell: they may meet.
TEST(ExaminePairs, WhatIsFixedElsewhereIsNotAdjacent) {
  const robot::Robot cell = robot::parse_urdf(R"(<robot name="cell"><link name="cell"/>
    <link name="rail"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
    <link name="wall"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
    <link name="plate"/>
    <link name="carriage"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
    <joint name="a" type="fixed"><parent link="cell"/><child link="rail"/></joint>
    <joint name="b" type="fixed"><parent link="cell"/><child link="wall"/></joint>
    <joint name="c" type="continuous"><parent link="rail"/><child link="plate"/><axis xyz="0 0 1"/></joint>
    <joint name="d" type="fixed"><parent link="plate"/><child link="carriage"/></joint></robot>)",
                                              "cell.urdf");
  const auto has = [&](const char* a, const char* b) {
    const std::uint32_t x = *cell.find_link(a), y = *cell.find_link(b);
    for (const AllowedPair& pair : connected_links(cell))
      if (pair.a == std::min(x, y) && pair.b == std::max(x, y)) return true;
    return false;
  };
  EXPECT_TRUE(has("rail", "carriage"));  // by way of a plate without shapes
  EXPECT_TRUE(has("rail", "wall"));      // fixed joints only
  EXPECT_FALSE(has("wall", "carriage"));
}

// A link without shapes whose set the scene gives is something between two others.
TEST(ExaminePairs, LinksWithSetsAreNotLookedThrough) {
  RobotModel robot;
  robot.kinematics = robot::parse_urdf(R"(<robot name="r">
    <link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link><link name="b"/>
    <link name="c"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
    <joint name="x" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint>
    <joint name="y" type="fixed"><parent link="b"/><child link="c"/></joint></robot>)",
                                       "r.urdf");
  EXPECT_EQ(connected_links(robot).size(), 3U);
  robot.shapes.push_back(
      {1, BoundingSet(test::set_of({test::box_mesh({0, 0, 0}, {1, 1, 1})}, "outer", 0)), {}});
  EXPECT_EQ(connected_links(robot).size(), 2U);
}

// Never in contact is proved for values within the limits, and means nothing beyond them.
TEST(ExaminePairs, ProofsEndAtTheLimits) {
  const SceneFiles files;
  const std::string limits =
      "\"limits\": {\"j1\": [-3, 3], \"j2\": [-0.5, 0.5], \"j3\": [-0.5, 0.5]}";
  const RobotModel robot = files.world(files.scene("", limits)).robots[0];
  const auto link = [&](const char* name) { return *robot.kinematics.find_link(name); };
  const auto never = AllowedPair::Reason::Never;
  const std::string hash = proof_hash(robot, {{link("base"), link("l2"), never},
                                              {link("base"), link("l3"), never},
                                              {link("l1"), link("l3"), never}});
  const World world = files.world(
      files.scene("", limits + ", \"never_in_contact\": {\"proved_for\": \"" + hash +
                          R"(", "pairs": [["base", "l2"], ["base", "l3"], ["l1", "l3"]]})"));
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  state.q[0] = {0, 0.5, 0.5};
  EXPECT_FALSE(checker.find_contact(state, scratch));
  state.q[0] = {0, 2.2, 2.2};  // folded back onto the first link
  std::vector<std::string> touching;
  for (const Contact& contact : checker.find_contacts(state, scratch, {}))
    touching.push_back(world.name_of(contact.items[0]) + " " + world.name_of(contact.items[1]));
  EXPECT_EQ(touching, (std::vector<std::string>{"arm/base arm/l3", "arm/l1 arm/l3"}));
  const auto outcome = [&](const std::vector<double>& to) {
    return check_motion(checker, state, 0, {{0, 0, 0}, {0, 0.5, 0.5}, to}, {}).outcome;
  };
  EXPECT_EQ(outcome({0, -0.5, 0}), MotionAnswer::Outcome::Free);
  EXPECT_EQ(outcome({0, 2.2, 2.2}), MotionAnswer::Outcome::Contact);
}

/// A scene in YAML with these lines at its end.
std::string yaml_scene(const SceneFiles& files, const std::string& rest) {
  std::string out =
      "# A cell\nkaboum_scene: 1\nunit: m\nrobots:\n  - name: arm\n    urdf: {file: arm.urdf, "
      "sha256: " +
      files.hash("arm.urdf") +
      "}\n    base: {position: [0, 0, +0.5], rpy: [0, 0, 1.5e-1]}\n    links:\n";
  for (const std::string link : {"base", "l1", "l2", "l3"})
    out += "      - link: " + link + "\n        outer: {file: " + link +
           ".glb, sha256: " + files.hash(link + ".glb") + "}\n";
  return out + rest;
}

World parse_yaml(const SceneFiles& files, const std::string& text) {
  return parse_scene(text, "scene.yaml", [&](const std::string& file) { return files.read(file); });
}

TEST(YamlScene, SaysWhatTheSameJsonSays) {
  const SceneFiles files;
  const World world = parse_yaml(
      files, yaml_scene(files, "objects:\n  - name: no\n    outer: {file: box.glb, sha256: '" +
                                   files.hash("box.glb") + "'}\n"));
  EXPECT_EQ(world.robots.at(0).base.translation.z(), 0.5);
  EXPECT_EQ(world.robots.at(0).shapes.size(), 4U);
  EXPECT_EQ(world.objects.at(0).name, "no");
  // JSON is YAML.
  const std::string json =
      files.scene("\"objects\": [{\"name\": \"o\", \"outer\": " + files.ref("box.glb") + "}]");
  EXPECT_EQ(parse_yaml(files, json).objects.at(0).name, "o");
  const std::string back = scene_as_json(yaml_scene(files, ""), "scene.yaml");
  EXPECT_EQ(files.world(back).robots.at(0).base.linear, world.robots.at(0).base.linear);
  EXPECT_EQ(scene_as_json(json, "scene.json"), json);
  EXPECT_THROW(scene_as_json(std::string(100'000, '['), "scene.json"), Error);
}

TEST(YamlScene, MessagesNameLineAndColumn) {
  const SceneFiles files;
  const auto message = [&](const std::string& rest) -> std::string {
    try {
      parse_yaml(files, yaml_scene(files, rest));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
      return error.what();
    }
    return "no error";
  };
  const auto has = [&](const std::string& rest, const std::string& part) {
    EXPECT_NE(message(rest).find(part), std::string::npos) << rest << ": " << message(rest);
  };
  // Sixteen lines come before.
  has("object: []\n", "line 17, column 1");
  has("objects:\n  - name: o\n    pose: {position: [0, zero, 0]}\n", "line 19, column 26");
  has("objects:\n  - name: o\n    pose: {position: [0, 010, 0]}\n", "begins with 0");
  has("objects:\n  - name: o\n    pose: {position: [0, .inf, 0]}\n", "line 19");
  has("objects:\n  - name: o\n    pose: {position: [0, 1e999, 0]}\n", "line 19");
  has("objects:\n  - &x {name: o}\n", "anchors");
  has("objects:\n  - *x\n", "line 18");
  has("objects:\n  - !thing {name: o}\n", "tag");
  has("unit: mm\n", "'unit' is used twice");
  has("objects:\n  - name: \"\xff\"\n", "line 18, column 11: not UTF-8");
  has("objects: [\n", "not YAML");
  has("---\nunit: m\n", "second document");
  has("? [a]\n: 1\n", "name of a member");
  has("objects: " + std::string(100, '[') + std::string(100, ']') + "\n", "more than 64");
  EXPECT_THROW(parse_yaml(files, ""), Error);
  EXPECT_THROW(parse_yaml(files, "# nothing\n"), Error);
  EXPECT_THROW(parse_yaml(files, "- 1\n"), Error);
}

TEST(Scene, StatesHowFarWhatIsCarriedMayLean) {
  const SceneFiles files;
  const auto scene = [&](const std::string& upright) {
    return files.scene(R"("objects": [{"name": "box", "outer": )" + files.ref("box.glb") +
                       R"(, "upright": )" + upright + "}]");
  };
  EXPECT_EQ(files.world(scene("0.25")).objects.at(0).upright, 0.25);
  EXPECT_FALSE(files
                   .world(files.scene(R"("objects": [{"name": "box", "outer": )" +
                                      files.ref("box.glb") + "}]"))
                   .objects.at(0)
                   .upright);
  for (const char* wrong : {"0", "-1", "3.2", "\"yes\""})
    expect_refused(files, scene(wrong), {wrong[0] == '"' ? "number" : "an angle above 0"});
}

TEST(Scene, StatesConstraintsBetweenFeatures) {
  const SceneFiles files;
  const std::string objects =
      R"("objects": [{"name": "box", "pose": {"position": [1, 2, 3]}, "outer": )" +
      files.ref("box.glb") +
      R"(, "features": [{"name": "top", "plane": {"point": [0, 0, 0.5], "normal": [0, 0, 2]}},
          {"name": "twice", "point": [0, 0, 0]}, {"name": "twice", "line": {"point": [0, 0, 0], "direction": [1, 0, 0]}}]}])";
  const std::string tools = R"("tools": [{"name": "flange", "link": "l3", "position": [1, 0, 0]}])";
  const auto scene = [&](const std::string& constraints) {
    return files.scene(objects + ", \"constraints\": " + constraints, tools);
  };
  const std::string one =
      R"({"relation": "coincident", "first": "arm/flange.origin", "second": "box/top", "within": 0.25})";
  const World world = files.world(
      scene("[{\"name\": \"on-top\", \"all\": [" + one +
            R"(, {"relation": "angle", "first": "box.x", "second": "world.x", "value": 0.5}]}])"));
  const ConstraintSet& set = world.constraint_set("on-top");
  ASSERT_EQ(set.constraints.size(), 2U);
  const ToleratedConstraint& c = set.constraints[0];
  EXPECT_EQ(c.first.to, FixedFeature::To::Link);
  EXPECT_EQ(c.first.link, 3U);
  EXPECT_EQ(c.first.feature.point, Vec3(1, 0, 0));
  EXPECT_EQ(c.second.to, FixedFeature::To::Object);
  EXPECT_EQ(c.second.feature.kind, Feature::Kind::Plane);
  EXPECT_EQ(c.within, 0.25);
  EXPECT_EQ(set.constraints[1].value, 0.5);
  EXPECT_EQ(set.constraints[1].within_angle, 0.02);
  const auto refused = [&](const std::string& constraint, const std::vector<std::string>& words) {
    expect_refused(files, scene("[{\"name\": \"c\", \"all\": [" + constraint + "]}]"), words);
  };
  refused(replaced(one, "box/top", "box/tip"), {"did you mean 'box/top'?"});
  refused(replaced(one, "box/top", "box.zz"), {"no feature 'box.zz'"});
  refused(replaced(one, "box/top", "box/twice"), {"in two kinds"});
  refused(replaced(one, "coincident", "coincidence"), {"did you mean 'coincident'?"});
  refused(replaced(one, "coincident", "near"), {"one of coincident, parallel"});
  refused(replaced(one, "coincident", "parallel"), {"parallel of a point and a plane"});
  refused(replaced(one, "coincident", "distance"), {"'value' is missing"});
  refused(replaced(one, "\"within\": 0.25", "\"value\": 1"), {"'coincident' has no value"});
  refused(replaced(one, "\"within\": 0.25", "\"within_angle\": 1"), {"not about directions"});
  refused(replaced(one, "0.25", "0"), {"a tolerance above 0"});
  refused("", {"at least one constraint"});
  const std::string whole = "{\"name\": \"c\", \"all\": [" + one + "]}";
  expect_refused(files, scene("[" + whole + ", " + whole + "]"), {"'c' is used twice"});
  expect_refused(files, scene("[" + replaced(whole, "\"c\"", "\"c=1\"") + "]"), {"',' or '='"});
  expect_refused(files, scene("[" + replaced(whole, "\"c\"", "\"line\"") + "]"),
                 {"another name is needed"});
  EXPECT_THROW(static_cast<void>(world.constraint_set("on-to")), Error);
}

}  // namespace
}  // namespace kaboum::world
