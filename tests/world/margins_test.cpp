// Margins: what is free is at least so far apart, what is farther apart is free.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/margins.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <cmath>
#include <random>
#include <string>

#include "worlds.h"

namespace kaboum::world {
namespace {

World boxes(double between) {
  const auto box = [](const std::string& name, double x) {
    return R"({"name": ")" + name + R"(", "shape": {"box": {"size": [1, 1, 1]}}, "pose": )" +
           R"({"position": [)" + std::to_string(x) + ", 0, 0]}}";
  };
  return parse_scene(R"({"kaboum_scene": 1, "unit": "m", "objects": [)" + box("left", 0) + "," +
                         box("right", 1 + between) + R"(], "regions": []})",
                     "scene.json", [](const std::string&) { return std::vector<char>(); });
}

std::vector<Contact> contacts(const World& world) {
  const Checker checker(world);
  Scratch scratch;
  return checker.find_contacts(initial_state(world), scratch, {.resting = true});
}

Margins of(const World& world, const std::map<std::string, double>& margins) {
  MarginRequest request;
  for (const auto& [name, margin] : margins) request.margins[name] = Length{margin};
  return margins_of(world, request);
}

/// Lengths with a unit are brought into the scene's, whatever that is.
TEST(Margins, TakeUnits) {
  World world = boxes(0.5);
  const auto of_left = [&](const std::string& unit, const Length& margin) {
    world.unit = unit;
    return margins_of(world, {{{"left", margin}}}).of.at({Item::kObject, 0});
  };
  const auto length = [](const char* text) { return parse_distance(text).value(); };
  EXPECT_EQ(of_left("m", length("5mm")), 0.005);
  EXPECT_EQ(of_left("mm", length("5mm")), 5);
  EXPECT_EQ(of_left("mm", length("0.005")), 0.005);
  EXPECT_EQ(of_left("mm", length("0m")), 0);
  EXPECT_THROW(of_left("m", length("1%")), Error);
  EXPECT_THROW(of_left("m", Length{-1}), Error);
  EXPECT_THROW(of_left("m", Length{std::nan("")}), Error);
  EXPECT_EQ(words_of({{{"", length("5mm")}, {"left,right", length("0")}}}), "5mm; left,right=0");
}

class MarginsOfAnArm : public ::testing::Test {
 protected:
  /// An arm and a box beside its upper end when it is stretched along x.
  World world(const std::string& more = "") {
    return files_.world(files_.scene(R"("objects": [{"name": "box", "outer": )" +
                                     files_.ref("box.glb") +
                                     R"(, "pose": {"position": [2.5, 1.25, 0]}}])" + more));
  }

