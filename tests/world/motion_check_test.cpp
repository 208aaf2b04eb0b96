// Motions that are said to be free, sampled; motions that are not, looked at where they are said to
// meet something.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/world/motion_check.h>
#include <kaboum/world/regions.h>

#include <cmath>
#include <random>
#include <sstream>

#include "worlds.h"

namespace kaboum::world {
namespace {

using test::SceneFiles;
using Outcome = MotionAnswer::Outcome;

World arm_among_boxes(const SceneFiles& files) {
  std::string text = "\"objects\": [";
  const std::vector<std::string> positions{"[2, 1.2, 0]", "[-1.5, 0.9, 0.3]", "[0.5, -2.2, 0]",
                                           "[9, 9, 9]"};
  for (std::size_t i = 0; i < positions.size(); ++i)
    text += std::string(i == 0 ? "" : ",").append("{\"name\": \"o").append(std::to_string(i)) +
            "\", \"pose\": {\"position\": " + positions[i] +
            "}, \"outer\": " + files.ref("box.glb") + "}";
  return files.world(files.scene(text + "]"));
}

std::vector<double> at(const robot::Path& path, std::size_t segment, double share) {
  std::vector<double> q = path[segment];
  for (std::size_t i = 0; i < q.size(); ++i) q[i] += share * (path[segment + 1][i] - q[i]);
  return q;
}

TEST(CheckMotion, FreeAtEverySampleOrInContactWhereItSays) {
  const SceneFiles files;
  const World world = arm_among_boxes(files);
  const Checker checker(world);
  Scratch scratch;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> turn(-3, 3), step(-0.7, 0.7);
  int free = 0, contact = 0, later = 0;
  std::size_t most = 0;
  for (int i = 0; i < 150; ++i) {
    WorldState state = initial_state(world);
    if (i % 3 == 0) {
      Attachment held;
      held.link = 3;
      held.pose.translation = {1.6, 0, 0};
      state.attachments[3] = held;
    }
    robot::Path path(3, std::vector<double>(3));
    for (double& q : path[0]) q = turn(random);
    for (int k = 1; k < 3; ++k)
      for (int j = 0; j < 3; ++j) path[k][j] = path[k - 1][j] + step(random);
    const MotionAnswer answer = check_motion(checker, state, 0, path, {});
    most = std::max(most, answer.intervals);
    ASSERT_NE(answer.outcome, Outcome::Undecided);
    const bool is_free = answer.outcome == Outcome::Free;
    (is_free ? free : contact) += 1;
    for (std::size_t segment = 0; segment < 2; ++segment) {
      for (int k = 0; k <= 300; ++k) {
        const double share = k / 300.0;
        if (!is_free &&
            (segment > answer.segment || (segment == answer.segment && share >= answer.share)))
          continue;
        state.q[0] = at(path, segment, share);
        ASSERT_FALSE(checker.find_contact(state, scratch)) << i << " " << segment << " " << share;
      }
    }
    if (is_free) continue;
    ASSERT_TRUE(answer.contact);
    later += answer.segment > 0 || answer.share > 0 ? 1 : 0;
    state.q[0] = at(path, answer.contact_segment, answer.contact_share);
    if (answer.meets) {
      EXPECT_TRUE(checker.find_contact(state, scratch)) << i;
    } else {
      EXPECT_LE(checker.find_nearest(state, scratch, {})->clearance.upper, 1.01e-5) << i;
    }
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(contact, 20);
  EXPECT_GT(later, 10);
  EXPECT_LT(most, 3000U);
}

// The arm stretched out beside a box, and turned towards it as far as it may be off its line.
TEST(CheckMotion, FreeAroundAPathIsFreeAtTheFarthest) {
  int free = 0, met = 0;
  for (int k = 0; k < 40; ++k) {
    const SceneFiles files;
    std::ostringstream text;
    text << R"("objects": [{"name": "box", "pose": {"position": [2.4, )" << 0.55 + 0.0075 * k
         << R"(, 0]}, "outer": )" << files.ref("box.glb") << "}]";
    const World world = files.world(files.scene(text.str()));
    const Checker checker(world);
    Scratch scratch;
    WorldState state = initial_state(world);
    MotionOptions options;
    options.around = {0.03, 0.02, 0.04};
    const bool is_free =
        check_motion(checker, state, 0, {{-0.1, 0, 0}, {0, 0, 0}}, options).outcome ==
        Outcome::Free;
    state.q[0] = options.around;
    const bool meets = checker.find_contact(state, scratch).has_value();
    EXPECT_FALSE(is_free && meets) << k;
    free += is_free ? 1 : 0;
    met += meets ? 1 : 0;
  }
  EXPECT_GT(met, 15);
  EXPECT_GT(free, 5);
}

// Wherever the joints are within `around` of a path that is free with it, nothing meets.
TEST(CheckMotion, FreeAroundAPathIsFreeWithinThat) {
  const SceneFiles files;
  const World world = arm_among_boxes(files);
  const Checker checker(world);
  Scratch scratch;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> turn(-2.9, 2.9), step(-0.5, 0.5), wide(0, 0.06),
      share(0, 1), side(-1, 1);
  int free = 0, narrower = 0, met = 0;
  for (int i = 0; i < 300; ++i) {
    WorldState state = initial_state(world);
    if (i % 3 == 0) {
      Attachment held;
      held.link = 3;
      held.pose.translation = {1.6, 0, 0};
      state.attachments[3] = held;
    }
    robot::Path path(2, std::vector<double>(3));
    for (double& q : path[0]) q = turn(random);
    for (int j = 0; j < 3; ++j) path[1][j] = path[0][j] + step(random);
    MotionOptions options;
    for (int j = 0; j < 3; ++j) options.around.push_back(i % 5 == j ? 0 : wide(random));
    const bool on_line = check_motion(checker, state, 0, path, {}).outcome == Outcome::Free;
    const bool is_free = check_motion(checker, state, 0, path, options).outcome == Outcome::Free;
    EXPECT_TRUE(on_line || !is_free) << i;
    free += is_free ? 1 : 0;
    narrower += on_line && !is_free ? 1 : 0;
    bool meets = false;
    for (int k = 0; k < 400; ++k) {
      std::vector<double> q = at(path, 0, share(random));
      for (int j = 0; j < 3; ++j)
        q[j] += options.around[j] * (k % 2 == 0 ? side(random) : side(random) < 0 ? -1 : 1);
      state.q[0] = q;
      meets = meets || checker.find_contact(state, scratch).has_value();
    }
    ASSERT_FALSE(is_free && meets) << i;
    met += on_line && meets ? 1 : 0;
  }
  EXPECT_GT(free, 60);
  // Some meet something beside the line, and hardly more are refused than those.
  EXPECT_GT(met, 5);
  EXPECT_LT(narrower, 4 * met);
  MotionOptions wrong;
  for (const std::vector<double>& around :
       {std::vector<double>{0.1}, {0, 0, -0.1}, {0, 0, std::nan("")}}) {
    wrong.around = around;
    EXPECT_THROW(check_motion(checker, initial_state(world), 0, {{0, 0, 0}}, wrong), Error);
  }
}

TEST(CheckMotion, SeesWhatSamplesJumpOver) {
  // A thin plate that the tip passes in a tiny part of the motion.
  SceneFiles files;
  files.put(
      "plate.glb",
      test::set_of({test::box_mesh({-0.125, -0x1p-13, -0.5}, {0.125, 0x1p-13, 0.5})}, "outer", 0));
  const World world = files.world(files.scene(
      "\"objects\": [{\"name\": \"plate\", \"pose\": {\"position\": [3.05, 0, 0]}, \"outer\": " +
      files.ref("plate.glb") + "}]"));
  const Checker checker(world);
  const robot::Path path{{-0.5, 0, 0}, {0.7, 0, 0}};
  const MotionAnswer answer = check_motion(checker, initial_state(world), 0, path, {});
  EXPECT_EQ(answer.outcome, Outcome::Contact);
  EXPECT_NEAR(answer.share, 0.4, 0.05);
  ASSERT_TRUE(answer.contact);
  EXPECT_EQ(world.name_of(answer.contact->items[1]), "plate");
}

// Where bodies pass each other so closely that doubles hold no instant to tell by, the contact is
// still named.
TEST(CheckMotion, ContactIsNamedHoweverNarrow) {
  SceneFiles files;
  const std::string urdf = R"(<robot name="arm"><link name="base"/><link name="l1"><collision>
    <geometry><box size="1 1 1"/></geometry></collision></link><joint name="j" type="prismatic">
    <parent link="base"/><child link="l1"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";
  files.files["slide.urdf"] = {urdf.begin(), urdf.end()};
  files.put("slide.glb",
            test::set_of({test::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})}, "outer", 0, "l1"));
  World world = files.world(
      R"({"kaboum_scene": 1, "unit": "m", "robots": [{"name": "arm", "urdf": )" +
      files.ref("slide.urdf") + R"(, "links": [{"link": "l1", "outer": )" + files.ref("slide.glb") +
      R"(}]}], "objects": [{"name": "box", "outer": )" + files.ref("box.glb") + "}]}");
  const Checker checker(world);
  const auto at = [&](double y) {
    WorldState state = initial_state(world);
    state.poses[0].translation.y() = y;
    return check_motion(checker, state, 0, {{-8}, {8}},
                        {.resolution = 1e-300, .most_intervals = 2000});
  };
  double touching = 1, apart = 1.0625;
  ASSERT_EQ(at(touching).outcome, Outcome::Contact);
  ASSERT_NE(at(apart).outcome, Outcome::Contact);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (touching + apart);
    (at(middle).outcome == Outcome::Contact ? touching : apart) = middle;
  }
  int nearly = 0;
  for (int i = 0; i < 20; ++i, touching = std::nextafter(touching, 0)) {
    const MotionAnswer answer = at(touching);
    ASSERT_EQ(answer.outcome, Outcome::Contact) << i;
    ASSERT_TRUE(answer.contact) << i;
    nearly += answer.meets ? 0 : 1;
  }
  EXPECT_GT(nearly, 0);
}

