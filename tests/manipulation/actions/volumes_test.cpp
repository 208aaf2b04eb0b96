// Volumes of motions, against dense samples of the motions among exact meshes: by the judge's
// kinematics and triangles, and distances to bodies that are computed here.

#include "volumes.h"

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/judge/placement.h>
#include <kaboum/manipulation/words.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;
using plan::Answer;
using Words = std::map<std::string, std::string>;

/// From a point to a triangle (C. Ericson: Real-Time Collision Detection, 2005, 5.1.5).
double distance_to(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_segment = [&](const Vec3& u, const Vec3& v) {
    const double t = std::clamp((p - u).dot(v - u) / (v - u).squaredNorm(), 0.0, 1.0);
    return (u + t * (v - u) - p).norm();
  };
  double least = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - n.dot(p - a) * n;
  if (n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 &&
      n.dot((a - c).cross(foot - c)) >= 0)
    least = std::min(least, std::abs(n.dot(p - a)));
  return least;
}

/// How far a point is outside of a body's core; 0 inside.
double outside(const Vec3& p, const geom::Mesh& core) {
  bool inside = true;
  double least = 1e300;
  for (const geom::Triangle& t : core.triangles) {
    const Vec3 &a = core.vertices[t[0]], &b = core.vertices[t[1]], &c = core.vertices[t[2]];
    inside = inside && (b - a).cross(c - a).dot(p - a) <= 0;
    least = std::min(least, distance_to(p, a, b, c));
  }
  return inside ? 0 : least;
}

/// Whether some body of a set holds all points, by its radius; in the set's frame.
bool holds(const collide::BoundingSet& set, const std::vector<Vec3>& points) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    const geom::ConvexBody& body = set.body(i);
    if (std::ranges::all_of(
            points, [&](const Vec3& p) { return outside(p, body.core) <= body.radius + 1e-12; }))
      return true;
  }
  return false;
}

class Volumes : public ::testing::Test {
 protected:
  Volumes() {
    const world::Region& bay = arms_.world.regions.emplace_back(world::Region{
        "bay",
        {Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix(), {0.2, 0.35, 0.7}},
        {{{"", box_at({1.1, 1, 1.3}, Vec3::Zero())}}, collide::Direction::Inner, 1e-4}});
    bay_ = bay.pose;
    all_ = manipulation::bind_externals(arms_.world, {});
  }

  /// @param turn  about the vertical; the other arm is at -pi / 2 of the left one.
  std::vector<double> near_home(double by, double turn = 0) {
    std::vector<double> q = arms_.world.robots[0].home;
    q[0] = turn;
    std::normal_distribution<double> normal;
    for (double& x : q) x = std::clamp(x + by * normal(random_), -2.1, 2.1);
    return manipulation::configuration_of(manipulation::word_of(q), arms_.world.robots[0]);
  }
  static std::string word(const std::vector<double>& q) { return manipulation::word_of(q); }

  Words words(const std::vector<double>& left, const std::vector<double>& right) const {
    return {{"conf(left)", word(left)},
            {"conf(right)", word(right)},
            {"pose(block)", "away"},
            {"pose(socket)", "away"},
            {"pose(wall)", "away"}};
  }
  /// Nothing but the robots.
  judge::CellState robots(const std::vector<double>& left, const std::vector<double>& right) const {
    judge::CellState out = arms_.state();
    for (judge::CellState::Place& place : out.objects) place.away = true;
    out.q = {left, right};
    return out;
  }
  bool call(const std::string& function, const std::vector<std::string>& arguments,
            const Words& words) {
    const Answer answer = ask(all_, function, arguments, words);
    EXPECT_NE(answer.kind, Answer::Kind::NotFound) << answer.reason;
    return answer.kind == Answer::Kind::Value;
  }

  TwoArms arms_;
  Transform bay_;
  plan::ExternalBindings all_;
  std::mt19937_64 random_{7};
};

/// Answers about contacts beside what exact meshes say: never wrongly apart, rarely wrongly not.
struct ContactAnswers {
  void add(bool collide, bool meet, int number) {
    if (meet) {
      EXPECT_TRUE(collide) << number;
    }
    ++(meet ? certain : collide ? other : apart);
  }
  void expect_useful() const {
    EXPECT_GT(apart, 20);
    EXPECT_GT(certain, 10);
    EXPECT_LT(other, 12);
  }
  int apart = 0, certain = 0, other = 0;
};

