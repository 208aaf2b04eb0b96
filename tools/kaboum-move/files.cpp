// The files that kaboum-move writes: waypoints, and samples over time.

#include "files.h"

#include <kaboum/base/error.h>
#include <kaboum/motion/trajectory.h>
#include <kaboum/world/motion_check.h>

#include <limits>

#include "common/check_report.h"

namespace kaboum::tools {
namespace {

using motion::AngleUnit;

AngleUnit unit_of(const MoveOptions& o) {
  return o.degrees ? AngleUnit::Degrees : AngleUnit::Radians;
}

/// What was written, read as any program would.
robot::Path read_back(const std::string& text, const MoveRequest& r, const MoveOptions& o) {
  robot::Path path = robot::arrange(robot::parse_path_csv(text, "the output"), r.kinematics(),
                                    "the output", false, {});
  if (o.degrees) path = robot::from_degrees(std::move(path), r.kinematics());
  robot::require_within_limits(path, r.kinematics(), "the output");
  return path;
}

/// Decides what was read back at every instant.
void require_free(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                  const world::Checker& checker, const char* what) {
  world::MotionOptions options;
  // Finer than for the path: what that has decided is not to be refused for a rounding.
  options.resolution = 1e-3 * o.search.check.resolution;
  options.most_intervals = std::numeric_limits<std::size_t>::max();
  const world::MotionAnswer motion =
      check_motion(checker, initial_state(r.scene.world), r.robot, path, options);
  if (motion.outcome != world::MotionAnswer::Outcome::Free)
    throw Error(ErrorCode::LimitReached,
                std::string(what) +
                    " pass too near to be certified: give a smaller --resolution (" +
                    describe(r.scene.world, motion) + ")");
}

/// Of a file of samples: more would take minutes to certify and gigabytes to write.
constexpr std::size_t kMostSamples = 5'000'000;

}  // namespace

WrittenPath write_path(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                       const world::Checker& checker) {
  WrittenPath out;
  out.csv = motion::to_csv(path, r.kinematics(), unit_of(o));
  out.path = read_back(out.csv, r, o);
  if (out.path == path) return out;
  ensure(o.degrees, "a path is written as another one");
  require_free(r, out.path, o, checker, "--degrees: the waypoints, rounded,");
  return out;
}

Execution execute(const MoveRequest& r, const robot::Path& path, const MoveOptions& o,
                  const world::Checker& checker) {
  const motion::SpeedLimits limits = speed_limits(o, r.kinematics());
  const motion::Trajectory trajectory(
      path, limits, o.rate, o.time_optimal ? motion::Profile::Trapezoid : motion::Profile::Quintic);
  if (trajectory.samples() > kMostSamples)
    throw Error(ErrorCode::LimitReached,
                "--trajectory: " + std::to_string(trajectory.samples()) + " samples in " +
                    std::to_string(trajectory.duration()) + " s, more than " +
                    std::to_string(kMostSamples) + ": give a lower --rate or higher limits");
  Execution out{to_csv(trajectory, r.kinematics(), unit_of(o)), {}};
  require_free(r, read_back(out.csv, r, o), o, checker, "the samples");
  out.report = {{"file", o.trajectory},
                {"rate", o.rate},
                {"samples", trajectory.samples()},
                {"max_velocity", limits.velocity},
                {"max_acceleration", limits.acceleration},
                {"seconds", trajectory.duration()}};
  return out;
}

}  // namespace kaboum::tools
