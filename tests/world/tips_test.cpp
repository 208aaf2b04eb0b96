// What leaves out pairs beforehand, attacked where it is tightest: spindles that touch tip to tip
// on the line of their balls' centres, so that a ball that is too small by more than floats need
// (2^-19), and a margin or pose that is wrong by a billionth, loses a contact or finds one more.

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/motion_check.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "worlds.h"

namespace kaboum::world {
namespace {

using test::SceneFiles;

constexpr double kGap = 1e-9;
/// Half the length of a spindle, and what its margin adds to each tip.
constexpr double kHalf = 0.5, kMargin = 0.125;

/// About a centre, with tips at ±kHalf on the x-axis.
geom::Mesh spindle(const Vec3& center) {
  std::vector<Vec3> points;
  for (const double s : {-1.0, 1.0}) {
    points.emplace_back(center + s * kHalf * Vec3::UnitX());
    points.emplace_back(center + s * 0.0625 * Vec3::UnitY());
    points.emplace_back(center + s * 0.0625 * Vec3::UnitZ());
  }
  return *geom::convex_hull(points);
}

Transform random_pose(std::mt19937_64& random, double far) {
  std::uniform_real_distribution<double> from(-1, 1);
  const Vec3 axis(from(random), from(random), from(random));
  const double angle = 3 * from(random);
  return {robot::rotation_about(axis.normalized(), angle),
          far * Vec3(from(random), from(random), from(random))};
}

/// A rotation that takes the x-axis to a direction, at a random angle about it.
Eigen::Matrix3d along(const Vec3& direction, std::mt19937_64& random) {
  const double angle = std::uniform_real_distribution<double>(-3, 3)(random);
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), direction).toRotationMatrix() *
         robot::rotation_about(Vec3::UnitX(), angle);
}

/// The arm whose last link is a spindle beside its joint, and spindles with and without a margin.
class TipsTest : public ::testing::TestWithParam<double> {
 protected:
  TipsTest() {
    const geom::ConvexSet plain = with(test::set_of({spindle(kCenter)}, "outer", 0.5, "l3"));
    files_.put("l3.glb", plain);
    files_.put("spindle.glb", with(test::set_of({spindle(Vec3::Zero())}, "outer", 0.5)));
    world_ = files_.world(
        files_.scene("\"objects\": [{\"name\": \"a\", \"outer\": " + files_.ref("spindle.glb") +
                     "}, {\"name\": \"b\", \"outer\": " + files_.ref("spindle.glb") + "}]"));
  }

  static geom::ConvexSet with(geom::ConvexSet set) {
    set_margin(set, GetParam());
    return set;
  }

  /// Puts object b so that its tip is `gap` from the tip at +x of a spindle about `center`.
  void face(WorldState& state, const Transform& pose, const Vec3& center, double gap) {
    const Vec3 direction = (pose.linear * Vec3::UnitX()).normalized();
    state.poses[1] = {along(direction, random_),
                      pose * center + (2 * (kHalf + GetParam()) + gap) * direction};
  }

  /// Whether there is a contact with object b.
  bool meets(const WorldState& state) {
    const Checker checker(world_);
    bool found = false;
    for (const Contact& c : checker.find_contacts(state, scratch_, {.resting = true}))
      found = found || world_.name_of(c.items[0]) == "b" || world_.name_of(c.items[1]) == "b";
    EXPECT_EQ(checker.is_free(state, scratch_, {.resting = true}),
              !checker.find_contact(state, scratch_, {.resting = true}));
    return found;
  }

  void expect_tight(const WorldState& start, const Transform& pose, const Vec3& center) {
    WorldState state = start;
    face(state, pose, center, -kGap);
    EXPECT_TRUE(meets(state));
    face(state, pose, center, kGap);
    EXPECT_FALSE(meets(state));
  }

  const Vec3 kCenter{0.5, 0.25, -0.125};
  SceneFiles files_;
  World world_;
  Scratch scratch_;
  std::mt19937_64 random_{5};
};

TEST_P(TipsTest, OfObjectsThatRest) {
  for (int i = 0; i < 40; ++i) {
    WorldState state = initial_state(world_);
    // Of the second half, far away, where boxes are coarser.
    state.poses[0] = random_pose(random_, i < 20 ? 3 : 300);
    state.poses[0].translation.z() += 900;
    expect_tight(state, state.poses[0], Vec3::Zero());
  }
}

TEST_P(TipsTest, OfALinkAndAnObject) {
  for (int i = 0; i < 40; ++i) {
    world_.robots[0].base = random_pose(random_, 2);
    WorldState state = initial_state(world_);
    for (double& q : state.q[0]) q = std::uniform_real_distribution<double>(-3, 3)(random_);
    state.poses[0].translation = {0, 0, 100};
    const RobotModel& arm = world_.robots[0];
    const Transform link = arm.base * robot::forward(arm.kinematics, state.q[0]).back();
    // Other links may be where the object is put.
    WorldState alone = state;
    face(alone, link, kCenter, 10 * kGap);
    if (meets(alone)) continue;
    expect_tight(state, link, kCenter);
  }
}

TEST_P(TipsTest, OfWhatALinkCarries) {
  for (int i = 0; i < 40; ++i) {
    WorldState state = initial_state(world_);
    for (double& q : state.q[0]) q = std::uniform_real_distribution<double>(-3, 3)(random_);
    Attachment held;
    held.link = *world_.robots[0].kinematics.find_link("l3");
    held.pose = random_pose(random_, 0.5);
    held.pose.translation.z() += 3;
    state.attachments[0] = held;
    const Transform link = robot::forward(world_.robots[0].kinematics, state.q[0]).back();
    expect_tight(state, link * held.pose, Vec3::Zero());
  }
}

