// States of a world against all pairs in rational numbers.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/checker.h>

#include <map>
#include <random>
#include <set>
#include <thread>

#include "support/rational_contact.h"
#include "worlds.h"

namespace kaboum::world {
namespace {

using test::SceneFiles;

std::string objects(const SceneFiles& files, const std::vector<std::string>& positions,
                    const std::string& inner = "") {
  std::string out = "\"objects\": [";
  for (std::size_t i = 0; i < positions.size(); ++i)
    out += std::string(i == 0 ? "" : ",").append("{\"name\": \"o").append(std::to_string(i)) +
           "\", \"pose\": {\"position\": " + positions[i] +
           "}, \"outer\": " + files.ref("box.glb") + inner + "}";
  return out + "]";
}

std::vector<double> random_values(std::mt19937_64& random, std::size_t n) {
  std::uniform_real_distribution<double> turn(-3, 3);
  std::vector<double> q(n);
  for (double& x : q) x = turn(random);
  return q;
}

TEST(Checker, FindsTheContactsThatAllPairsInRationalNumbersFind) {
  const SceneFiles files;
  const World world =
      files.world(files.scene(objects(files, {"[2, 1, 0]", "[-1.5, 0.5, 0.3]", "[0.5, -2.2, 0]"}),
                              "\"allowed_contacts\": [[\"base\", \"l2\"], [\"base\", \"l3\"]]"));
  const Checker checker(world);
  Scratch scratch;
  std::mt19937_64 random(1);
  int contacts = 0, states = 0;
  for (int i = 0; i < 120; ++i) {
    WorldState state = initial_state(world);
    state.q[0] = random_values(random, 3);
    const auto poses = robot::forward(world.robots[0].kinematics, state.q[0]);
    std::set<std::string> expected;
    const auto meet = [&](const BoundingSet& a, const Transform& at_a, const BoundingSet& b,
                          const Transform& at_b) {
      for (std::size_t x = 0; x < a.size(); ++x)
        for (std::size_t y = 0; y < b.size(); ++y)
          if (test::rational_within(a.body(x).core, at_a, b.body(y).core, at_b, 0)) return true;
      return false;
    };
    const auto& shapes = world.robots[0].shapes;
    for (std::size_t s = 0; s < shapes.size(); ++s)
      for (const Object& object : world.objects)
        if (meet(shapes[s].outer, poses[shapes[s].link], object.outer, object.pose))
          expected.insert(world.name_of({0, s}) + " " + object.name);
    if (meet(shapes[1].outer, poses[1], shapes[3].outer, poses[3]))
      expected.insert("arm/l1 arm/l3");
    std::set<std::string> found;
    for (const Contact& c : checker.find_contacts(state, scratch, {}))
      found.insert(world.name_of(c.items[0]) + " " + world.name_of(c.items[1]));
    EXPECT_EQ(found, expected) << i;
    EXPECT_EQ(checker.find_contact(state, scratch).has_value(), !expected.empty());
    const auto nearest = checker.find_nearest(state, scratch, {});
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->clearance.lower <= 0, !expected.empty());
    double deepest = 0;
    for (Contact& c : checker.find_contacts(state, scratch, {})) {
      checker.measure_depth(c, state, scratch);
      ASSERT_TRUE(c.depth);
      EXPECT_LE(c.depth->lower, c.depth->upper);
      deepest = std::max(deepest, c.depth->lower);
    }
    if (deepest > 0) {
      EXPECT_EQ(nearest->clearance.upper, -deepest) << i;
    }
    contacts += expected.empty() ? 0 : 1;
    ++states;
  }
  EXPECT_GT(contacts, 20);
  EXPECT_LT(contacts, states - 20);
}

/// The pairs in contact by the places of all items, without what leaves out pairs beforehand.
std::set<std::string> contacts_of_all_pairs(const Checker& checker, const WorldState& state) {
  std::map<Item, collide::PosedSet> at;
  for (const Checker::PosedItem& placed : checker.places(state))
    at.emplace(placed.item, placed.place);
  std::set<std::string> out;
  for (const auto& [a, b] : checker.pairs(state, {}))
    if (find_collision(at.at(a), at.at(b)))
      out.insert(checker.world().name_of(a) + " " + checker.world().name_of(b));
  return out;
}

TEST(Checker, BallsAndBoxesLeaveOutNoContact) {
  const SceneFiles files;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> from(-1, 1);
  std::size_t contacts = 0, free = 0, looks = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<std::string> positions(1 + random() % 9, "[0, 0, 0]");
    World world = files.world(
        files.scene(objects(files, positions), "\"base\": {\"position\": [0, 0, 0.5]}"));
    const double far = trial % 3 == 0 ? 0 : trial % 3 == 1 ? 10 : 1e5;
    const Vec3 center = far * Vec3(from(random), from(random), from(random));
    const auto turn = [&] {
      return robot::rotation_about(Vec3(from(random), from(random), from(random)).normalized(),
                                   3 * from(random));
    };
    world.robots[0].base = {turn(), center};
    for (Object& o : world.objects)
      o.pose = {turn(), center + 3.5 * Vec3(from(random), from(random), from(random))};
    world.robots[0].kinematics.joints[1].multiplier = 0.5;  // as of a mimic joint
    world.robots[0].kinematics.joints[1].offset = 0.25;
    if (trial % 4 == 0) world.robots[0].kinematics.joints[2].type = robot::JointType::Prismatic;
    const Checker checker(world);
    Scratch scratch;
    for (int i = 0; i < 40; ++i) {
      WorldState state = initial_state(world);
      state.q[0] = random_values(random, 3);
      if (i % 10 == 9) state.q[0][0] += 500;  // beyond what errors are bounded for beforehand
      if (i % 5 == 4) {
        state.attachments[0] = Attachment{};
        state.attachments[0]->link = 3;
        state.attachments[0]->pose = {turn(), {1.2, 0, 0}};
      }
      std::set<std::string> found;
      for (const Contact& c : checker.find_contacts(state, scratch, {}))
        found.insert(world.name_of(c.items[0]) + " " + world.name_of(c.items[1]));
      EXPECT_EQ(found, contacts_of_all_pairs(checker, state)) << trial << ' ' << i;
      EXPECT_EQ(checker.is_free(state, scratch), found.empty());
      EXPECT_EQ(checker.find_contact(state, scratch).has_value(), !found.empty());
      contacts += found.size();
      free += found.empty() ? 1 : 0;
      ++looks;
    }
  }
  EXPECT_GT(contacts, looks / 5);
  EXPECT_GT(free, looks / 10);
}

