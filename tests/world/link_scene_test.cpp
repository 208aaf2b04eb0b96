// What scenes say of links besides outer sets: inner sets, features, and what a carried object may
// touch.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/world/checker.h>

#include <algorithm>

#include "worlds.h"

namespace kaboum::world {
namespace {

using test::SceneFiles;

const geom::Mesh kBar = test::box_mesh({0.0625, -0.03125, -0.03125}, {0.9375, 0.03125, 0.03125});

std::string message_of(const SceneFiles& files, const std::string& text) {
  try {
    (void)files.world(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "accepted";
}

void expect_message(const SceneFiles& files, const std::string& text, const std::string& words) {
  const std::string message = message_of(files, text);
  EXPECT_NE(message.find(words), std::string::npos) << message;
  EXPECT_TRUE(message.starts_with("scene.json: line ")) << message;
}

/// The scene with an inner set of the last link.
std::string with_inner(const SceneFiles& files, const std::string& ref,
                       const std::string& rest = "") {
  std::string text = files.scene(rest);
  const std::string outer = files.ref("l3.glb");
  return text.insert(text.find(outer) + outer.size(), ", \"inner\": " + ref);
}

geom::ConvexSet inner_bar(const std::string& frame) {
  return test::set_of({kBar}, "inner", 0.02, frame);
}

TEST(LinkInnerSets, MakeContactsCertain) {
  SceneFiles files;
  files.put("l3-inner.glb", inner_bar("l3"));
  const auto certain = [&](double x) {
    const World world = files.world(
        with_inner(files, files.ref("l3-inner.glb"),
                   "\"objects\": [{\"name\": \"o\", \"pose\": {\"position\": [" +
                       std::to_string(x) + ", 0, 0.1]}, \"outer\": " + files.ref("box.glb") +
                       ", \"inner\": " + files.ref("inner.glb") + "}]"));
    const Checker checker(world);
    Scratch scratch;
    const auto contacts = checker.find_contacts(initial_state(world), scratch, {});
    EXPECT_EQ(contacts.size(), 1U);
    return contacts.at(0).certain;
  };
  EXPECT_TRUE(certain(3.25));
  EXPECT_FALSE(certain(3.46875));  // between the inner tip at 2.9375 and the outer one at 3
}

TEST(LinkInnerSets, AreOfTheLinkAndTheRobotAsTheyAre) {
  SceneFiles files;
  files.put("other.glb", inner_bar("l2"));
  expect_message(files, with_inner(files, files.ref("other.glb")),
                 "other.glb is in the frame of 'l2', not of link 'l3'");
  expect_message(files, with_inner(files, files.ref("inner.glb")), "in the frame of ''");
  expect_message(files, with_inner(files, files.ref("l3.glb")),
                 "l3.glb is an outer set, but an inner one is needed here");
  geom::ConvexSet millimetres = inner_bar("l3");
  millimetres.provenance.unit = "mm";
  files.put("mm.glb", millimetres);
  expect_message(files, with_inner(files, files.ref("mm.glb")), "mm.glb is in mm, the scene in m");
  // A wrong unit or mesh that no record tells.
  geom::ConvexSet large = inner_bar("l3");
  for (Vec3& v : large.bodies[0].core.vertices) v *= 1000;
  files.put("large.glb", large);
  expect_message(files, with_inner(files, files.ref("large.glb")),
                 "large.glb reaches out of l3.glb");
  geom::ConvexSet of_another = inner_bar("l3");
  of_another.provenance.source = "arm.urdf";
  of_another.provenance.source_sha256 = std::string(64, '0');
  files.put("another.glb", of_another);
  expect_message(files, with_inner(files, files.ref("another.glb")),
                 "another.glb was made from another file 'arm.urdf' than the robot");
  geom::ConvexSet visual = inner_bar("l3");
  visual.provenance.parameters = "--epsilon 1% --geometry visual";
  files.put("visual.glb", visual);
  expect_message(files, with_inner(files, files.ref("visual.glb")), "shapes for drawing");
  // Stale.
  files.put("l3-inner.glb", inner_bar("l3"));
  const std::string good = with_inner(files, files.ref("l3-inner.glb"));
  EXPECT_EQ(message_of(files, good), "accepted");
  geom::ConvexSet changed = inner_bar("l3");
  changed.bodies[0].name = "changed";
  files.put("l3-inner.glb", changed);
  expect_message(files, good, "l3-inner.glb is not the file that this scene was made with");
}

TEST(LinkInnerSets, OfObjectsLieInTheOuterOnesToo) {
  SceneFiles files;
  files.put("wide.glb",
            test::set_of({test::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.75})}, "inner", 0.01));
  const auto scene = [&] {
    return files.scene("\"objects\": [{\"name\": \"o\", \"outer\": " + files.ref("box.glb") +
                       ", \"inner\": " + files.ref("wide.glb") + "}]");
  };
  expect_message(files, scene(), "wide.glb reaches out of box.glb");
  geom::ConvexSet with_margin =
      test::set_of({test::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})}, "outer", 0.5);
  set_margin(with_margin, 0.25);
  files.put("box.glb", with_margin);
  EXPECT_EQ(message_of(files, scene()), "accepted");
}

