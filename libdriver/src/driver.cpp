// A robot driver's side of the lines: read, looked at, handed to functions, answered.

#include <kaboum/driver/driver.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <thread>

namespace kaboum::driver {
namespace {

using nlohmann::json;

constexpr double kAtRest = 1e-9;  // [rad/s or length/s]

/// Polynomial of degree 5 of a joint between two points, by the share u of the time h.
void interpolate(const Instant& a, const Instant& b, std::size_t j, double u, double h,
                 Instant& out) {
  const double d = b.q[j] - a.q[j], v0 = a.velocity[j] * h, v1 = b.velocity[j] * h,
               a0 = a.acceleration[j] * h * h, a1 = b.acceleration[j] * h * h;
  const double c3 = 10 * d - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1,
               c4 = -15 * d + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
               c5 = 6 * d - 3 * (v0 + v1) + 0.5 * (a1 - a0);
  out.q.push_back(a.q[j] + u * (v0 + u * (0.5 * a0 + u * (c3 + u * (c4 + u * c5)))));
  out.velocity.push_back((v0 + u * (a0 + u * (3 * c3 + u * (4 * c4 + u * 5 * c5)))) / h);
  out.acceleration.push_back((a0 + u * (6 * c3 + u * (12 * c4 + u * 20 * c5))) / (h * h));
}

Motion motion_of(const json& trajectory) {
  Motion out;
  out.joint_names = trajectory.at("joint_names").get<std::vector<std::string>>();
  for (const json& p : trajectory.at("points")) {
    out.times.push_back(p.at("time_from_start").get<double>());
    out.points.push_back({p.at("positions").get<std::vector<double>>(),
                          p.at("velocities").get<std::vector<double>>(),
                          p.at("accelerations").get<std::vector<double>>()});
    for (const auto* row :
         {&out.points.back().q, &out.points.back().velocity, &out.points.back().acceleration})
      if (row->size() != out.joint_names.size())
        throw Failure("this is no trajectory: it has a number for each joint at each time");
  }
  if (out.times.empty() || out.times.front() != 0 ||
      std::ranges::adjacent_find(out.times, std::greater_equal()) != out.times.end())
    throw Failure("this is no trajectory: its times grow from 0 on");
  const auto moves = [](const Instant& p) {
    return std::ranges::any_of(p.velocity, [](double v) { return !(std::abs(v) <= kAtRest); });
  };
  if (moves(out.points.front()) || moves(out.points.back()))
    throw Failure("this is no trajectory: it begins and ends at rest");
  return out;
}

std::map<std::string, Place> places_of(const json& objects) {
  std::map<std::string, Place> out;
  for (const auto& [name, entry] : objects.items()) {
    Place& place = out[name];
    place.away = entry.contains("away");
    place.held_by = entry.value("held_by", "");
    if (entry.contains("pose"))
      place.pose = entry["pose"].get<std::array<std::array<double, 4>, 3>>();
  }
  return out;
}

}  // namespace

Instant Motion::at(double time) const {
  if (time <= 0 || time >= duration()) {
    const std::vector<double> rest(joint_names.size(), 0);
    return {(time <= 0 ? points.front() : points.back()).q, rest, rest};
  }
  const auto next = std::ranges::upper_bound(times, time);
  const auto k = static_cast<std::size_t>(next - times.begin()) - 1;
  const double h = times[k + 1] - times[k], u = (time - times[k]) / h;
  Instant out;
  for (std::size_t j = 0; j < joint_names.size(); ++j)
    interpolate(points[k], points[k + 1], j, u, h, out);
  return out;
}

/// What a driver answers.
struct Driver::Answers {
  Driver& driver;

  [[nodiscard]] std::string robot_of(const json& message) const {
    std::string name = message.at("robot");
    if (!driver.robots_.contains(name)) throw Failure("there is no robot '" + name + "'");
    return name;
  }

  json begin(const json& message) const {
    driver.robots_.clear();
    driver.held_.clear();
    for (const auto& [name, robot] : message.at("robots").items())
      driver.robots_[name] = {robot.at("joint_names").get<std::vector<std::string>>(),
                              robot.at("q").get<std::vector<double>>()};
    const std::map<std::string, Place> objects = places_of(message.at("objects"));
    for (const auto& [name, place] : objects)
      if (!place.held_by.empty()) driver.held_[{name, place.held_by}] = "";
    driver.begin(driver.robots_, objects);
    json out = {{"done", true}};
    for (const auto& [name, robot] : driver.robots_)
      if (const auto q = driver.where(name)) out["q"][name] = *q;
    return out;
  }