TEST(CheckMotion, PathsOfOneWaypointAndOfNone) {
  const SceneFiles files;
  const World world = arm_among_boxes(files);
  const Checker checker(world);
  const WorldState state = initial_state(world);
  EXPECT_EQ(check_motion(checker, state, 0, {{-0.2, 0, 0}}, {}).outcome, Outcome::Free);
  EXPECT_EQ(check_motion(checker, state, 0, {{0.5, 0, 0}}, {}).outcome, Outcome::Contact);
  EXPECT_THROW(check_motion(checker, state, 0, {}, {}), Error);
  EXPECT_THROW(check_motion(checker, state, 1, {{0, 0, 0}}, {}), Error);
  EXPECT_THROW(check_motion(checker, state, 0, {{0, 0}}, {}), Error);
  EXPECT_THROW(check_motion(checker, state, 0, {{0, 0, 0}}, {.resolution = 0}), Error);
  const MotionAnswer limited = check_motion(
      checker, state, 0, {{-0.2, 0, 0}, {-0.6, 0.4, 0.2}, {0.5, 0, 0}}, {.most_intervals = 2});
  EXPECT_EQ(limited.outcome, Outcome::Undecided);
}

TEST(MotionInclusion, IsThatOfEveryInstant) {
  const SceneFiles files;
  // The region x from -2 to 2, y and z from -1 to 1, about the last link's way.
  const World world = files.world(files.scene(
      "\"objects\": [{\"name\": \"box\", \"outer\": " + files.ref("box.glb") +
      "}], \"regions\": [{\"name\": \"tray\", \"pose\": {\"position\": [0, 0, 0]}, \"inner\": " +
      files.ref("tray.glb") + "}]"));
  const Checker checker(world);
  const WorldState state = initial_state(world);
  MotionOptions options;
  options.resolution = 1e-3;
  const auto inside = [&](const robot::Path& path, const Item& item) {
    return find_inclusion(checker, state, 0, path, item, 0, options);
  };
  using collide::Inclusion;
  const Item l1{0, 1}, l2{0, 2};
  // Link 1 reaches to 1 from the origin: to y = 1 within its half-width it sticks out.
  EXPECT_EQ(inside({{0, 0, 0}, {1.2, 0, 0}}, l1).answer, Inclusion::Included);
  const auto out = inside({{0, 0, 0}, {1.2, 0, 0}, {1.57, 0, 0}, {0, 0, 0}}, l1);
  EXPECT_EQ(out.answer, Inclusion::NotIncluded);
  EXPECT_EQ(out.segment, 1U);
  // Until its corner (1, 0.0625) comes to y = 1, but for the resolution and the cube round it.
  const double angle = 1.2 + out.share * (1.57 - 1.2);
  const double y = std::sin(angle) + 0.0625 * std::cos(angle);
  EXPECT_LE(y, 1);
  EXPECT_NEAR(y, 1, 3e-3);
  // Both ends are inside, the middle is not: samples of the ends would not tell.
  EXPECT_EQ(inside({{1.2, 0, 0}, {1.9, 0, 0}}, l1).answer, Inclusion::NotIncluded);
  EXPECT_EQ(inside({{1.2, 0, 0}}, l1).answer, Inclusion::Included);
  EXPECT_EQ(inside({{1.9, 0, 0}}, l1).answer, Inclusion::Included);
  // Link 2 folded back stays in a disk of radius 1.
  EXPECT_EQ(inside({{0.1, 2.9, 0}, {0.4, 2.9, 0}}, l2).answer, Inclusion::Included);
  // What rests is looked at where it is.
  EXPECT_EQ(inside({{0, 0, 0}, {1, 0, 0}}, {Item::kObject, 0}).answer, Inclusion::Included);
  EXPECT_THROW(inside({{0, 0, 0}}, {0, 9}), Error);
  options.most_intervals = 2;
  EXPECT_EQ(inside({{-1.2, 0, 0}, {1.2, 0, 0}}, l1).answer, Inclusion::Undecided);
}