TEST(LinkFeatures, AreRead) {
  const SceneFiles files;
  const World world = files.world(files.scene("", R"("features": [
    {"name": "palm", "link": "l3", "plane": {"point": [1, 0, 0], "normal": [2, 0, 0]}},
    {"name": "edge", "link": "l3", "line": {"point": [1, 0, 0.05], "direction": [0, 3, 4]}},
    {"name": "palm", "link": "base", "point": [0, 0, 0.05]}])"));
  const auto& features = world.robots.at(0).features;
  ASSERT_EQ(features.size(), 3U);
  EXPECT_EQ(features[0].link, *world.robots[0].kinematics.find_link("l3"));
  EXPECT_EQ(features[0].feature.kind, Feature::Kind::Plane);
  EXPECT_EQ(features[0].feature.direction, Vec3(1, 0, 0));
  EXPECT_NEAR(features[1].feature.direction.z(), 0.8, 1e-15);
  EXPECT_EQ(features[2].feature.kind, Feature::Kind::Point);
  EXPECT_EQ(features[2].link, 0U);
}

TEST(LinkFeatures, ErrorsNameLineAndColumn) {
  const SceneFiles files;
  const auto refused = [&](const std::string& features, const std::string& words) {
    expect_message(files, files.scene("", "\"features\": " + features), words);
  };
  // The robot's own members follow on line 8.
  refused(R"([{"name": "a", "link": "l4", "point": [0, 0, 0]}])",
          "line 8, column 40: the robot has no link 'l4'");
  refused(R"([{"name": "a", "point": [0, 0, 0]}])", "line 8, column 18: 'link' is missing");
  refused(R"([{"name": "a", "link": "l3"}])", "line 8, column 18: a feature is one of");
  refused(R"([{"name": "a", "link": "l3", "point": [0, 0]}])", "line 8, column 55: 3 numbers");
  refused(R"([{"name": "a", "link": "l3", "line": {"point": [0, 0, 0], "direction": [0, 0, 0]}}])",
          "a direction of length 0");
  refused(R"([{"name": "a", "link": "l3", "plan": 1}])", "did you mean 'plane'");
  refused(R"([{"name": "a", "link": "l3", "point": [0, 0, 0]},
              {"name": "a", "link": "l2", "point": [0, 0, 1]}])",
          "line 9, column 24: the point 'a' is there twice");
}