  json move(const json& message) const {
    const std::string name = robot_of(message);
    Robot& robot = driver.robots_[name];
    Motion motion;
    try {
      motion = motion_of(message.at("trajectory"));
    } catch (const json::exception& e) {
      throw Failure(std::string("this is no trajectory: ") + e.what());
    }
    if (motion.joint_names != robot.joint_names)
      throw Failure("joints in another order than when it began");
    if (motion.points.front().q != robot.q) throw Failure("the trajectory begins elsewhere");
    if (const auto is = driver.where(name)) {
      if (is->size() != robot.q.size()) throw Failure("where it is has another number of joints");
      for (std::size_t j = 0; j < is->size(); ++j)
        if (!(std::abs((*is)[j] - robot.q[j]) <= driver.tracking))
          throw Failure("the trajectory begins elsewhere: joint " + robot.joint_names[j] + " is " +
                        json(std::abs((*is)[j] - robot.q[j])).dump() + " away");
    }
    const std::vector<ExecutedSample> executed = driver.move(name, motion);
    robot.q = motion.points.back().q;
    const auto q = driver.where(name);
    json out = {{"done", true}};
    if (q) out["q"] = *q;
    for (const ExecutedSample& sample : executed) {
      json& row = out["executed"].emplace_back(json::array({sample.time}));
      for (const double x : sample.q) row.push_back(x);
    }
    return out;
  }

  /// What a message says of a gripper, until it is answered or has failed.
  struct GripperMessage {
    GripperMessage(const Answers& answers, const json& message, const std::string& robot)
        : driver(answers.driver) {
      answers.read_gripper(message, robot);
    }
    ~GripperMessage() { driver.gripper_.reset(); }
    GripperMessage(const GripperMessage&) = delete;
    GripperMessage& operator=(const GripperMessage&) = delete;
    Driver& driver;
  };

  json take(const json& message) const {
    const std::string robot = robot_of(message), object = message.at("object"),
                      link = message.at("link");
    if (driver.held_.contains({object, robot})) throw Failure(object + " is held already");
    const GripperMessage gripper(*this, message, robot);
    driver.take(robot, object, link);
    driver.held_[{object, robot}] = link;
    return moved_fingers(robot);
  }

  json release(const json& message) const {
    const std::string robot = robot_of(message), object = message.at("object");
    if (!driver.held_.contains({object, robot})) throw Failure(object + " is not held by it");
    const GripperMessage gripper(*this, message, robot);
    driver.release(robot, object);
    driver.held_.erase({object, robot});
    return moved_fingers(robot);
  }

  /// What a message says of a gripper with joints.
  void read_gripper(const json& message, const std::string& robot) const {
    driver.gripper_.reset();
    if (!message.contains("gripper")) return;
    const json& g = message["gripper"];
    Gripper out{g.at("name").get<std::string>(),
                g.at("joint_names").get<std::vector<std::string>>(),
                g.at("from").get<std::vector<double>>(),
                g.at("to").get<std::vector<double>>(),
                g.value("within", 0.0),
                g.value("pads", std::vector<std::string>()),
                g.value("force", 0.0)};
    const std::vector<std::string>& names = driver.robots_[robot].joint_names;
    for (const std::string& joint : out.joint_names)
      if (std::ranges::find(names, joint) == names.end() ||
          out.to.size() != out.joint_names.size() || out.from.size() != out.joint_names.size())
        throw Failure("there is no joint '" + joint + "', or no value for it, as of the gripper");
    driver.gripper_ = std::move(out);
  }

  /// The joints of the gripper are told to be elsewhere now.
  [[nodiscard]] json moved_fingers(const std::string& name) const {
    json out = {{"done", true}};
    if (!driver.gripper_) return out;
    Robot& robot = driver.robots_[name];
    for (std::size_t k = 0; k < driver.gripper_->joint_names.size(); ++k) {
      const auto joint = std::ranges::find(robot.joint_names, driver.gripper_->joint_names[k]);
      robot.q[static_cast<std::size_t>(joint - robot.joint_names.begin())] = driver.gripper_->to[k];
    }
    if (const auto q = driver.where(name)) out["q"] = *q;
    return out;
  }