/// Two arms of three links that face each other.
World two_arms(const SceneFiles& files) {
  World world = files.world(files.scene());
  world.robots.push_back(world.robots[0]);
  world.robots[1].name = "other";
  world.robots[1].base.translation = Vec3(3.2, 0.3, 0);
  return world;
}

TEST(CheckMotions, SeveralRobotsAreApartAtEachInstantNotEachAlone) {
  const SceneFiles files;
  const World world = two_arms(files);
  const Checker checker(world);
  Scratch scratch;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> turn(-3, 3), step(-1.2, 1.2);
  int free = 0, contact = 0, free_only_together = 0, free_only_alone = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<RobotPath> paths(2);
    for (std::size_t r = 0; r < 2; ++r) {
      paths[r].robot = r;
      paths[r].path.assign(3, std::vector<double>(3));
      for (double& q : paths[r].path[0]) q = turn(random);
      for (int k = 1; k < 3; ++k)
        for (int j = 0; j < 3; ++j) paths[r].path[k][j] = paths[r].path[k - 1][j] + step(random);
    }
    const MotionAnswer answer = check_motions(checker, initial_state(world), paths, {});
    ASSERT_NE(answer.outcome, Outcome::Undecided);
    const auto state_at = [&](std::size_t segment, double share) {
      WorldState state = initial_state(world);
      for (const RobotPath& p : paths) state.q[p.robot] = at(p.path, segment, share);
      return state;
    };
    // Either order of the paths is the same motion.
    std::swap(paths[0], paths[1]);
    const MotionAnswer again = check_motions(checker, initial_state(world), paths, {});
    EXPECT_EQ(answer.outcome, again.outcome);
    std::swap(paths[0], paths[1]);
    if (answer.outcome == Outcome::Free) {
      ++free;
      for (std::size_t segment = 0; segment < 2; ++segment)
        for (int k = 0; k <= 200; ++k)
          ASSERT_TRUE(checker.is_free(state_at(segment, k / 200.0), scratch)) << i;
    } else if (answer.meets) {
      ++contact;
      EXPECT_FALSE(checker.is_free(state_at(answer.contact_segment, answer.contact_share), scratch))
          << i;
      // All before is free.
      for (int k = 0; answer.share > 0 && k < 100; ++k) {
        const double share = answer.share * (k / 100.0);
        ASSERT_TRUE(checker.is_free(state_at(answer.segment, share), scratch)) << i;
      }
    }
    // One after the other is another question.
    bool alone = true;
    WorldState state = initial_state(world);
    state.q[1] = paths[1].path.front();
    alone = check_motion(checker, state, 0, paths[0].path, {}).outcome == Outcome::Free;
    state.q[0] = paths[0].path.back();
    alone = alone && check_motion(checker, state, 1, paths[1].path, {}).outcome == Outcome::Free;
    free_only_together += answer.outcome == Outcome::Free && !alone ? 1 : 0;
    free_only_alone += answer.outcome != Outcome::Free && alone ? 1 : 0;
  }
  EXPECT_GT(free, 60);
  EXPECT_GT(contact, 60);
  EXPECT_GT(free_only_together, 3);
  EXPECT_GT(free_only_alone, 0);
}

