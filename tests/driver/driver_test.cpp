// Robot drivers: what functions are called for what is told, what is answered, how a run ends.

#include <gtest/gtest.h>
#include <kaboum/driver/driver.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace kaboum::driver {
namespace {

using nlohmann::json;
using Values = std::vector<double>;

/// Two joints at a time from 0 to 1, from rest to rest.
Instant curve(double t) {
  const double s = t * t * t * (10 - 15 * t + 6 * t * t), v = 30 * t * t * (1 - t) * (1 - t),
               a = 60 * t * (1 - t) * (1 - 2 * t);
  return {{s, 1 - 2 * s}, {v, -2 * v}, {a, -2 * a}};
}

json trajectory(int count = 10) {
  json points = json::array();
  for (int k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / count;
    const Instant at = curve(t);
    points.push_back({{"time_from_start", t},
                      {"positions", at.q},
                      {"velocities", at.velocity},
                      {"accelerations", at.acceleration}});
  }
  return {{"joint_names", {"a", "b"}}, {"points", points}};
}

const json kBegin = {{"do", "begin"},
                     {"robots", {{"arm", {{"joint_names", {"a", "b"}}, {"q", {0.0, 1.0}}}}}},
                     {"objects",
                      {{"o1", {{"pose", {{1, 0, 0, 0.5}, {0, 1, 0, 0}, {0, 0, 1, 0}}}}},
                       {"o2", {{"held_by", "arm"}}},
                       {"o3", {{"away", true}}}}}};

class Recorder : public Driver {
 public:
  std::vector<std::string> calls;
  bool stuck = false, broken = false;
  std::optional<Values> at;
  std::map<std::string, Place> places;

 protected:
  void begin(const std::map<std::string, Robot>& robots,
             const std::map<std::string, Place>& objects) override {
    calls.push_back("begin " + std::to_string(robots.size()));
    places = objects;
  }
  void act(const std::string& action) override {
    if (broken) throw std::logic_error("a mistake of the driver");
    calls.push_back(action);
  }
  std::vector<ExecutedSample> move(const std::string& robot, const Motion& motion) override {
    if (stuck) throw Failure("a fuse has blown");
    calls.push_back("move " + robot);
    if (!at) return {};
    at = Values{0.999, -1};
    return {{0, {0, 1}}, {motion.duration(), *at}};
  }
  void close(const std::string&, const std::string& link) override {
    calls.push_back("close " + link);
  }
  void open(const std::string&, const std::string& link) override {
    calls.push_back("open " + link);
  }
  void attach(const std::string&, const std::string& object, const std::string&) override {
    calls.push_back("attach " + object);
  }
  void detach(const std::string&, const std::string& object) override {
    calls.push_back("detach " + object);
  }
  std::optional<Values> where(const std::string&) override { return at; }
  void stop() override { calls.emplace_back("stop"); }
};

std::vector<json> speak(Driver& driver, std::vector<json> messages) {
  std::stringstream in, out;
  int id = 0;
  for (json& m : messages) {
    m["id"] = ++id;
    in << m.dump() << '\n';
  }
  driver.run(in, out);
  std::string line;
  std::getline(out, line);
  EXPECT_EQ(json::parse(line), json({{"kaboum_driver", 1}}));
  std::vector<json> answers;
  while (std::getline(out, line)) answers.push_back(json::parse(line));
  return answers;
}

json move_of(const json& told) { return {{"do", "move"}, {"robot", "arm"}, {"trajectory", told}}; }

TEST(Driver, EachMessageIsAFunction) {
  Recorder driver;
  const auto answers = speak(
      driver,
      {kBegin, {{"do", "act"}, {"action", "fetch"}}, move_of(trajectory()), {{"do", "finish"}}});
  ASSERT_EQ(answers.size(), 4U);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(answers[k], json({{"done", true}, {"id", k + 1}}));
  EXPECT_EQ(driver.calls, (std::vector<std::string>{"begin 1", "fetch", "move arm", "stop"}));
  ASSERT_TRUE(driver.places.at("o1").pose);
  EXPECT_EQ((*driver.places.at("o1").pose)[0][3], 0.5);
  EXPECT_EQ(driver.places.at("o2").held_by, "arm");
  EXPECT_TRUE(driver.places.at("o3").away);
}

TEST(Driver, AGripperClosesAndOpensOnce) {
  Recorder driver;
  json begin = kBegin;
  begin["objects"] = json::object();
  const auto take = [](const char* object) {
    return json{{"do", "take"}, {"robot", "arm"}, {"object", object}, {"link", "hand"}};
  };
  const auto release = [](const char* object) {
    return json{{"do", "release"}, {"robot", "arm"}, {"object", object}};
  };
  const auto answers = speak(driver, {begin, take("o1"), take("lid"), take("lid"), release("lid"),
                                      release("o1"), release("o1")});
  EXPECT_EQ(driver.calls,
            (std::vector<std::string>{"begin 1", "close hand", "attach o1", "attach lid",
                                      "detach lid", "detach o1", "open hand", "stop"}));
  for (const std::size_t k : {3U, 6U}) EXPECT_TRUE(answers.at(k).contains("failed")) << k;
}

/// Notes how far a gripper with joints goes.
class Hand : public Recorder {
 protected:
  void close(const std::string& robot, const std::string& link) override {
    Recorder::close(robot, link);
    note();
  }
  void open(const std::string& robot, const std::string& link) override {
    Recorder::open(robot, link);
    note();
  }

