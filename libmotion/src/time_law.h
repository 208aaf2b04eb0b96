#pragma once

#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/trajectory.h>

#include <span>
#include <vector>

namespace kaboum::motion {

/// Stretch of time in which the third derivative of the path's parameter is constant.
struct JerkPhase {
  std::size_t piece = 0;
  double time = 0;                                          ///< at its beginning [s]
  double place = 0, speed = 0, acceleration = 0, jerk = 0;  ///< of the parameter, in its piece
};

/// The parameter of a piece, at an instant, and its derivatives by time.
struct Progress {
  std::size_t piece = 0;
  double place = 0, speed = 0, acceleration = 0;
};

/// A path's parameter over time, from rest to rest: a double-S [biagiotti2008, 3.4] on each piece,
/// without acceleration where pieces meet. The limits are kept by bounds of the derivatives of each
/// piece (docs/algorithms/motion-planning.md#blended-corners).
class TimeLaw {
 public:
  /// @param pieces  between two stops
  TimeLaw(std::span<const PathPiece> pieces, const SpeedLimits& limits);

  [[nodiscard]] double duration() const { return duration_; }  ///< [s]
  /// @pre There is a piece; 0 ≤ time ≤ duration
  [[nodiscard]] Progress at(double time) const;
  /// Time at which a piece begins. [s]
  [[nodiscard]] double begin_of(std::size_t piece) const { return begins_.at(piece); }

 private:
  std::vector<JerkPhase> phases_;
  std::vector<double> begins_, lengths_;
  double duration_ = 0;
};

}  // namespace kaboum::motion