TEST(CheckMotions, WhatOneCarriesMeetsTheOther) {
  const SceneFiles files;
  World world = two_arms(files);
  const World with_box = files.world(
      files.scene(R"("objects": [{"name": "box", "pose": {"position": [0, 9, 0]}, "outer": )" +
                  files.ref("box.glb") + "}]"));
  world.objects = with_box.objects;
  world.attachments = with_box.attachments;
  const Checker checker(world);
  WorldState state = initial_state(world);
  Attachment held;
  held.robot = 1;
  held.link = 3;
  held.pose.translation = {1.6, 0, 0};
  state.attachments[0] = held;
  // Both swing up in step; the box at the end of the other one is where the first one is, or not.
  const double kHalf = std::acos(-1.0) / 2;
  std::vector<RobotPath> paths{{0, {{0.9, 0.3, 0.1}, {1.4, 0.3, 0.1}}},
                               {1, {{kHalf, 0, 0}, {kHalf + 0.4, 0, 0}}}};
  EXPECT_EQ(check_motions(checker, state, paths, {}).outcome, Outcome::Free);
  paths[1].path = {{kHalf, 0, 0}, {kHalf + 1.6, 0, 0}};
  const MotionAnswer answer = check_motions(checker, state, paths, {});
  ASSERT_EQ(answer.outcome, Outcome::Contact);
}