 private:
  void note() {
    const Gripper* g = gripper();
    calls.push_back(g == nullptr
                        ? "no joints"
                        : g->name + " " + g->joint_names.at(0) + " to " + json(g->to.at(0)).dump() +
                              " within " + json(g->within).dump());
  }
};

TEST(Driver, AGripperWithJointsIsToldHowFarAndMotionsBeginThere) {
  Hand driver;
  driver.at = Values{0, 0.25};
  json begin = kBegin;
  begin["objects"] = json::object();
  const json gripper = {{"name", "fingers"}, {"joint_names", {"b"}}, {"from", {1.0}},
                        {"to", {0.25}},      {"within", 0.0625},     {"pads", {"pad"}}};
  json take = {{"do", "take"}, {"robot", "arm"}, {"object", "o1"}, {"link", "hand"}};
  json plain = take;
  plain["object"] = "o2";
  take["gripper"] = gripper;
  json unknown = take;
  unknown["gripper"]["joint_names"] = {"c"};
  json release = {{"do", "release"}, {"robot", "arm"}, {"object", "o1"}, {"gripper", gripper}};
  release["gripper"]["to"] = {1.0};
  const auto answers = speak(driver, {begin, unknown, take, move_of(trajectory()), release, plain});
  EXPECT_TRUE(answers.at(1).contains("failed"));
  EXPECT_EQ(answers.at(2), json({{"done", true}, {"q", {0, 0.25}}, {"id", 3}}));
  // Told to be at 0.25 since then; that motion begins at 1.
  EXPECT_NE(answers.at(3).value("failed", "").find("begins elsewhere"), std::string::npos);
  EXPECT_TRUE(answers.at(4).contains("done"));
  EXPECT_EQ(driver.calls,
            (std::vector<std::string>{"begin 1", "close hand", "fingers b to 0.25 within 0.0625",
                                      "attach o1", "detach o1", "open hand",
                                      "fingers b to 1.0 within 0.0625", "close hand", "no joints",
                                      "attach o2", "stop"}));
}

TEST(Driver, WhereItIsAndHowItMovedAreSaid) {
  Recorder driver;
  driver.at = Values{0, 1};
  const auto answers = speak(driver, {kBegin, move_of(trajectory())});
  EXPECT_EQ(answers.at(0)["q"], json({{"arm", {0.0, 1.0}}}));
  EXPECT_EQ(answers.at(1)["q"], json({0.999, -1.0}));
  EXPECT_EQ(answers.at(1)["executed"], json({{0.0, 0.0, 1.0}, {1.0, 0.999, -1.0}}));
}

TEST(Driver, FailuresSayWhyAndWhere) {
  Recorder driver;
  driver.at = Values{0, 1};
  driver.stuck = true;
  const auto answers =
      speak(driver, {kBegin,
                     move_of(trajectory()),
                     {{"do", "sense"}, {"fact", "p"}, {"values", {"true"}}},
                     {{"do", "dance"}},
                     {{"do", "move"}, {"robot", "leg"}, {"trajectory", trajectory()}}});
  EXPECT_EQ(answers.at(1), json({{"failed", "a fuse has blown"}, {"q", {0.0, 1.0}}, {"id", 2}}));
  for (const std::size_t k : {2U, 3U, 4U}) EXPECT_TRUE(answers.at(k).contains("failed")) << k;
}

TEST(Driver, WhatIsNoTrajectoryIsNotFollowed) {
  std::vector<json> wrong(8, trajectory());
  wrong[0]["points"].clear();
  wrong[1]["points"][3]["positions"] = {1.0};
  wrong[2]["points"][0]["velocities"] = {1.0, 0.0};
  wrong[3]["points"][10]["velocities"] = {0.0, 1e-3};
  wrong[4]["points"][0]["time_from_start"] = 0.01;
  wrong[5]["points"][4]["time_from_start"] = 0.3;
  wrong[6]["joint_names"] = {"b", "a"};
  wrong[7]["points"][0]["positions"] = {0.0, 1.001};
  for (const json& told : wrong) {
    Recorder driver;
    EXPECT_TRUE(speak(driver, {kBegin, move_of(told)}).at(1).contains("failed")) << told;
    EXPECT_EQ(driver.calls, (std::vector<std::string>{"begin 1", "stop"})) << told;
  }
}

TEST(Driver, ItStopsHoweverItEnds) {
  Recorder told;
  speak(told, {kBegin, {{"do", "stop"}}, {{"do", "act"}, {"action", "never"}}});
  EXPECT_EQ(told.calls, (std::vector<std::string>{"begin 1", "stop"}));
  Recorder broken;
  broken.broken = true;
  EXPECT_THROW(speak(broken, {{{"do", "act"}, {"action", "x"}}}), std::logic_error);
  EXPECT_EQ(broken.calls, (std::vector<std::string>{"stop"}));
  Recorder none;
  std::stringstream in("{\n"), out;
  EXPECT_THROW(none.run(in, out), std::runtime_error);
  EXPECT_EQ(none.calls, (std::vector<std::string>{"stop"}));
}

/// What a motion is to be followed with.
class Follower : public Recorder {
 public:
  std::vector<double> times;
  Instant last;

