// Samples of a path over time, decided as they are written.

#include <kaboum/base/error.h>
#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/sampled_path.h>

#include <cmath>
#include <limits>

#include "constraint_bands.h"

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

/// Decides paths of a robot, and stretches of them with room about the lines.
class Decider {
 public:
  /// @param path  its start tells the senses of directions that are to stay parallel
  Decider(const MovingRobot& moving, const robot::Path& path, double resolution,
          const std::function<void(const std::string&)>& progress)
      : moving_(moving),
        model_(moving.checker.world().robots[moving.robot]),
        bands_(bands_of(moving.constraints, model_, path.front())) {
    options_.resolution = 1e-3 * resolution;
    options_.most_intervals = std::numeric_limits<std::size_t>::max();
    options_.progress = progress;
  }

  /// @param around  room about the lines: MotionOptions::around
  std::optional<Fault> find_fault(const robot::Path& path, const std::vector<double>& around = {}) {
    options_.around = moving_.around;
    if (options_.around.empty()) options_.around = around;
    for (std::size_t i = 0; i < around.size() && !moving_.around.empty(); ++i)
      options_.around[i] += around[i];
    const world::MotionAnswer motion =
        check_motion(moving_.checker, moving_.state, moving_.robot, path, options_);
    if (motion.outcome == world::MotionAnswer::Outcome::Free) {
      const ConstraintAnswer kept =
          check_bands(model_, bands_, moving_.constraints.size(), path, options_);
      if (kept.outcome == ConstraintAnswer::Outcome::Kept) return std::nullopt;
      return Fault{kept.segment, kept.share,
                   ", rounded, do not keep a constraint for certain: " +
                       describe(kept, moving_.constraints) + "; allow a little more"};
    }
    const world::World& world = moving_.checker.world();
    const std::string pair = motion.contact ? ": " + world.name_of(motion.contact->items[0]) +
                                                  " and " + world.name_of(motion.contact->items[1])
                                            : "";
    return Fault{motion.segment, motion.share,
                 " pass too near to be certified" + pair +
                     "; have the path found with a smaller «resolution»"};
  }

  /// @param samples  of the trajectory, as they are read
  std::optional<Fault> find_fault(const Trajectory& trajectory, const robot::Path& samples,
                                  const std::vector<double>& room) {
    std::size_t done = 0;
    const auto look = [&](std::size_t from, std::size_t to, bool bent) -> std::optional<Fault> {
      const auto at = [&](std::size_t k) {
        return samples.begin() + static_cast<std::ptrdiff_t>(k);
      };
      auto fault =
          find_fault(robot::Path(at(from), at(to) + 1), bent ? room : std::vector<double>());
      if (fault) fault->segment += from;
      return fault;
    };
    for (const auto& [first, last] : trajectory.bends()) {
      if (first > done)
        if (auto fault = look(done, first, false)) return fault;
      if (auto fault = look(first, last, true)) return fault;
      done = last;
    }
    if (done + 1 == samples.size() && done > 0) return std::nullopt;
    return look(done, samples.size() - 1, false);
  }

 private:
  const MovingRobot& moving_;
  const world::RobotModel& model_;
  std::vector<ConstraintBand> bands_;
  world::MotionOptions options_;
};

/// Smaller by a quarter; left out below 1/32 of what was asked for.
void shrink(double& blend, double asked) {
  constexpr double kSmaller = 0.75, kSmallest = 1.0 / 32;
  blend *= kSmaller;
  if (blend < asked * kSmallest) blend = 0;
}

/// The curve of a blend by straight lines between some of its points.
robot::Path polyline_of(const PathPiece& blend) {
  constexpr int kLines = 16;
  robot::Path out;
  for (int k = 0; k <= kLines; ++k) out.push_back(blend.at(blend.length * k / kLines).q);
  return out;
}

