#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Robot drivers: programs that `kaboum-plan run --robot COMMAND` starts and tells what to do, by
/// lines of JSON (docs/planning/drivers.md). kaboum.driver is the same in Python.
namespace kaboum::driver {

/// What a robot says why it could not do something; nothing in the world has changed.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Values of a robot's joints at an instant, and their derivatives by time. [rad or length; s]
struct Instant {
  std::vector<double> q, velocity, acceleration;
};

/// A trajectory as a driver is told it: from rest to rest, maybe through blended corners.
struct Motion {
  std::vector<std::string> joint_names;
  std::vector<double> times;  ///< of the points, from 0 on, growing [s]
  std::vector<Instant> points;

  [[nodiscard]] double duration() const { return times.back(); }  ///< [s]
  /// By the polynomials of degree 5 through the points: certified, as straight lines between them
  /// are. Before the start and after the end: there, at rest. [s]
  [[nodiscard]] Instant at(double time) const;
};

/// A robot where a plan begins.
struct Robot {
  std::vector<std::string> joint_names;
  std::vector<double> q;
};

/// How a gripper with joints closes or opens. Each joint stops where the pads touch, at most
/// `within` from `to`.
struct Gripper {
  std::string name;
  std::vector<std::string> joint_names;
  std::vector<double> from, to;   ///< of the joints [rad or length]
  double within = 0;              ///< [rad or length]
  std::vector<std::string> pads;  ///< links that alone may touch what it holds
  double force = 0;               ///< of each joint, at most; 0: not stated [N or N m]
};

/// Where an object is: at a pose, held by a robot, or away.
struct Place {
  std::optional<std::array<std::array<double, 4>, 3>> pose;  ///< rows, from the object to the world
  std::string held_by;
  bool away = false;
};

/// What a robot has really done: its joints at a time from the start of a motion. [s]
struct ExecutedSample {
  double time = 0;
  std::vector<double> q;
};

/// A robot driver: what is told calls its functions, and what they return or throw is answered.
/// Those that a robot needs are move; take and release, or close, open, attach and detach, which
/// these call; sense; where, if the robot knows where it is; stop. Each may throw Failure.
class Driver {
 public:
  Driver() = default;
  virtual ~Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Speaks with kaboum-plan until the run ends, or nobody reads `out`. stop() is called last,
  /// however that happens. SIGPIPE is ignored from then on.
  /// @throws what a function throws but Failure; std::runtime_error for lines that are none
  void run(std::istream& in, std::ostream& out);

 protected:
  /// Called first.
  virtual void begin(const std::map<std::string, Robot>& robots,
                     const std::map<std::string, Place>& objects);
  /// What follows belongs to this action: "grasp(arm, o1)".
  virtual void act(const std::string& action);
  /// Moves a robot along a motion, and comes back when it stands.
  /// @return how the joints really moved; empty: not known
  virtual std::vector<ExecutedSample> move(const std::string& robot, const Motion& motion) = 0;
  /// Holds an object by a link. Another robot may hold it until it releases it; what is mounted on
  /// a held object comes with it. Here: close, unless that link holds something, and attach.
  virtual void take(const std::string& robot, const std::string& object, const std::string& link);
  /// Lets an object go. Here: detach, and open, unless that link holds something else.
  virtual void release(const std::string& robot, const std::string& object);
  /// Closes the gripper of a link, or switches its suction on; opens it, or switches it off.
  virtual void close(const std::string& robot, const std::string& link);
  virtual void open(const std::string& robot, const std::string& link);
  /// In take and release, and what they call: of a gripper with joints, how far they close or open;
  /// else null.
  [[nodiscard]] const Gripper* gripper() const { return gripper_ ? &*gripper_ : nullptr; }
  /// An object moves with a link from now on; it does not any more.
  virtual void attach(const std::string& robot, const std::string& object, const std::string& link);
  virtual void detach(const std::string& robot, const std::string& object);
  /// Which of the values a fact has: "isSpillable(o1)", {"true", "false"}. Here it fails.
  virtual std::string sense(const std::string& fact, const std::vector<std::string>& values);
  /// Values of a robot's joints, as they are; nullopt: not known.
  virtual std::optional<std::vector<double>> where(const std::string& robot);
  /// The plan has ended: where it has the objects now.
  virtual void finish(const std::map<std::string, Place>& objects);
  /// Robots are to stand still. Not called of a process that is killed: a robot has to see by
  /// itself that nothing comes any more.
  virtual void stop();

  /// Sends a motion `rate` times a second, each instant when it is due, the end included. None is
  /// left out: where one is late, all that follow are as much later.
  /// @param latest  by which an instant may be late [s]
  /// @throws Failure beyond that; std::invalid_argument unless rate > 0 and latest ≥ 0
  static void follow(const Motion& motion, double rate,
                     const std::function<void(double time, const Instant&)>& send,
                     double latest = 0.05);

  /// How far each joint may be, by where(), from where a motion begins. [rad or length]
  double tracking = 0.05;

 private:
  struct Answers;

  void speak(std::istream& in, std::ostream& out);

  std::map<std::string, Robot> robots_;  ///< and where each was told to be last
  /// Links that hold an object, by object and robot; an empty one is not known.
  std::map<std::pair<std::string, std::string>, std::string> held_;
  std::optional<Gripper> gripper_;
};

}  // namespace kaboum::driver