TEST(Checker, PlacesAreThoseOfKinematicsFarFromTheOriginAndFixedBesides) {
  const SceneFiles files;
  World world = files.world(files.scene());
  RobotModel& arm = world.robots[0];
  arm.base = {robot::rotation_about(Vec3(1, 2, 3).normalized(), 1), {30, -40, 50}};
  arm.kinematics.joints[1].axis = Vec3(0.6, 0, 0.8);
  arm.kinematics.joints[2].type = robot::JointType::Fixed;
  arm.kinematics.joints[2].origin.linear = robot::rotation_from_rpy(0.1, 0.2, 0.3);
  const Checker checker(world);
  std::mt19937_64 random(4);
  for (int i = 0; i < 50; ++i) {
    WorldState state = initial_state(world);
    state.q[0] = random_values(random, 3);
    const auto links = robot::forward(arm.kinematics, state.q[0]);
    for (const Checker::PosedItem& placed : checker.places(state)) {
      const std::uint32_t link = arm.shapes[placed.item.index].link;
      const Transform expected = arm.base * links[link];
      for (const Vec3& p : checker.hull_of(placed.item))
        EXPECT_LT((placed.place.pose() * p - expected * p).norm(), placed.place.error());
      EXPECT_LT(placed.place.error(), 1e-10);
    }
  }
}