/// Blends that are free by themselves, as far as some of their points tell: each the largest of
/// what is asked for, a quarter less, and so on. Certifies nothing: all samples are looked at after
/// it.
std::vector<double> likely_blends(Decider& decider, const robot::Path& path,
                                  const SpeedLimits& limits, const std::vector<double>& asked) {
  std::vector<double> blends = asked;
  blends.front() = blends.back() = 0;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<double> found(path.size(), 0);
    const BlendedPath curve(path, blends, limits.velocity);
    for (const PathPiece& piece : curve.pieces()) {
      if (!piece.is_blend) continue;
      double& blend = found[piece.waypoint];
      blend = blends[piece.waypoint];
      if (!decider.find_fault(polyline_of(piece))) continue;
      shrink(blend, asked[piece.waypoint]);
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

/// The largest blends of which all is certified, and the fault of the trajectory where none are.
/// @param read  the samples of a trajectory, as they are sent or written
std::optional<Fault> settle_blends(Decider& decider, const robot::Path& path,
                                   const SpeedLimits& limits, std::vector<double> asked,
                                   double rate, std::vector<double>& blends,
                                   const std::function<robot::Path(const Trajectory&)>& read) {
  // Those between others get no more than a half of their segments.
  for (std::size_t i = 2; i + 2 < asked.size(); ++i) asked[i] = std::min(asked[i], 0.5);
  blends = likely_blends(decider, path, limits, asked);
  const std::vector<double> room = room_between_samples(limits, rate);
  while (true) {
    const Trajectory trajectory(path, blends, limits, rate);
    require_few(trajectory);
    auto fault = decider.find_fault(trajectory, read(trajectory), room);
    if (!fault) return std::nullopt;
    const double time = (static_cast<double>(fault->segment) + fault->share) / rate;
    const auto blend = nearest_blend(trajectory, blends, time);
    if (!blend) return fault;
    shrink(blends[*blend], asked[*blend]);
  }
}

}  // namespace

void require_free(const MovingRobot& moving, const robot::Path& path, double resolution,
                  const std::string& what,
                  const std::function<void(const std::string&)>& progress) {
  if (const auto fault = Decider(moving, path, resolution, progress).find_fault(path))
    throw Error(ErrorCode::LimitReached, what + fault->what);
}

std::vector<double> room_between_samples(const SpeedLimits& limits, double rate) {
  std::vector<double> out = limits.acceleration;
  for (double& x : out) x *= 0.1875 / (rate * rate);
  return out;
}

std::optional<std::vector<double>> certified_blends(
    const MovingRobot& moving, const robot::Path& path, const SpeedLimits& limits,
    const std::vector<double>& asked, double rate, double resolution,
    const std::function<void(const std::string&)>& progress) {
  std::vector<double> blends;
  Decider decider(moving, path, resolution, progress);
  const auto samples = [](const Trajectory& trajectory) {
    robot::Path out;
    out.reserve(trajectory.samples());
    for (std::size_t k = 0; k < trajectory.samples(); ++k) out.push_back(trajectory.sample(k));
    return out;
  };
  if (settle_blends(decider, path, limits, asked, rate, blends, samples)) return std::nullopt;
  return blends;
}

SampledPath sample_path(const MovingRobot& moving, const robot::Path& path,
                        const TrajectoryOptions& options, double resolution, AngleUnit unit,
                        const std::function<void(const std::string&)>& progress) {
  const SpeedLimits limits = speed_limits(options, moving.kinematics());
  const robot::Robot& kinematics = moving.kinematics();
  std::string csv;
  const auto read = [&](const Trajectory& trajectory) {
    csv = to_csv(trajectory, kinematics, unit);
    return parse_path(csv, kinematics, unit);
  };
  const auto refuse = [](const Fault& fault) {
    throw Error(ErrorCode::LimitReached, "the samples" + fault.what);
  };
  if (options.blend == 0 || path.empty()) {
    Trajectory trajectory(path, limits, options.rate,
                          options.time_optimal ? Profile::Trapezoid : Profile::Quintic);
    require_few(trajectory);
    const robot::Path samples = read(trajectory);
    if (const auto fault = Decider(moving, samples, resolution, progress).find_fault(samples))
      refuse(*fault);
    return {std::move(trajectory),
            limits,
            std::move(csv),
            {},
            std::vector<double>(limits.velocity.size(), 0)};
  }
  std::vector<double> blends;
  Decider decider(moving, path, resolution, progress);
  if (const auto fault =
          settle_blends(decider, path, limits, std::vector<double>(path.size(), options.blend),
                        options.rate, blends, read))
    refuse(*fault);
  Trajectory trajectory(path, blends, limits, options.rate);
  return {std::move(trajectory), limits, std::move(csv), std::move(blends),
          room_between_samples(limits, options.rate)};
}

}  // namespace kaboum::motion
