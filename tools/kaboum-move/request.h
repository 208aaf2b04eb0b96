#pragma once

#include <kaboum/motion/find_path.h>
#include <kaboum/world/scene.h>

#include <string>
#include <vector>

#include "common/report.h"
#include "options.h"

/// What kaboum-move is asked for, and what it says of the answer.
namespace kaboum::tools {

struct MoveRequest {
  world::SceneFile scene;
  std::size_t robot = 0;
  std::vector<double> start;
  robot::Path goals;
  std::vector<std::size_t> numbers;  ///< of the goals, as they were given, from 1
  std::vector<motion::PathConstraint> constraints;
  std::vector<std::string> notes;
  std::vector<std::string> unreached;  ///< poses that no configuration reaches, and why
  /// How far joints may be off, as world::MotionOptions::around: those of grippers that hold
  /// something.
  std::vector<double> around;
  bool all_known = true;  ///< there are no other goals than these, for certain

  [[nodiscard]] const world::RobotModel& model() const { return scene.world.robots[robot]; }
  [[nodiscard]] const robot::Robot& kinematics() const { return model().kinematics; }
};

/// @throws Error{InvalidArgument} for values on the command line that do not fit the robot or its
///   limits; Error{InvalidInput} for files.
MoveRequest read_request(const MoveOptions& o);

/// The report, but for the files that are written. Angles are in radians.
Json answer_json(const MoveRequest& r, const motion::PathAnswer& answer, const MoveOptions& o);

/// Why there is no path.
std::string reason(const MoveRequest& r, const motion::PathAnswer& answer);
/// Whether that is certain: an exit code.
int exit_code(const MoveRequest& r, const motion::PathAnswer& answer);

}  // namespace kaboum::tools