TEST_F(Volumes, HoldTheRobotAndWhatItCarriesAtEveryInstant) {
  manipulation::Geometry geometry(arms_.world, {});
  std::size_t looked_at = 0;
  for (int i = 0; i < 30; ++i) {
    const std::vector<double> from = near_home(0.6), to = near_home(0.6);
    const world::Attachment held = arms_.hold(TwoArms::kLeft, static_cast<std::size_t>(i) % 5);
    Words state = words(from, arms_.world.robots[1].home);
    state["pose(block)"] = arms_.word(held);
    const Answer answer = ask(all_, "sweptVolume", {"left", word(to)}, state);
    ASSERT_EQ(answer.kind, Answer::Kind::Value);
    EXPECT_TRUE(answer.payload.empty());
    const auto volume = manipulation::volume_of(geometry, answer.value);
    ASSERT_EQ(volume->shapes.size(), arms_.world.robots[0].shapes.size() + 1);
    for (const std::vector<double>& q : samples_of({from, to}, 0.02)) {
      // In the robot's frame, where the volume's sets are.
      const std::vector<Transform> links = judge::places(arms_.world.robots[0].kinematics, {}, q);
      for (const manipulation::Volume::Shape& shape : volume->shapes) {
        const bool carried = shape.item.robot == world::Item::kObject;
        const auto& own = arms_.world.robots[0].shapes;
        const Transform at = carried ? judge::product(links[held.link], held.pose)
                                     : links[own[shape.item.index].link];
        std::vector<Vec3> points;
        for (const Vec3& p : arms_.world.outer(shape.item).body(0).core.vertices)
          points.emplace_back(at * p);
        ASSERT_TRUE(holds(*shape.set, points)) << arms_.world.name_of(shape.item);
        ++looked_at;
      }
    }
  }
  EXPECT_GT(looked_at, 5000U);
}

TEST_F(Volumes, ThatAreApartMeetAtNoTwoInstants) {
  ContactAnswers answers;
  for (int i = 0; i < 80; ++i) {
    const std::vector<std::vector<double>> left{near_home(0.4, -1), near_home(0.4, -1)},
        right{near_home(0.4, 1), near_home(0.4, 1)};
    const Words state = words(left[0], right[0]);
    const std::string a = ask(all_, "sweptVolume", {"left", word(left[1])}, state).value;
    const std::string b = ask(all_, "sweptVolume", {"right", word(right[1])}, state).value;
    const bool collide = call("volumesCollide", {a, b}, state);
    EXPECT_EQ(call("volumesCollide", {b, a}, state), collide);
    bool meet = false;
    for (const std::vector<double>& p : samples_of(left, 0.05))
      for (const std::vector<double>& q : samples_of(right, 0.05)) {
        if (meet) break;
        // Of the left one against all else: contacts with itself do not count.
        const auto meeting = arms_.cell.find_meeting(robots(p, q), 0);
        meet = meeting && meeting->names[0].substr(0, 4) != meeting->names[1].substr(0, 4);
      }
    answers.add(collide, meet, i);
  }
  answers.expect_useful();
}

TEST_F(Volumes, ThatAreFreeOfAnObjectDoNotMeetIt) {
  ContactAnswers answers;
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> from = near_home(0.5), to = near_home(0.5);
    const Transform at{
        Eigen::AngleAxisd(3 * unit(random_), Vec3::UnitY()).toRotationMatrix(),
        {0.45 + 0.3 * unit(random_), 0.35 + 0.4 * unit(random_), 0.8 + 0.3 * unit(random_)}};
    Words state = words(from, arms_.world.robots[1].home);
    state["pose(wall)"] = manipulation::word_of(at);
    const std::string volume = ask(all_, "sweptVolume", {"left", word(to)}, state).value;
    const bool collide = call("volumeCollides", {volume, "wall"}, state);
    const std::string wall = ask(all_, "occupiedVolume", {"wall"}, state).value;
    EXPECT_EQ(call("volumesCollide", {volume, wall}, state), collide);
    bool meet = false;
    judge::CellState now = robots(from, arms_.world.robots[1].home);
    now.objects[TwoArms::kWall] = {
        manipulation::place_of(state["pose(wall)"], arms_.world, TwoArms::kWall).pose, {}, false};
    for (const std::vector<double>& q : samples_of({from, to}, 0.01)) {
      now.q[0] = q;
      const auto meeting = arms_.cell.find_meeting_of(now, TwoArms::kWall);
      meet = meet || (meeting && (meeting->names[0].starts_with("left") ||
                                  meeting->names[1].starts_with("left")));
    }
    answers.add(collide, meet, i);
  }
  answers.expect_useful();
}

