#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/plan/replay.h>
#include <kaboum/world/world.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kaboum::execution {

struct SimulationOptions {
  /// Of all robots; a joint's name is of all that have such a joint. With blends corners are passed
  /// as far as that is certified (docs/algorithms/motion-planning.md#blended-corners).
  motion::TrajectoryOptions motion = {};
  /// Is told now and then what is carried out; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

/// What a robot has really done: the values of its joints, at times from the motion's start.
struct ExecutedSample {
  double time = 0;  ///< [s]
  std::vector<double> q;
};
/// A motion as it was executed.
struct ExecutedMotion {
  double rate = 0;  ///< of the trajectory that was told: see SimulationOptions [1/s]
  std::vector<ExecutedSample> samples = {};
};

/// What was looked at of executed motions, and what was wrong.
struct ExecutedReport {
  std::uint64_t motions = 0, samples = 0;
  std::uint64_t collisions = 0;  ///< samples at which meshes meet
  double longest_gap = 0;        ///< between samples of a motion, and from its ends to them [s]
  double most_strayed = 0;       ///< of a joint from the trajectory at that time [rad, length]
  /// No point of the robot that moved, or of what it held, was farther in a sample from where the
  /// trajectory has it at that time. [length]
  double margin = 0;
};

/// Result of a simulation: what was looked at, and what was wrong.
struct SimulationReport {
  std::uint64_t steps = 0;    ///< nodes carried out, each once for every geometric state
  std::uint64_t motions = 0;  ///< paths of these
  std::uint64_t samples = 0;
  std::uint64_t collisions = 0;        ///< samples at which meshes meet
  std::uint64_t limit_violations = 0;  ///< samples beyond a joint's limits, velocity, acceleration
  std::uint64_t jumps = 0;  ///< things that are not where the plan says, or held without a grasp
  double seconds = 0;       ///< of motion
  double most_velocity = 0, most_acceleration = 0;  ///< as shares of the limits
  double most_jerk = 0;                             ///< likewise, of motions with blends
  std::uint64_t blends = 0;                         ///< corners that were passed without a stop
  std::vector<std::string> problems;                ///< the first twenty, in words
  ExecutedReport executed;

  [[nodiscard]] bool good() const {
    return collisions + limit_violations + jumps + executed.collisions == 0;
  }
  /// With what another simulation looked at.
  SimulationReport& operator+=(const SimulationReport& other);
};

/// A motion as it is sampled: for files of a controller.
using MotionSink =
    std::function<void(const plan::RunStep& step, std::size_t robot, const motion::Trajectory&)>;

struct MotionPart;  // a motion of a payload
class NodeMotions;

/// Carries out the nodes of plans: robots follow the paths that payloads state, from rest to rest
/// along their segments or with blended corners, objects are carried by what holds them, and the
/// exact meshes are looked at in every sample. Contacts, limits (by differences of samples) and
/// whether things end where the plan says they do are counted; nothing of the bounding sets or of
/// what made the plan is asked. What a robot holds can leave the world from its hand, or from where
/// a motion of the node has put it.
class Simulation {
 public:
  /// All arguments outlive it.
  /// @param motions  of the plan, with their blends, as they were told; null: they are certified
  ///   here
  /// @throws Error{InvalidArgument} for options that are not above 0, and names of no joint.
  Simulation(const world::World& world, const judge::Cell& cell, const plan::Model& model,
             const plan::Plan& plan, SimulationOptions options, MotionSink sink = {},
             std::shared_ptr<NodeMotions> motions = {});

  /// One node in one state. Those that were carried out in the same geometric state are skipped.
  /// @param executed  of the node's motions, in their order, where it is known
  void carry_out(const plan::RunStep& step, const std::vector<ExecutedMotion>& executed = {});

  /// A node that was begun and not ended: its motions that were executed, of the last one only what
  /// is known to have been executed. @param executed  not empty
  void begin(const plan::RunStep& step, const std::vector<ExecutedMotion>& executed);

  [[nodiscard]] const SimulationReport& report() const { return report_; }

 private:
  void look_at_node(const plan::RunStep& step, const std::vector<ExecutedMotion>& executed,
                    bool is_done);
  void follow(const MotionPart& part, judge::CellState& state, const plan::RunStep& step,
              const ExecutedMotion* executed);
  void look_at_executed(const ExecutedMotion& executed, const MotionPart& part,
                        judge::CellState state);
  void hold(const MotionPart& part, judge::CellState& state);
  void look(const motion::Trajectory& trajectory, const MotionPart& part, judge::CellState& state);
  /// @param samples  four that follow each other; of the robot is the second
  void count_limits(std::size_t robot, const motion::SpeedLimits& limits,
                    const std::array<std::vector<double>, 4>& samples, bool blended);
  void compare(const judge::CellState& state, const judge::CellState& expected);
  void look_at_pushed(const judge::CellState& state);
  [[nodiscard]] double drop_of(std::size_t object) const;
  [[nodiscard]] double push_gap(const MotionPart& part, std::size_t object) const;
  void say(const std::string& problem);

  const world::World& world_;
  const judge::Cell& cell_;
  const plan::Model& model_;
  const plan::Plan& plan_;
  SimulationOptions options_;
  MotionSink sink_;
  std::shared_ptr<NodeMotions> motions_;
  std::set<std::string> done_;                       ///< nodes with geometric states
  std::string where_;                                ///< for messages
  std::vector<std::optional<std::size_t>> mounted_;  ///< what each object is on, in a node
  /// Sets of constraints that the plan's mates name, by the objects that are mated.
  std::map<std::string, std::set<std::string>> mates_;
  std::set<std::size_t> carried_;              ///< objects that a motion of the node has carried
  std::map<std::size_t, std::string> grasps_;  ///< by which objects are held, in a node
  /// An object that is pushed: the pose that it was first at, and the way that it goes.
  struct Pushed {
    geom::Transform from;
    geom::Vec3 way;
    double drop = 0;  ///< how far it is above what it rests on, at most [length]
    bool wrong = false;
  };
  std::map<std::size_t, Pushed> pushed_;  ///< in a node
  SimulationReport report_;
};

}  // namespace kaboum::execution
