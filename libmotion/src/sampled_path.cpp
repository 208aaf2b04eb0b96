// Samples of a path over time, decided as they are written.

#include <kaboum/base/error.h>
#include <kaboum/motion/sampled_path.h>

#include <limits>

namespace kaboum::motion {
namespace {

/// More would take minutes to decide and gigabytes to write.
constexpr std::size_t kMostWritten = 5'000'000;

}  // namespace

const robot::Robot& MovingRobot::kinematics() const {
  return checker.world().robots[robot].kinematics;
}

robot::Path parse_path(const std::string& csv, const robot::Robot& robot, AngleUnit unit) {
  const std::string name = "the output";
  robot::Path path = robot::arrange(robot::parse_path_csv(csv, name), robot, name, false, {});
  if (unit == AngleUnit::Degrees) path = robot::from_degrees(std::move(path), robot);
  robot::require_within_limits(path, robot, name);
  return path;
}

void require_free(const MovingRobot& moving, const robot::Path& path, double resolution,
                  const std::string& what,
                  const std::function<void(const std::string&)>& progress) {
  world::MotionOptions options;
  options.resolution = 1e-3 * resolution;
  options.most_intervals = std::numeric_limits<std::size_t>::max();
  options.progress = progress;
  const world::MotionAnswer motion =
      check_motion(moving.checker, moving.state, moving.robot, path, options);
  if (motion.outcome == world::MotionAnswer::Outcome::Free) {
    const ConstraintAnswer kept = check_constraints(moving.checker.world().robots[moving.robot],
                                                    path, moving.constraints, options);
    if (kept.outcome == ConstraintAnswer::Outcome::Kept) return;
    throw Error(ErrorCode::LimitReached,
                what + ", rounded, do not keep a constraint for certain: " +
                    describe(kept, moving.constraints) + "; allow a little more");
  }
  const world::World& world = moving.checker.world();
  const std::string pair = motion.contact ? ": " + world.name_of(motion.contact->items[0]) +
                                                " and " + world.name_of(motion.contact->items[1])
                                          : "";
  throw Error(ErrorCode::LimitReached, what + " pass too near to be certified" + pair +
                                           "; have the path found with a smaller «resolution»");
}

SampledPath sample_path(const MovingRobot& moving, const robot::Path& path,
                        const TrajectoryOptions& options, double resolution, AngleUnit unit,
                        const std::function<void(const std::string&)>& progress) {
  SpeedLimits limits = speed_limits(options, moving.kinematics());
  Trajectory trajectory(path, limits, options.rate,
                        options.time_optimal ? Profile::Trapezoid : Profile::Quintic);
  if (trajectory.samples() > kMostWritten)
    throw Error(ErrorCode::LimitReached,
                "the trajectory has " + std::to_string(trajectory.samples()) + " samples in " +
                    std::to_string(trajectory.duration()) + " s, more than " +
                    std::to_string(kMostWritten) + ": give a lower «rate» or higher limits");
  std::string csv = to_csv(trajectory, moving.kinematics(), unit);
  require_free(moving, parse_path(csv, moving.kinematics(), unit), resolution, "the samples",
               progress);
  return {std::move(trajectory), std::move(limits), std::move(csv)};
}

}  // namespace kaboum::motion