TEST_F(Volumes, ThatAreInARegionStayInIt) {
  int inside = 0, outside = 0, other = 0;
  const Eigen::Matrix3d back = bay_.linear.transpose();
  for (int i = 0; i < 20; ++i) {
    const std::vector<double> from = near_home(0.4), to = near_home(0.4);
    const Words state = words(from, arms_.world.robots[1].home);
    const std::string volume = ask(all_, "sweptVolume", {"left", word(to)}, state).value;
    const bool is_inside = call("volumeInside", {volume, "bay"}, state);
    bool stays = true;
    for (const std::vector<double>& q : samples_of({from, to}, 0.01)) {
      const auto links =
          judge::places(arms_.world.robots[0].kinematics, arms_.world.robots[0].base, q);
      for (const world::LinkShape& shape : arms_.world.robots[0].shapes)
        for (const Vec3& p : shape.outer.body(0).core.vertices) {
          const Vec3 in_bay = back * (links[shape.link] * p - bay_.translation);
          stays = stays && (in_bay.cwiseAbs() - Vec3(0.55, 0.5, 0.65)).maxCoeff() <= 1e-12;
        }
    }
    if (is_inside) {
      EXPECT_TRUE(stays) << i;
    }
    ++(is_inside ? inside : stays ? other : outside);
  }
  EXPECT_GT(inside, 4);
  EXPECT_GT(outside, 2);
  EXPECT_LT(other, 8);
}

TEST_F(Volumes, OfPathsAreFollowedFromWhereTheyBegin) {
  const std::vector<double> home = arms_.world.robots[0].home;
  const std::vector<double> to{0.9, -0.3, 1.5, 0, 1.2, 0};
  Words state = words(home, home);
  const Answer volume = ask(all_, "pathVolume", {"left", word(to)}, state);
  ASSERT_EQ(volume.kind, Answer::Kind::Value) << volume.reason;
  EXPECT_TRUE(volume.payload.empty());
  const Answer end = ask(all_, "follow", {"left", volume.value}, state);
  ASSERT_EQ(end.kind, Answer::Kind::Value) << end.reason;
  EXPECT_EQ(end.value, word(to));
  const std::vector<Motion> motions = motions_of(end);
  ASSERT_EQ(motions.size(), 1U);
  manipulation::Geometry geometry(arms_.world, {});
  EXPECT_EQ(motions[0].path, manipulation::volume_of(geometry, volume.value)->motions[0].path);
  // Of the other robot; from elsewhere; with something held; with something in the way.
  EXPECT_FALSE(call("follow", {"right", volume.value}, state));
  EXPECT_FALSE(call("follow", {"left", volume.value}, words(to, home)));
  Words holding = state;
  holding["pose(block)"] = arms_.word(arms_.hold(TwoArms::kLeft, 0));
  EXPECT_FALSE(call("follow", {"left", volume.value}, holding));
  Words blocked = state;
  const auto links =
      judge::places(arms_.world.robots[0].kinematics, arms_.world.robots[0].base, to);
  blocked["pose(wall)"] =
      manipulation::word_of(Transform{Eigen::Matrix3d::Identity(), links[arms_.hand].translation});
  EXPECT_TRUE(call("volumeCollides", {volume.value, "wall"}, blocked));
  EXPECT_FALSE(call("follow", {"left", volume.value}, blocked));
  // Back, to what is called home.
  const Answer back = ask(all_, "sweptVolume", {"left", "home"}, words(to, home));
  EXPECT_EQ(ask(all_, "follow", {"left", back.value}, words(to, home)).value, "home");
  // A volume of no motion.
  const Answer here = ask(all_, "pathVolume", {"left", word(home)}, state);
  ASSERT_EQ(here.kind, Answer::Kind::Value) << here.reason;
  EXPECT_EQ(ask(all_, "follow", {"left", here.value}, state).value, "home");
}

TEST_F(Volumes, OfFetchingHaveTheObjectInThem) {
  const std::vector<double> home = arms_.world.robots[0].home;
  Words state = words(home, home);
  state["pose(block)"] = "start";
  const Answer volume = ask(all_, "graspVolume", {"left", "block"}, state);
  ASSERT_EQ(volume.kind, Answer::Kind::Value) << volume.reason;
  EXPECT_FALSE(call("volumeCollides", {volume.value, "block"}, state));
  Words near = state;
  near["pose(wall)"] = "at 0.5 0.3 0.3 0 0 0 1";  // above the block
  EXPECT_TRUE(call("volumeCollides", {volume.value, "wall"}, near));
  EXPECT_FALSE(call("follow", {"left", volume.value}, state)) << "it is of several motions";
}