// Wherever the joints of both are within `around` of paths that are free with it, nothing meets.
TEST(CheckMotions, WithRoomBothAreFreeAllAround) {
  const SceneFiles files;
  const World world = two_arms(files);
  const Checker checker(world);
  Scratch scratch;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> turn(-3, 3), step(-0.6, 0.6), side(-1, 1), wide(0, 0.1);
  int free = 0, lost = 0, lost_by_the_second = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<RobotPath> paths(2);
    for (std::size_t r = 0; r < 2; ++r) {
      paths[r].robot = r;
      paths[r].path.assign(2, std::vector<double>(3));
      for (std::size_t j = 0; j < 3; ++j) {
        paths[r].path[0][j] = turn(random);
        paths[r].path[1][j] = paths[r].path[0][j] + step(random);
        if (i % 3 != 2 || r == 1) paths[r].around.push_back(wide(random));
      }
    }
    std::vector<RobotPath> lines = paths;
    for (RobotPath& p : lines) p.around.clear();
    const WorldState state = initial_state(world);
    const bool on_lines = check_motions(checker, state, lines, {}).outcome == Outcome::Free;
    if (check_motions(checker, state, paths, {}).outcome != Outcome::Free) {
      lost += on_lines ? 1 : 0;
      lost_by_the_second += on_lines && paths[0].around.empty() ? 1 : 0;
      continue;
    }
    ++free;
    ASSERT_TRUE(on_lines) << i;
    for (int k = 0; k <= 100; ++k) {
      WorldState near = state;
      for (const RobotPath& p : paths) {
        std::vector<double>& q = near.q[p.robot] = at(p.path, 0, k / 100.0);
        for (std::size_t j = 0; j < p.around.size(); ++j)
          q[j] += p.around[j] * (k % 2 == 0 ? side(random) : side(random) < 0 ? -1 : 1);
      }
      ASSERT_TRUE(checker.is_free(near, scratch)) << i;
    }
  }
  EXPECT_GT(free, 40);
  EXPECT_GT(lost, 5);
  EXPECT_GT(lost_by_the_second, 0);
}

TEST(CheckMotions, WhatDoesNotFitIsRefused) {
  const SceneFiles files;
  const World world = two_arms(files);
  const Checker checker(world);
  const WorldState state = initial_state(world);
  const robot::Path two{{0, 0, 0}, {0.1, 0, 0}}, three{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}};
  const auto refused = [&](const std::vector<RobotPath>& paths, const std::string& words) {
    try {
      static_cast<void>(check_motions(checker, state, paths, {}));
      ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refused({}, "no robot");
  refused({{0, two}, {1, three}}, "'other' has 3, 'arm' has 2");
  refused({{0, two}, {0, two}}, "'arm' has two paths");
  refused({{2, two}}, "no such robot");
  refused({{0, {{0, 0}}}}, "another robot");
  refused({{0, two, {0, 0, 0}}, {1, two, {0, 0}}}, "from 0 to 1e9");
  refused({{0, two}, {1, two, {0, -1, 0}}}, "from 0 to 1e9");
}

}  // namespace
}  // namespace kaboum::world
