// Samples of a path over time, decided as they are written.

#include <kaboum/base/error.h>
#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/sampled_path.h>

#include <cmath>
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

namespace {

/// Place at which a path is not certainly free or does not certainly keep the constraints.
struct Fault {
  std::size_t segment = 0;
  double share = 0;
  std::string what;  ///< "… pass too near to be certified"
};

std::optional<Fault> find_fault(const MovingRobot& moving, const robot::Path& path,
                                double resolution,
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
    if (kept.outcome == ConstraintAnswer::Outcome::Kept) return std::nullopt;
    return Fault{kept.segment, kept.share,
                 ", rounded, do not keep a constraint for certain: " +
                     describe(kept, moving.constraints) + "; allow a little more"};
  }
  const world::World& world = moving.checker.world();
  const std::string pair = motion.contact ? ": " + world.name_of(motion.contact->items[0]) +
                                                " and " + world.name_of(motion.contact->items[1])
                                          : "";
  return Fault{motion.segment, motion.share,
               " pass too near to be certified" + pair +
                   "; have the path found with a smaller «resolution»"};
}

/// Smaller by a half; left out after kMostHalvings.
void shrink(double& blend, double asked) {
  constexpr int kMostHalvings = 5;
  blend /= 2;
  if (blend < asked / (1 << kMostHalvings)) blend = 0;
}

/// The curve of a blend by straight lines between some of its points.
robot::Path polyline_of(const PathPiece& blend) {
  constexpr int kLines = 16;
  robot::Path out;
  for (int k = 0; k <= kLines; ++k) out.push_back(blend.at(blend.length * k / kLines).q);
  return out;
}

/// Blends that are free by themselves, as far as some of their points tell: each the largest of
/// what is asked for, a half of it, and so on. Certifies nothing: all samples are looked at after
/// it.
std::vector<double> likely_blends(const MovingRobot& moving, const robot::Path& path,
                                  const SpeedLimits& limits, double asked, double resolution,
                                  const std::function<void(const std::string&)>& progress) {
  std::vector<double> blends(path.size(), asked);
  blends.front() = blends.back() = 0;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<double> found(path.size(), 0);
    const BlendedPath curve(path, blends, limits.velocity);
    for (const PathPiece& piece : curve.pieces()) {
      if (!piece.is_blend) continue;
      double& blend = found[piece.waypoint];
      blend = blends[piece.waypoint];
      if (!find_fault(moving, polyline_of(piece), resolution, progress)) continue;
      shrink(blend, asked);
      changed = true;
    }
    blends = found;
  }
  return blends;
}

/// The waypoint, of those with blends, that is passed next to a time.
std::optional<std::size_t> nearest_blend(const Trajectory& trajectory,
                                         const std::vector<double>& blends, double time) {
  std::optional<std::size_t> out;
  const auto apart = [&](std::size_t i) { return std::abs(trajectory.time_at(i) - time); };
  for (std::size_t i = 0; i < blends.size(); ++i)
    if (blends[i] > 0 && (!out || apart(i) < apart(*out))) out = i;
  return out;
}

void require_few(const Trajectory& trajectory) {
  if (trajectory.samples() > kMostWritten)
    throw Error(ErrorCode::LimitReached,
                "the trajectory has " + std::to_string(trajectory.samples()) + " samples in " +
                    std::to_string(trajectory.duration()) + " s, more than " +
                    std::to_string(kMostWritten) + ": give a lower «rate» or higher limits");
}

}  // namespace

void require_free(const MovingRobot& moving, const robot::Path& path, double resolution,
                  const std::string& what,
                  const std::function<void(const std::string&)>& progress) {
  if (const auto fault = find_fault(moving, path, resolution, progress))
    throw Error(ErrorCode::LimitReached, what + fault->what);
}

SampledPath sample_path(const MovingRobot& moving, const robot::Path& path,
                        const TrajectoryOptions& options, double resolution, AngleUnit unit,
                        const std::function<void(const std::string&)>& progress) {
  const SpeedLimits limits = speed_limits(options, moving.kinematics());
  std::vector<double> blends, between(limits.velocity.size(), 0);
  if (options.blend > 0 && !path.empty()) {
    blends = likely_blends(moving, path, limits, options.blend, resolution, progress);
    for (std::size_t j = 0; j < between.size(); ++j)
      between[j] = limits.acceleration[j] / (8 * options.rate * options.rate);
  }
  while (true) {
    Trajectory trajectory =
        blends.empty() ? Trajectory(path, limits, options.rate,
                                    options.time_optimal ? Profile::Trapezoid : Profile::Quintic)
                       : Trajectory(path, blends, limits, options.rate);
    require_few(trajectory);
    std::string csv = to_csv(trajectory, moving.kinematics(), unit);
    const auto fault =
        find_fault(moving, parse_path(csv, moving.kinematics(), unit), resolution, progress);
    if (!fault) return {std::move(trajectory), limits, std::move(csv), blends, between};
    const double time = (static_cast<double>(fault->segment) + fault->share) / options.rate;
    const auto blend = nearest_blend(trajectory, blends, time);
    if (!blend) throw Error(ErrorCode::LimitReached, "the samples" + fault->what);
    shrink(blends[*blend], options.blend);
  }
}

}  // namespace kaboum::motion