TEST_F(Volumes, OfOneThingAreNeverApart) {
  const std::vector<double> home = arms_.world.robots[0].home;
  Words state = words(home, home);
  state["pose(block)"] = arms_.word(arms_.hold(TwoArms::kLeft, 0));
  const std::string left = ask(all_, "occupiedVolume", {"left"}, state).value;
  EXPECT_EQ(ask(all_, "occupiedVolume", {"block"}, state).value, left) << "of what holds it";
  EXPECT_TRUE(call("volumesCollide", {left, left}, state));
  state["pose(block)"] = "start";
  const std::string block = ask(all_, "occupiedVolume", {"block"}, state).value;
  EXPECT_TRUE(call("volumesCollide", {left, block}, state)) << "the block is in both";
  const std::string right = ask(all_, "occupiedVolume", {"right"}, state).value;
  EXPECT_FALSE(call("volumesCollide", {right, block}, state));
  state["pose(block)"] = "away";
  EXPECT_FALSE(call("occupiedVolume", {"block"}, state));
}

TEST_F(Volumes, SayEverything) {
  // Another process knows them.
  const std::vector<double> home = arms_.world.robots[0].home;
  const Words state = words(home, home);
  const std::string a = ask(all_, "sweptVolume", {"left", "q -1.2 -0.3 1.5 0 1.2 0"}, state).value;
  const std::string b = ask(all_, "sweptVolume", {"right", "q 1.2 -0.3 1.5 0 1.2 0"}, state).value;
  const auto others = manipulation::bind_externals(arms_.world, {});
  EXPECT_EQ(ask(others, "volumesCollide", {a, b}, state).kind,
            ask(all_, "volumesCollide", {a, b}, state).kind);
  EXPECT_EQ(ask(others, "sweptVolume", {"left", "q -1.2 -0.3 1.5 0 1.2 0"}, state).value, a);
}

TEST_F(Volumes, RefuseOtherWords) {
  const std::vector<double> home = arms_.world.robots[0].home;
  const Words state = words(home, home);
  struct Case {
    const char *word, *says;
  };
  for (
      const Case& c : std::vector<Case>{
          {"home", "does not begin with 'swept'"},
          {"at 0 0 0 0 0 0 1", "sweptVolume, pathVolume"},
          {"", "does not begin with 'swept'"},
          {"swept []", "it is empty"},
          {"swept {}", "it is empty"},
          {"swept [", "it is to be"},
          {"swept [1]", "it is to be"},
          {R"(swept [{"robot": "left"}])", "it is to be"},
          {R"(swept [{"robot": "left", "path": []}])", "a waypoint at least"},
          {R"(swept [{"robot": "left", "path": [[0, 0]]}])", "6 joint values, not 2"},
          {R"(swept [{"robot": "left", "path": [[0, 0, 0, 0, 0, 1e999]]}])", "it is to be"},
          {R"(swept [{"robot": "left", "path": [[0, 0, 0, 0, 0, null]]}])", "it is to be"},
          {R"(swept [{"robot": "lefd", "path": [[0, 0, 0, 0, 0, 0]]}])", "no robot 'lefd'"},
          {R"(swept [{"robot": "left", "path": [[0, 0, 0, 0, 0, 0]], "holds": {"block": {"link": "x", "pose": []}}}])",
           "has no link 'x'"},
          {R"(swept [{"robot": "left", "path": [[0, 0, 0, 0, 0, 0]], "holds": {"blok": {"link": "hand", "pose": [1,0,0,0,1,0,0,0,1,0,0,0]}}}])",
           "no object 'blok'"},
          {R"(swept [{"object": "block", "pose": [1, 0, 0]}])", "12 numbers"},
          {R"(swept [{"object": "block", "pose": [2,0,0,0,1,0,0,0,1,0,0,0]}])", "rotation"},
          {R"(swept [{"object": "block", "pose": [-1,0,0,0,1,0,0,0,1,0,0,0]}])", "rotation"},
          {R"(swept [{"object": "chair", "pose": [1,0,0,0,1,0,0,0,1,0,0,0]}])",
           "no object 'chair'"}}) {
    try {
      ask(all_, "volumeCollides", {c.word, "wall"}, state);
      ADD_FAILURE() << c.word;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidInput) << c.word;
      EXPECT_NE(std::string(error.what()).find(c.says), std::string::npos)
          << c.word << ": " << error.what();
    }
  }
  const std::string volume = ask(all_, "occupiedVolume", {"left"}, state).value;
  EXPECT_THROW(ask(all_, "volumeCollides", {volume, "chair"}, state), Error);
  EXPECT_THROW(ask(all_, "volumeInside", {volume, "garden"}, state), Error);
  EXPECT_THROW(ask(all_, "volumesCollide", {volume, "home"}, state), Error);
  EXPECT_THROW(ask(all_, "occupiedVolume", {"chair"}, state), Error);
  EXPECT_THROW(ask(all_, "sweptVolume", {"block", "home"}, state), Error);
  EXPECT_THROW(ask(all_, "volumesCollide", {volume}, state), Error);
}

}  // namespace
}  // namespace kaboum::test