 protected:
  std::vector<ExecutedSample> move(const std::string&, const Motion& motion) override {
    for (int k = 0; k <= 100; ++k) {
      const Instant is = motion.at(k / 100.0), wanted = curve(k / 100.0);
      for (std::size_t j = 0; j < 2; ++j) {
        EXPECT_NEAR(is.q[j], wanted.q[j], 1e-12);
        EXPECT_NEAR(is.velocity[j], wanted.velocity[j], 1e-12);
        EXPECT_NEAR(is.acceleration[j], wanted.acceleration[j], 1e-11);
      }
    }
    EXPECT_EQ(motion.at(-1).q, (Values{0, 1}));
    EXPECT_EQ(motion.at(2).velocity, (Values{0, 0}));
    follow(motion, 200, [&](double time, const Instant& now) {
      times.push_back(time);
      last = now;
    });
    return {};
  }
};

TEST(Driver, IsFollowedInItsTimeByThePolynomialOfDegree5) {
  Follower driver;
  speak(driver, {kBegin, move_of(trajectory(4))});
  ASSERT_GT(driver.times.size(), 5U);
  EXPECT_LE(driver.times.size(), 201U);
  EXPECT_EQ(driver.times.front(), 0);
  EXPECT_EQ(driver.times.back(), 1);
  for (std::size_t k = 0; k + 1 < driver.times.size(); ++k)
    EXPECT_LT(driver.times[k], driver.times[k + 1]);
  EXPECT_EQ(driver.last.q, (Values{1, -1}));
}

/// Is held up once, in the middle.
class HeldUp : public Recorder {
 public:
  std::chrono::milliseconds pause{0};
  double rate = 100, most_step = 0, last = 0, before = 0;

 protected:
  std::vector<ExecutedSample> move(const std::string&, const Motion& motion) override {
    std::size_t k = 0;
    follow(motion, rate, [&](double time, const Instant& now) {
      if (++k == 50) std::this_thread::sleep_for(pause);
      last = time;
      most_step = std::max(most_step, std::abs(now.q[0] - before));
      before = now.q[0];
    });
    return {};
  }
};

TEST(Driver, NoSetpointIsLeftOut) {
  HeldUp driver;
  driver.pause = std::chrono::milliseconds(45);
  const auto begun = std::chrono::steady_clock::now();
  const auto answers = speak(driver, {kBegin, move_of(trajectory(4))});
  EXPECT_TRUE(answers.at(1).contains("done")) << answers.at(1);
  EXPECT_LE(driver.most_step, 1.875 / 100 * (1 + 1e-6));
  // What follows is as much later.
  EXPECT_GT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(),
            1 + 0.045 - 0.01 - 1e-3);
  HeldUp late;
  late.pause = std::chrono::milliseconds(80);
  const auto told = speak(late, {kBegin, move_of(trajectory(4))});
  EXPECT_NE(told.at(1).value("failed", "").find("a setpoint was"), std::string::npos);
  EXPECT_LT(late.last, 0.5);
  for (const double rate : {0.0, -1.0, std::nan("")}) {
    HeldUp none;
    none.rate = rate;
    EXPECT_THROW(speak(none, {kBegin, move_of(trajectory(4))}), std::invalid_argument);
    EXPECT_EQ(none.calls.back(), "stop");
  }
}