  json answer(const json& message) const {
    const std::string what = message.at("do");
    if (what == "begin") return begin(message);
    if (what == "move") return move(message);
    if (what == "take") return take(message);
    if (what == "release") return release(message);
    if (what == "sense")
      return {{"sensed", driver.sense(message.at("fact"), message.at("values"))}};
    if (what == "act")
      driver.act(message.at("action"));
    else if (what == "finish")
      driver.finish(places_of(message.value("objects", json::object())));
    else
      throw Failure("nothing is known of '" + what + "' here");
    return {{"done", true}};
  }

  /// With where the robot is, if a motion has failed and it knows that.
  json failed(const json& message, const Failure& failure) const {
    json out = {{"failed", failure.what()}};
    const std::string robot = message.value("robot", "");
    if (message.at("do") != "move" || !driver.robots_.contains(robot)) return out;
    try {
      if (const auto q = driver.where(robot)) out["q"] = *q;
    } catch (const Failure&) {  // NOLINT(bugprone-empty-catch) it does not know that either
    }
    return out;
  }
};

void Driver::run(std::istream& in, std::ostream& out) {
#ifdef SIGPIPE
  std::signal(SIGPIPE, SIG_IGN);  // NOLINT(cert-err33-c) who reads no more is seen by `out`
#endif
  try {
    speak(in, out);
  } catch (...) {
    try {
      stop();
    } catch (...) {  // NOLINT(bugprone-empty-catch) the first one is told of
    }
    throw;
  }
  stop();
}

void Driver::speak(std::istream& in, std::ostream& out) {
  const Answers answers{*this};
  out << R"({"kaboum_driver": 1})" << std::endl;  // NOLINT(performance-avoid-endl)
  for (std::string line; out && std::getline(in, line);) {
    const json message = json::parse(line, nullptr, false);
    if (!message.is_object() || !message.contains("do"))
      throw std::runtime_error("what kaboum-plan told is no message");
    if (message["do"] == "stop") break;
    if (!message.contains("id")) throw std::runtime_error("what kaboum-plan told has no id");
    json answer;
    try {
      answer = answers.answer(message);
    } catch (const Failure& failure) {
      answer = answers.failed(message, failure);
    }
    answer["id"] = message["id"];
    out << answer.dump(-1, ' ', false, json::error_handler_t::replace)
        << std::endl;  // NOLINT(performance-avoid-endl)
  }
}

void Driver::begin(const std::map<std::string, Robot>& /*robots*/,
                   const std::map<std::string, Place>& /*objects*/) {}
void Driver::act(const std::string& /*action*/) {}

void Driver::take(const std::string& robot, const std::string& object, const std::string& link) {
  if (std::ranges::none_of(
          held_, [&](const auto& h) { return h.first.second == robot && h.second == link; }))
    close(robot, link);
  attach(robot, object, link);
}

void Driver::release(const std::string& robot, const std::string& object) {
  const std::string link = held_.at({object, robot});
  detach(robot, object);
  if (std::ranges::none_of(held_, [&](const auto& h) {
        return h.first.first != object && h.first.second == robot && h.second == link;
      }))
    open(robot, link);
}

void Driver::close(const std::string& /*robot*/, const std::string& /*link*/) {}
void Driver::open(const std::string& /*robot*/, const std::string& /*link*/) {}
void Driver::attach(const std::string& /*robot*/, const std::string& /*object*/,
                    const std::string& /*link*/) {}
void Driver::detach(const std::string& /*robot*/, const std::string& /*object*/) {}

std::string Driver::sense(const std::string& fact, const std::vector<std::string>& /*values*/) {
  throw Failure("nothing here senses " + fact);
}

std::optional<std::vector<double>> Driver::where(const std::string& /*robot*/) {
  return std::nullopt;
}
void Driver::finish(const std::map<std::string, Place>& /*objects*/) {}
void Driver::stop() {}

void Driver::follow(const Motion& motion, double rate,
                    const std::function<void(double time, const Instant&)>& send, double latest) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  if (!(rate > 0) || !std::isfinite(rate) || !(latest >= 0))
    throw std::invalid_argument("a rate is above 0, and a delay not below");
  Clock::time_point due = Clock::now();
  for (double k = 0, time = 0;; ++k) {
    const double next = std::min(k / rate, motion.duration());
    due += std::chrono::duration_cast<Clock::duration>(Seconds(next - time));
    time = next;
    std::this_thread::sleep_until(due);
    const Clock::time_point now = Clock::now();
    if (const double late = Seconds(now - due).count(); late > latest)
      throw Failure("a setpoint was " + json(late).dump() + " s late");
    due = now;  // what follows is as much later
    send(time, motion.at(time));
    if (time >= motion.duration()) return;
  }
}

}  // namespace kaboum::driver
