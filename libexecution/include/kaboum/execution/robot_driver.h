#pragma once

#include <kaboum/execution/simulation.h>
#include <kaboum/judge/cell.h>
#include <kaboum/motion/trajectory.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kaboum::execution {

/// Who moves the robots of a plan, and what is expected of it.
struct DriverOptions {
  std::string command = {};  ///< of the shell: a program that speaks the driver's protocol
  /// A run that is repeated from its journal instead: what it was told has to be the same, and what
  /// it answered is taken from there. Empty: the command.
  std::string replayed = {};
  /// Every message is written into this file as it comes, and what the plan is at; empty: none.
  std::string journal = {};
  /// Is told every line of the journal as well, by the thread of the run: it must not wait.
  std::function<void(const std::string& line)> noted = {};
  double most_seconds = 10;  ///< for an answer, beside the time of what it is asked to do. > 0 [s]
  double rate = 100;         ///< points of a trajectory that are sent. > 0 [1/s]
  /// How far each joint may be from where it is told to be when a driver says that it is done. > 0
  /// [rad, length]
  double tracking = 0.01;
  std::size_t retries = 1;  ///< of what has failed without a change of the world
};

/// Why a driver is not told anything more: the robots are to stand still then.
class DriverStop : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t {
    Failed,       ///< it says that it could not do something
    Ended,        ///< its program ended
    Late,         ///< it did not answer in time; its program was ended
    Nonsense,     ///< it answered what is no answer, or what nobody asked
    Elsewhere,    ///< a robot is not where it was told to go
    Uncertified,  ///< what it would be told next is not certified
    Journal       ///< what it is told cannot be written into the journal
  };
  DriverStop(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};
const char* name_of(DriverStop::Kind kind);

/// A trajectory as a driver is told it, in JSON: what takes the time of telling a motion.
std::string told_trajectory(const robot::Robot& robot, const motion::Trajectory& trajectory);

/// How fingers of a gripper close on something, or open from it: what is certified of them is so
/// wherever each joint is between the two, and within `within` of that, in any combination.
struct FingerMotion {
  std::string gripper;
  std::vector<std::string> joint_names;
  std::vector<std::uint32_t> variables;  ///< of the robot, as the joints
  std::vector<double> from, to;          ///< of each joint [rad or length]
  double within = 0;                     ///< how far joints may be off while it holds something
  std::vector<std::string> pads;         ///< links that alone may touch it
  double force = 0;                      ///< that joints close with, at most; 0: not stated
};

/// A robot driver: another program that moves robots, real or simulated ones, and senses. It is
/// told one thing at a time by a line of JSON, and answers by one (docs/planning/drivers.md).
///
/// All functions throw DriverStop; nothing is told any more after that. A driver that is not told
/// that the plan has ended is told to stop, at the latest when this ends.
class RobotDriver {
 public:
  /// Starts it, and reads its first line. @param world  outlives it
  /// @throws Error{InvalidInput} for a command that cannot be started, a journal that cannot be
  ///   read; Error{OutputFailed} for a journal that cannot be opened; Error{InvalidArgument} for
  ///   options that are not above 0
  RobotDriver(const world::World& world, const DriverOptions& options);
  ~RobotDriver();
  RobotDriver(const RobotDriver&) = delete;
  RobotDriver& operator=(const RobotDriver&) = delete;

  /// Says where everything is. A robot that says that it is elsewhere stops all.
  /// @param held  how objects are held: joints of grippers that hold some are then to be within
  /// what
  ///   their grasps allow
  void begin(const judge::CellState& state,
             const std::vector<std::optional<world::Attachment>>& held = {});
  /// Has joints of grippers that hold something be within what their grasps allow from here on.
  /// @param held  how objects are held
  void require_fingers(const std::vector<std::optional<world::Attachment>>& held);
  /// Says which action is carried out from here on: "grasp(arm, o1)".
  void act(const std::string& action);
  /// @pre the trajectory begins where the robot is. A motion that has failed is told again if the
  ///   driver says that the robot is where it began.
  /// @param executed  gets what the driver says that it has done, tries that failed included, also
  ///   where the motion stops all
  /// @param told  told_trajectory of it
  void move(std::size_t robot, const motion::Trajectory& trajectory, const std::string& told,
            ExecutedMotion& executed);
  /// @param fingers  that close or open with it; none: of a gripper without joints
  void take(std::size_t object, std::size_t robot, std::uint32_t link,
            const FingerMotion& fingers = {});
  void release(std::size_t object, std::size_t robot, const FingerMotion& fingers = {});
  /// @return one of the values, or whatever else was sensed
  std::string sense(const std::string& fact, const std::vector<std::string>& values);
  /// Says that the plan has come to its end. @param end  where the plan has everything then; null:
  ///   nothing was carried out
  void finish(const judge::CellState* end);

  /// Whether there is a journal, or somebody who is told its lines.
  [[nodiscard]] bool is_noted() const;
  /// Adds to the journal. @param entry  a JSON object with members, without its time
  void note(std::string entry);
  /// Notes that nothing is told any more, and why, unless that was noted.
  void end(const std::string& kind, const std::string& why);
  /// Tells it to stand still and ends its program, at once, unless the plan has come to its end.
  void stop();
  /// Why the journal is not complete; empty: it is, as far as the run has come.
  [[nodiscard]] const std::string& not_noted() const;

  [[nodiscard]] std::uint64_t messages() const;
  [[nodiscard]] double waited() const;         ///< for answers [s]
  [[nodiscard]] double between() const;        ///< from answers to what it was told next [s]
  [[nodiscard]] double most_tracking() const;  ///< largest deviation that was said [rad, length]

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kaboum::execution