TEST(Checker, SaysWhatIsCertain) {
  const SceneFiles files;
  const auto contact = [&](const std::string& inner) {
    const World world =
        files.world(files.scene(objects(files, {"[3, 5, 0]", "[3.25, 5, 0]"}, inner)));
    const Checker checker(world);
    Scratch scratch;
    EXPECT_FALSE(checker.find_contact(initial_state(world), scratch));
    return checker.find_contact(initial_state(world), scratch, {.resting = true});
  };
  const auto outer = contact("");
  ASSERT_TRUE(outer);
  EXPECT_FALSE(outer->certain);
  EXPECT_NEAR(outer->epsilon, 0.02, 1e-12);
  const auto inner = contact(", \"inner\": " + files.ref("inner.glb"));
  ASSERT_TRUE(inner);
  EXPECT_TRUE(inner->certain);
}

TEST(Checker, CarriedObjectsMoveWithTheRobot) {
  const SceneFiles files;
  const std::string robot =
      "\"tools\": [{\"name\": \"flange\", \"link\": \"l3\", \"position\": [1.5, 0, 0]}]";
  const World world = files.world(files.scene(objects(files, {"[9, 9, 9]", "[0, 3.5, 0]"}), robot));
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  state.q[0] = {std::numbers::pi / 2, 0, 0};  // to [0, 3, 0.1]: touches the box that begins there
  EXPECT_TRUE(checker.find_contact(state, scratch));
  state.q[0] = {std::numbers::pi / 2 - 0.25, 0, 0};
  EXPECT_FALSE(checker.find_contact(state, scratch));
  Attachment held;
  held.link = *world.robots[0].kinematics.find_link("l3");
  held.pose = world.robots[0].tools[0].pose;
  state.attachments[0] = held;                           // reaches to 4 now
  state.poses[0].translation.setConstant(std::nan(""));  // nobody looks where it was
  const auto contact = checker.find_contact(state, scratch);
  ASSERT_TRUE(contact);
  EXPECT_EQ(world.name_of(contact->items[0]), "o0");
  EXPECT_EQ(world.name_of(contact->items[1]), "o1");
  // Folded, it meets the first link, which nothing carries.
  state.q[0] = {-1, 2.1, 2.1};
  const auto self = checker.find_contacts(state, scratch, {});
  EXPECT_TRUE(std::any_of(self.begin(), self.end(), [&](const Contact& c) {
    return world.name_of(c.items[1]) == "o0" && world.name_of(c.items[0]) != "arm/l3";
  }));
  // Never the link that holds it.
  for (const Contact& c : self) {
    EXPECT_FALSE(world.name_of(c.items[0]) == "arm/l3" && world.name_of(c.items[1]) == "o0");
  }
}

// What one link holds does not move together by itself: it may have been put into each other.
TEST(Checker, ThingsThatOneLinkHoldsAreLookedAt) {
  const SceneFiles files;
  const World world = files.world(files.scene(objects(files, {"[9, 9, 9]", "[-9, 9, 9]"})));
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  const auto meet = [&](double apart) {
    for (int i = 0; i < 2; ++i) {
      Attachment held;
      held.link = *world.robots[0].kinematics.find_link("l3");
      held.pose.translation = {1.6, i * apart, 0};
      state.attachments[i] = held;
    }
    for (const Contact& c : checker.find_contacts(state, scratch, {}))
      if (world.name_of(c.items[0]) == "o0" && world.name_of(c.items[1]) == "o1") return true;
    return false;
  };
  EXPECT_TRUE(meet(0.9));
  EXPECT_FALSE(meet(1.1));
}

TEST(Checker, TwoRobotsWithBases) {
  SceneFiles files;
  std::string text = files.scene();
  const auto start = text.find("[{\"name\": \"arm\"") + 1, end = text.rfind(']');
  std::string second = text.substr(start, end - start);
  second.replace(second.find("\"arm\""), 5, "\"other\"");
  second.insert(second.size() - 1, ", \"base\": {\"position\": [3.5, 0, 0], \"rpy\": [0, 0, 3]}");
  text.insert(end, ", " + second);
  const World world = files.world(text);
  ASSERT_EQ(world.robots.size(), 2U);
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  const auto contact = checker.find_contact(state, scratch);
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->items[0].robot, 0U);
  EXPECT_EQ(contact->items[1].robot, 1U);
  state.q[0][0] = 1.5;
  state.q[1][0] = 1.5;
  EXPECT_FALSE(checker.find_contact(state, scratch));
}

