#pragma once

#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/trajectory.h>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kaboum::motion {

struct SpeedProfile;

/// The parameter of a piece, at an instant, and its derivatives by time.
struct Progress {
  std::size_t piece = 0;
  double place = 0, speed = 0, acceleration = 0;
};

/// A path in time, from rest to rest: the mean over a time `span` of a motion along the path of
/// which only velocities and accelerations are limited. So its jerks are limited as well, and where
/// the path is straight all that time, it is on the path
/// (docs/algorithms/motion-planning.md#blended-corners).
class TimeLaw {
 public:
  /// @param pieces  between two stops; at least one
  TimeLaw(std::span<const PathPiece> pieces, const SpeedLimits& limits);

  [[nodiscard]] double duration() const { return slower_ * (time_ + span_); }  ///< [s]
  /// @pre 0 ≤ time ≤ duration
  [[nodiscard]] Instant at(double time) const;
  /// The parameter where it is on one straight piece.
  [[nodiscard]] std::optional<Progress> straight_at(double time) const;
  /// When the motion begins to depend on a piece, and when it no longer does. [s]
  [[nodiscard]] std::pair<double, double> times_of(std::size_t piece) const;

 private:
  /// Stretch of time in which the acceleration of the parameter is constant.
  struct Stretch {
    std::size_t piece = 0;
    double begin = 0;                               ///< [s]
    double place = 0, speed = 0, acceleration = 0;  ///< of the parameter, in its piece
    std::vector<double> q, in, bend;  ///< point at the beginning, derivatives by the parameter
  };
  void set(const SpeedProfile& profile);
  [[nodiscard]] std::size_t stretch_at(double time) const;
  [[nodiscard]] double end_of(std::size_t stretch) const {
    return stretch + 1 < stretches_.size() ? stretches_[stretch + 1].begin : time_;
  }
  [[nodiscard]] Instant moving_at(double time) const;

  std::vector<PathPiece> pieces_;
  std::vector<Stretch> stretches_;
  double time_ = 0;    ///< that the motion takes of which this is the mean
  double span_ = 0;    ///< of which the mean is taken
  double slower_ = 1;  ///< at least 1: all limits are kept if it is slower by that
};

}  // namespace kaboum::motion