/// Whose end does not go well either.
class Stubborn : public Recorder {
 public:
  bool stuck_at_stop = true;
  std::size_t acts = 0;

 protected:
  void act(const std::string& action) override {
    ++acts;
    if (action == "break") throw std::logic_error("a mistake of the driver");
  }
  void stop() override {
    calls.emplace_back("stop");
    if (stuck_at_stop) throw Failure("it does not stop");
  }
};

TEST(Driver, AStopThatFailsIsTold) {
  Stubborn driver;
  EXPECT_THROW(speak(driver, {{{"do", "act"}, {"action", "break"}}}), std::logic_error);
  EXPECT_EQ(driver.calls, (std::vector<std::string>{"stop"}));
  Stubborn well;
  EXPECT_THROW(speak(well, {{{"do", "act"}, {"action", "x"}}}), Failure);
  EXPECT_EQ(well.calls, (std::vector<std::string>{"stop"}));
}

TEST(Driver, NothingIsDoneWhereNobodyReads) {
  Stubborn driver;
  driver.stuck_at_stop = false;
  std::stringstream in("{\"id\": 1, \"do\": \"act\", \"action\": \"x\"}\n"), out;
  out.setstate(std::ios::badbit);
  driver.run(in, out);
  EXPECT_EQ(driver.acts, 0U);
  EXPECT_EQ(driver.calls, (std::vector<std::string>{"stop"}));
  // A pipe of which the other end is closed does not kill.
  EXPECT_EQ(std::signal(SIGPIPE, SIG_DFL), SIG_IGN);
}

TEST(Driver, WhatHasNoIdIsNotDone) {
  Stubborn driver;
  driver.stuck_at_stop = false;
  std::stringstream in("{\"do\": \"act\", \"action\": \"x\"}\n"), out;
  EXPECT_THROW(driver.run(in, out), std::runtime_error);
  EXPECT_EQ(driver.acts, 0U);
}

/// Says that it is somewhere, whatever it is told.
class Displaced : public Recorder {
 public:
  explicit Displaced(double by, double allowed = 0.05) {
    at = Values{0, 1 + by};
    tracking = allowed;
  }
};

TEST(Driver, AMotionBeginsWhereTheRobotIs) {
  for (const double by : {0.04, -0.06, 0.2, std::nan("")}) {
    Displaced driver(by);
    const json answer = speak(driver, {kBegin, move_of(trajectory())}).at(1);
    EXPECT_EQ(answer.contains("done"), by == 0.04) << answer;
    if (by != 0.04) {
      EXPECT_TRUE(answer.value("failed", "").starts_with("the trajectory begins elsewhere"));
    }
  }
  Displaced wide(0.2, 0.3);
  EXPECT_TRUE(speak(wide, {kBegin, move_of(trajectory())}).at(1).contains("done"));
  // With what it was told last it is compared exactly, though it says itself where it is.
  json elsewhere = trajectory();
  elsewhere["points"][0]["positions"] = {0.0, 1.001};
  Displaced driver(0);
  EXPECT_TRUE(speak(driver, {kBegin, move_of(elsewhere)}).at(1).contains("failed"));
  Displaced again(0);
  const auto answers = speak(again, {kBegin, move_of(trajectory()), move_of(trajectory())});
  EXPECT_TRUE(answers.at(2).contains("failed")) << "it has come to the end, as it was told";
}

/// Does neither move nor know where it is.
class Lost : public Recorder {
 protected:
  std::optional<Values> where(const std::string&) override {
    if (!calls.empty() && moved_) throw Failure("no encoder answers");
    return std::nullopt;
  }
  std::vector<ExecutedSample> move(const std::string&, const Motion&) override {
    moved_ = true;
    throw Failure("a fuse has blown");
  }

 private:
  bool moved_ = false;
};

TEST(Driver, AFailureIsAnsweredThoughItIsNotKnownWhere) {
  Lost driver;
  EXPECT_EQ(speak(driver, {kBegin, move_of(trajectory())}).at(1),
            json({{"failed", "a fuse has blown"}, {"id", 2}}));
}

}  // namespace
}  // namespace kaboum::driver