TEST(Checker, AllowedContactsAreNone) {
  const SceneFiles files;
  const std::string boxes = objects(files, {"[2, 0, 0]"});
  const auto free = [&](const std::string& more) {
    const World world = files.world(files.scene(boxes + more));
    const Checker checker(world);
    Scratch scratch;
    return !checker.find_contact(initial_state(world), scratch);
  };
  EXPECT_FALSE(free(""));
  EXPECT_FALSE(free(", \"allowed_contacts\": [[\"arm/l2\", \"o0\"]]"));
  EXPECT_TRUE(free(", \"allowed_contacts\": [[\"arm\", \"o0\"]]"));
}

TEST(Checker, ErrorsOfPlacesCount) {
  const SceneFiles files;
  // The arm's tip at x = 3 exactly, but for rounding: a box that begins there may be touched.
  const World world = files.world(files.scene(objects(files, {"[3.5, 0, 0.1]"})));
  const Checker checker(world);
  Scratch scratch;
  EXPECT_TRUE(checker.find_contact(initial_state(world), scratch));
  WorldState state = initial_state(world);
  state.poses[0].translation.x() += 1e-14;  // less than what kinematics may be wrong by
  EXPECT_TRUE(checker.find_contact(state, scratch));
  state.poses[0].translation.x() += 1e-10;
  EXPECT_FALSE(checker.find_contact(state, scratch));
}

TEST(Checker, MemoryOfAnotherWorldIsNotUsed) {
  const SceneFiles files;
  const World near = files.world(files.scene(objects(files, {"[2, 0, 0]"}))),
              far = files.world(files.scene(objects(files, {"[2, 9, 0]"})));
  Scratch scratch;
  std::optional<World> world;
  for (int i = 0; i < 6; ++i) {
    world = i % 2 == 0 ? near : far;  // at the same address
    const Checker checker(*world);
    EXPECT_EQ(checker.find_contact(initial_state(*world), scratch).has_value(), i % 2 == 0);
  }
  // Objects that are moved, carried, and put back.
  const Checker checker(near);
  WorldState state = initial_state(near);
  EXPECT_TRUE(checker.find_contact(state, scratch));
  state.poses[0].translation.y() = 9;
  EXPECT_FALSE(checker.find_contact(state, scratch));
  WorldState held = state;
  held.attachments[0] = Attachment{0, 3, {Eigen::Matrix3d::Identity(), {1.6, 0, 0}}, {}};
  EXPECT_FALSE(checker.find_contact(held, scratch));
  EXPECT_FALSE(checker.find_contact(state, scratch));
  EXPECT_TRUE(checker.find_contact(initial_state(near), scratch));
}

TEST(Checker, RefusesStatesOfOtherWorlds) {
  const SceneFiles files;
  const World world = files.world(files.scene());
  const Checker checker(world);
  Scratch scratch;
  WorldState state = initial_state(world);
  state.q[0].pop_back();
  EXPECT_THROW(checker.find_contact(state, scratch), Error);
  state = initial_state(world);
  state.q[0][0] = std::nan("");
  EXPECT_THROW(checker.find_contact(state, scratch), Error);
}

TEST(Checker, ThreadsMayShareAWorld) {
  const SceneFiles files;
  const World world = files.world(files.scene(objects(files, {"[2, 1, 0]", "[-1.5, 0.5, 0]"})));
  const Checker checker(world);
  std::mt19937_64 random(2);
  std::vector<WorldState> states(200, initial_state(world));
  std::vector<char> expected;
  Scratch scratch;
  for (WorldState& state : states) {
    state.q[0] = random_values(random, 3);
    expected.push_back(checker.find_contact(state, scratch) ? 1 : 0);
  }
  std::vector<int> wrong(3, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      Scratch own;
      for (std::size_t i = states.size(); i-- > 0;)
        wrong[t] += (checker.find_contact(states[i], own) ? 1 : 0) == expected[i] ? 0 : 1;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(3, 0));
}

}  // namespace
}  // namespace kaboum::world