  test::SceneFiles files_;
};

/// Boxes without an epsilon: contact is decided by their distance alone.
TEST(Margins, AreCountedExactly) {
  World world = boxes(0.25);
  for (const double margin : {0.0, 0.1, 0.2499}) {
    world.margins.all = margin;
    EXPECT_TRUE(contacts(world).empty()) << margin;
  }
  for (const double margin : {0.25, 0.2501, 3.0}) {
    world.margins.all = margin;
    const auto found = contacts(world);
    ASSERT_EQ(found.size(), 1U) << margin;
    EXPECT_EQ(found[0].margin, margin);
    EXPECT_GE(found[0].epsilon, margin);
    EXPECT_FALSE(found[0].certain) << "the boxes do not meet";
  }
  world = boxes(-0.25);
  world.margins.all = 0.1;
  ASSERT_EQ(contacts(world).size(), 1U);
  EXPECT_TRUE(contacts(world)[0].certain);
}

TEST(Margins, OfAPairGoBeforeThoseOfThings) {
  World world = boxes(0.25);
  world.margins = of(world, {{"", 1}, {"left", 0.1}});
  EXPECT_TRUE(contacts(world).empty());
  world.margins = of(world, {{"left", 0.1}, {"right", 0.3}});
  EXPECT_EQ(contacts(world).size(), 1U) << "the larger one counts";
  world.margins = of(world, {{"", 1}, {"left", 1}, {"right,left", 0.2}});
  EXPECT_TRUE(contacts(world).empty());
  world.margins = of(world, {{"left,right", 0.3}});
  EXPECT_EQ(contacts(world).size(), 1U);
}

/// The more single things a pair names, the later it counts, in whatever order they are stated.
TEST_F(MarginsOfAnArm, OfLinksGoBeforeThoseOfRobots) {
  const World world = this->world();
  const WorldState state = initial_state(world);
  const Item tip{0, world.robots[0].shapes.size() - 1}, box{Item::kObject, 0};
  const std::string link = world.name_of(tip);
  const auto between = [&](const std::map<std::string, double>& margins) {
    World own = world;
    own.margins = of(own, margins);
    return margin_between(own, state, tip, box);
  };
  for (const std::string& pair : {link + ",box", "box," + link})
    for (const std::string& robot : {std::string("arm,box"), std::string("box,arm")}) {
      EXPECT_EQ(between({{pair, 0.3}, {robot, 0}}), 0.3);
      EXPECT_EQ(between({{pair, 0}, {robot, 0.3}, {"", 1}, {"arm", 2}, {"box", 3}}), 0);
    }
  EXPECT_THROW(between({{"arm,box", 1}, {"box,arm", 2}}), Error);
  EXPECT_THROW(between({{link + ",box", 1}, {"box," + link, 2}}), Error);
  EXPECT_EQ(between({{"arm,box", 1}, {"box,arm", 1}}), 1);
  EXPECT_EQ(between({{"arm", 0.5}, {link, 0.1}, {"", 9}}), 0.1);
  EXPECT_EQ(between({{"arm", 0.5}, {link, 0.1}, {"box", 0.2}}), 0.2);
  EXPECT_THROW(between({{"arm/l1,arm/l2", 1}}), Error) << "adjacent";
  EXPECT_THROW(between({{"box,box", 1}}), Error);
}

TEST_F(MarginsOfAnArm, GoWithWhatIsCarried) {
  World world =
      this->world(R"(, "attachments": [{"object": "box", "robot": "arm", "link": "l3"}])");
  const WorldState state = initial_state(world);
  Object other = world.objects[0];
  other.name = "person";
  world.objects.push_back(other);
  WorldState both = state;
  both.poses.push_back(other.pose);
  both.attachments.emplace_back();
  const Item box{Item::kObject, 0}, person{Item::kObject, 1};
  const auto between = [&](const std::map<std::string, double>& margins, const Item& a,
                           const Item& b) {
    world.margins = of(world, margins);
    return margin_between(world, both, a, b);
  };
  EXPECT_EQ(between({{"arm", 0.3}}, box, person), 0.3);
  EXPECT_EQ(between({{"arm", 0.3}, {"box", 0.1}}, box, person), 0.1);
  EXPECT_EQ(between({{"arm,person", 0.3}}, box, person), 0) << "a pair names what is carried";
  EXPECT_EQ(between({{"", 0.3}}, box, Item{0, 0}), 0) << "its own robot";
  EXPECT_EQ(between({{"", 0.3}}, box, person), 0.3);
}

TEST(Margins, AreNumbers) {
  World world = boxes(1);
  for (const double wrong :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    world.margins = {.all = wrong};
    EXPECT_THROW(Checker{world}, Error) << wrong;
    world.margins = {.of = {{Item{Item::kObject, 0}, wrong}}};
    if (!(wrong < 0)) {
      EXPECT_THROW(Checker{world}, Error) << wrong;
    }
  }
}

TEST(Margins, OfWhatIsNotThereAreRefused) {
  const World world = boxes(1);
  for (const char* name : {"lefd", "left,", ",left", "left,rihgt", "left,right,left"})
    EXPECT_THROW(of(world, {{name, 0.1}}), Error) << name;
  EXPECT_THROW(of(world, {{"", -1}}), Error);
  EXPECT_THROW(of(world, {{"", std::numeric_limits<double>::quiet_NaN()}}), Error);
  EXPECT_THROW(of(world, {{"", std::numeric_limits<double>::infinity()}}), Error);
}

/// Random states of an arm beside a box, against the certified distance of each pair.
TEST_F(MarginsOfAnArm, StatesAreFreeWhereEachPairIsFarEnoughApart) {
  World world = this->world();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> angle(-3, 3), length(0, 0.6);
  int free = 0, decided = 0;
  for (int i = 0; i < 400; ++i) {
    WorldState state = initial_state(world);
    for (double& q : state.q[0]) q = angle(random);
    world.margins = {};
    Scratch scratch;
    const Checker plain(world);
    const bool apart = plain.is_free(state, scratch);
    double nearest = std::numeric_limits<double>::infinity();
    const auto places = plain.places(state);
    for (const auto& a : places)
      for (const auto& b : places)
        if (a.item.robot == 0 && b.item.robot == Item::kObject)
          nearest = std::min(nearest, clearance(a.place, b.place)->lower);
    const double margin = length(random);
    world.margins.all = margin;
    const Checker checker(world);
    Scratch own;
    const bool kept = checker.is_free(state, own);
    if (kept) {
      EXPECT_TRUE(apart);
      EXPECT_GE(nearest, margin * (1 - 1e-9));
      ++free;
    } else if (apart) {
      EXPECT_LE(nearest, margin + 1e-6) << "a pair is within the margin";
      ++decided;
    }
    EXPECT_EQ(kept, !checker.find_contact(state, own).has_value());
  }
  EXPECT_GT(free, 40);
  EXPECT_GT(decided, 10);
}

TEST_F(MarginsOfAnArm, MotionsAreFreeAtEveryInstant) {
  World world = this->world();
  // It turns towards the box, and is nearest at the end.
  const robot::Path path{{-0.2, 0, 0}, {0, 0, 0}};
  Scratch scratch;
  WorldState end = initial_state(world);
  end.q[0] = path.back();
  const auto nearest = Checker(world).find_nearest(end, scratch, {});
  ASSERT_TRUE(nearest && nearest->items[1].robot == Item::kObject);
  const double between = nearest->clearance.lower;
  const auto outcome = [&](double margin) {
    world.margins.all = margin;
    return check_motion(Checker(world), initial_state(world), 0, path, {}).outcome;
  };
  using Outcome = MotionAnswer::Outcome;
  EXPECT_EQ(outcome(0), Outcome::Free);
  EXPECT_EQ(outcome(between - 1e-3), Outcome::Free);
  EXPECT_EQ(outcome(between + 1e-3), Outcome::Contact);
}

/// Neither links of one robot nor what it carries are kept apart, but where their pair says so.
TEST_F(MarginsOfAnArm, OneRobotIsNotKeptApartFromItself) {
  World world = this->world();
  world.objects[0].pose.translation = {0, 9, 0};
  const auto is_free = [&](const Margins& margins, std::vector<double> q) {
    world.margins = margins;
    WorldState state = initial_state(world);
    state.q[0] = std::move(q);
    Scratch scratch;
    return Checker(world).is_free(state, scratch);
  };
  const std::vector<double> folded{0, 2.5, 0};  // the third link comes near the first one
  ASSERT_TRUE(is_free({}, folded));
  EXPECT_TRUE(is_free(of(world, {{"", 5}}), folded));
  EXPECT_TRUE(is_free(of(world, {{"arm", 5}}), folded));
  EXPECT_FALSE(is_free(of(world, {{"", 9}}), folded)) << "the box";
  EXPECT_FALSE(is_free(of(world, {{"arm/l1,arm/l3", 5}}), folded));
}

}  // namespace
}  // namespace kaboum::world
