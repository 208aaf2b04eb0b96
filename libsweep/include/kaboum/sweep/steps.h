#pragma once

#include <kaboum/base/error.h>
#include <kaboum/robot/path.h>
#include <kaboum/sweep/motion.h>

#include <functional>
#include <optional>

namespace kaboum::sweep {

using robot::Path;

/// Rule for the steps along a path. docs/algorithms/swept-volumes.md proves all but Baginski.
enum class StepRule {
  Baginski,     ///< Eq. 4.19; not proved, for comparison; no prismatic joints
  Uniform,      ///< Eq. 4.20 with the robot's largest radius: the same steps for all links
  Subset,       ///< Eq. 4.20 with the body's radius and the joints before it
  SecondOrder,  ///< second derivative bounded joint by joint
  Adaptive,     ///< derivatives of this motion up to the fifth, the sixth bounded; poses as in
                ///< Eq. 4.22
  Balanced,     ///< as Adaptive, round the linear motion nearest to the true one: √2 fewer steps
};

/// A stretch of the path, and the hull that stands for it: every point p of the body is, during the
/// stretch, within `deviation` of the segment from start · p to finish · p.
struct PathInterval {
  std::size_t first_segment, last_segment;  ///< segment i leads from waypoint i to i + 1
  double begin, end;                        ///< where in these, 0 to 1
  Transform start, finish;
  double deviation;  ///< rounded up, errors of kinematics included [length]
};

/// Data that all bodies of a robot share, for the rules Uniform and Baginski: per segment, the
/// radius and the sums of turns and slides.
struct SharedBounds {
  double radius = 0, turn = 0, slide = 0;
};

struct StepOptions {
  StepRule rule = StepRule::Balanced;
  double deviation = 0;              ///< largest allowed, > 0 [length]
  std::optional<double> max_excess;  ///< largest excess() allowed of a piece [length]
  bool merge = true;                 ///< pieces may span waypoints (Adaptive and Balanced)
  std::vector<SharedBounds> shared;  ///< per segment; Uniform and Baginski only
  /// Is told of pieces now and then; what it throws ends the work.
  std::function<void(std::size_t pieces)> progress = {};
};

/// InvalidArgument because no step of the path is short enough for the options.
class NoStepError : public Error {
 public:
  NoStepError()
      : Error(ErrorCode::InvalidArgument,
              "no step is short enough; allow a larger epsilon or reach") {}
};

/// Splits the path into pieces for one body, greedily the longest that the options allow.
/// @param points  whose hull is the body, in the link's frame; not empty.
/// @pre path has at least one waypoint. With one, the result is one piece that does not move.
/// @throws Error{LimitReached} when that takes more than 10^6 pieces; Error{InvalidArgument} for
///   Baginski with prismatic joints, and for max_excess with rules but Adaptive and Balanced;
///   NoStepError when the deviation or max_excess cannot be met.
std::vector<PathInterval> choose_steps(const Robot& robot, std::uint32_t link,
                                       std::span<const Vec3> points, const Path& path,
                                       const StepOptions& options);

/// Distance that the hull of the body's images at both ends of a piece may reach from what the body
/// sweeps in it: deviation + ¼ of the largest |(finish − start)(p − p')|, rounded up. [length]
double excess(const PathInterval& piece, std::span<const Vec3> points);

}  // namespace kaboum::sweep