TEST(AllowedContacts, OfWhatIsCarried) {
  const SceneFiles files;
  // The arm stretched along x holds o0 at its end, which overlaps o1 and, behind, link l2.
  const auto contacts = [&](const std::string& allowed,
                            const std::vector<std::uint32_t>& touching) {
    const World world = files.world(files.scene(
        "\"objects\": [{\"name\": \"o0\", \"outer\": " + files.ref("box.glb") +
        "}, {\"name\": \"o1\", \"pose\": {\"position\": [3.5, 0.75, 0.1]}, \"outer\": " +
        files.ref("box.glb") + "}], \"allowed_contacts\": [" + allowed + "]"));
    WorldState state = initial_state(world);
    Attachment held;
    held.link = *world.robots[0].kinematics.find_link("l3");
    held.pose.translation = {0.25, 0, 0};  // from x = 1.75 on: within l2
    held.touching = touching;
    state.attachments[0] = held;
    const Checker checker(world);
    Scratch scratch;
    std::vector<std::string> out;
    for (const Contact& c : checker.find_contacts(state, scratch, {}))
      out.push_back(world.name_of(c.items[0]) + " " + world.name_of(c.items[1]));
    std::sort(out.begin(), out.end());
    return out;
  };
  using Names = std::vector<std::string>;
  // o1 is out of the reach of o0, the arm's end is at its edge: only l2 is met.
  EXPECT_EQ(contacts("", {}), (Names{"arm/l2 o0"}));
  EXPECT_EQ(contacts(R"(["o0", "arm/l2"])", {}), Names{});
  EXPECT_EQ(contacts(R"(["arm", "o0"])", {}), Names{});
  EXPECT_EQ(contacts(R"(["arm/l1", "o0"])", {}), (Names{"arm/l2 o0"}));
  // What a gripper's links may touch is theirs alone.
  const SceneFiles other;
  const std::uint32_t l2 = *other.world(other.scene()).robots[0].kinematics.find_link("l2");
  EXPECT_EQ(contacts("", {l2}), Names{});
  EXPECT_EQ(contacts("", {l2 - 1}), (Names{"arm/l2 o0"}));
}

TEST(AllowedContacts, OfTwoObjectsHoldWhileOneIsCarried) {
  const SceneFiles files;
  const auto meet = [&](const std::string& allowed, bool held) {
    const World world = files.world(files.scene(
        "\"objects\": [{\"name\": \"o0\", \"pose\": {\"position\": [3.75, 0, 0.1]}, \"outer\": " +
        files.ref("box.glb") + "}, {\"name\": \"o1\", \"pose\": {\"position\": [4.25, 0, 0.1]}, " +
        "\"outer\": " + files.ref("box.glb") + "}], \"allowed_contacts\": [" + allowed + "]"));
    WorldState state = initial_state(world);
    if (held) {
      Attachment with;
      with.link = *world.robots[0].kinematics.find_link("l3");
      with.pose.translation = {1.75, 0, 0};
      state.attachments[0] = with;
    }
    const Checker checker(world);
    Scratch scratch;
    return checker.find_contact(state, scratch, {.resting = true}).has_value();
  };
  for (const bool held : {false, true}) {
    EXPECT_TRUE(meet("", held));
    EXPECT_FALSE(meet(R"(["o0", "o1"])", held));
    EXPECT_FALSE(meet(R"(["o1", "o0"])", held));
    EXPECT_TRUE(meet(R"(["arm", "o0"])", held));
  }
}

// What one robot holds and may touch is no matter of another robot's links of the same numbers.
TEST(AllowedContacts, OfWhatIsCarriedAreThatRobots) {
  const SceneFiles files;
  std::string text =
      files.scene("\"objects\": [{\"name\": \"o\", \"outer\": " + files.ref("box.glb") + "}]");
  const auto start = text.find("[{\"name\": \"arm\"") + 1;
  const auto end = text.find("],\n  \"objects\"", start);
  ASSERT_NE(end, std::string::npos);
  std::string second = text.substr(start, end - start);
  second.replace(second.find("\"arm\""), 5, "\"other\"");
  second.insert(second.size() - 1, ", \"base\": {\"position\": [0, 3, 0]}");
  text.insert(end, ", " + second);
  const World world = files.world(text);
  WorldState state = initial_state(world);
  Attachment held;
  held.link = *world.robots[0].kinematics.find_link("l3");
  held.pose.translation = {0.5, 2.75, 0};  // over the other arm's last link, and near nothing else
  held.touching = {0, 1, 2, 3};
  state.attachments[0] = held;
  const Checker checker(world);
  Scratch scratch;
  std::vector<std::string> found;
  for (const Contact& c : checker.find_contacts(state, scratch, {}))
    found.push_back(world.name_of(c.items[0]) + " " + world.name_of(c.items[1]));
  EXPECT_EQ(found, (std::vector<std::string>{"other/l2 o", "other/l3 o"}));
}

}  // namespace
}  // namespace kaboum::world