TEST_P(TipsTest, OfAMotion) {
  WorldState state = initial_state(world_);
  state.poses[0].translation = {0, 0, 100};
  // At j3 = 0 the tip passes the other one, nowhere else.
  const robot::Path path{{0.4, 0.2, -0.6}, {0.4, 0.2, 0.7}};
  const auto poses = robot::forward(world_.robots[0].kinematics, std::vector<double>{0.4, 0.2, 0});
  const auto outcome = [&](double gap) {
    // The tip is farthest from the joint's axis there.
    face(state, {poses.back().linear, poses.back() * Vec3(0.5, 0, 0)}, Vec3::Zero(), gap);
    const Checker checker(world_);
    return check_motion(checker, state, 0, path, {.resolution = 1e-7}).outcome;
  };
  files_.put("l3.glb", with(test::set_of({spindle({0.5, 0, 0})}, "outer", 0.5, "l3")));
  world_ = files_.world(
      files_.scene("\"objects\": [{\"name\": \"a\", \"outer\": " + files_.ref("spindle.glb") +
                   "}, {\"name\": \"b\", \"outer\": " + files_.ref("spindle.glb") + "}]"));
  EXPECT_EQ(outcome(-kGap), MotionAnswer::Outcome::Contact);
  EXPECT_EQ(outcome(1e-6), MotionAnswer::Outcome::Free);
}

INSTANTIATE_TEST_SUITE_P(, TipsTest, ::testing::Values(0.0, kMargin), [](const auto& value) {
  return std::string(value.param == 0 ? "Plain" : "WithMargin");
});

// A slide is as fast as its bound says, so that a bound of a motion that is a tenth too small takes
// a stretch for free at the end of which there is a contact.
TEST(Motions, OfSlidesThatEndInContact) {
  const SceneFiles files;
  for (int k = 80; k <= 110; ++k) {
    const double share = 0.01 * k;  // of the way, at which the arm meets what is above it
    if (k == 100) continue;
    World world = files.world(
        files.scene("\"objects\": [{\"name\": \"o\", \"pose\": {\"position\": [1.5, 0, " +
                    std::to_string(0.1 + 0.0625 + share + 0.5) +
                    "]}, \"outer\": " + files.ref("box.glb") + "}]"));
    world.robots[0].kinematics.joints[0].type = robot::JointType::Prismatic;
    const Checker checker(world);
    const MotionAnswer answer =
        check_motion(checker, initial_state(world), 0, {{0, 0, 0}, {1, 0, 0}}, {});
    EXPECT_EQ(answer.outcome,
              k < 100 ? MotionAnswer::Outcome::Contact : MotionAnswer::Outcome::Free)
        << share;
    if (k < 100) {
      EXPECT_NEAR(answer.share, share, 2e-5);
    }
  }
}

// Far beyond the values for which errors are bounded beforehand angles are rounded more coarsely.
TEST(Errors, GrowWithJointValues) {
  const SceneFiles files;
  World world = files.world(files.scene());
  robot::Joint& joint = world.robots[0].kinematics.joints[0];
  joint.multiplier = 0.3;
  joint.offset = 0.7;
  const Checker checker(world);
  std::mt19937_64 random(7);
  double most = 0;
  for (int i = 0; i < 200; ++i) {
    WorldState state = initial_state(world);
    const double q = std::uniform_real_distribution<double>(-1e9, 1e9)(random);
    state.q[0] = {q, 0, 0};
    const long double angle =
        static_cast<long double>(joint.multiplier) * q + static_cast<long double>(joint.offset);
    const auto c = std::cos(angle), s = std::sin(angle);
    for (const Checker::PosedItem& placed : checker.places(state)) {
      if (world.robots[0].shapes[placed.item.index].link != 3) continue;
      for (const Vec3& p : checker.hull_of(placed.item)) {
        const long double x = 2 + static_cast<long double>(p.x()), y = p.y();
        const Vec3 at = placed.place.pose() * p;
        const double off =
            static_cast<double>(std::hypot(c * x - s * y - at.x(), s * x + c * y - at.y()));
        EXPECT_LT(off, placed.place.error());
        most = std::max(most, off);
      }
    }
  }
  EXPECT_GT(most, 1e-9);
}

// What is remembered of how an object is held is that hold's only.
TEST(Errors, GrowWithHowFarAwayAnObjectIsHeld) {
  const SceneFiles files;
  const World world =
      files.world(files.scene("\"objects\": [{\"name\": \"a\", \"outer\": " + files.ref("box.glb") +
                              "}, {\"name\": \"b\", \"outer\": " + files.ref("box.glb") + "}]"));
  const Checker checker(world);
  std::size_t between = 0;
  for (int k = 0; k < 40; ++k) {
    const double gap = 1e-9 * std::pow(1.3, k);
    const auto meets = [&](double away, Scratch& scratch) {
      WorldState state = initial_state(world);
      Attachment held;
      held.link = *world.robots[0].kinematics.find_link("l3");
      held.pose.translation = {0, away, 0};
      state.attachments[0] = held;
      state.poses[1].translation = {2, away + 1 + gap, 0.1};
      return checker.find_contact(state, scratch).has_value();
    };
    Scratch fresh, used;
    EXPECT_FALSE(meets(10, used));
    const bool far = meets(1e6, fresh);
    EXPECT_EQ(meets(1e6, used), far) << gap;
    between += far ? 1 : 0;
  }
  EXPECT_GT(between, 0U);
  EXPECT_LT(between, 40U);
}

}  // namespace
}  // namespace kaboum::world
