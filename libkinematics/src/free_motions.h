#pragma once

#include <kaboum/base/random.h>
#include <kaboum/kinematics/constraint.h>

#include <functional>
#include <vector>

#include "reach_ball.h"

// What constraints leave free of a tool's pose. Internal to kaboum_kinematics.
namespace kaboum::kinematics {

/// Motions of a tool that keep all of its constraints: turns about and slides along axes of their
/// features. They are found by trying them where the constraints are met.
class FreeMotions {
 public:
  using PoseOf = std::function<Transform(const FrameId&)>;

  FreeMotions() = default;
  /// All that might be free.
  /// @param length  as in `cost`.
  FreeMotions(const std::vector<Constraint>& constraints, const FrameId& tool, double length);

  /// Keeps those that lead from this placement, where the constraints are met, to others where they
  /// are: no cost above `bound`.
  void keep_free(const PoseOf& pose_of, double bound, Random& random);
  /// Keeps as many as are independent of each other at this placement.
  void keep_independent(const PoseOf& pose_of);

  [[nodiscard]] bool empty() const { return motions_.empty(); }

  /// The tool's pose after all motions, one after the other, by random amounts: half-turns with
  /// probability 1/2; turns and slides uniform over what leaves the ball's point in the ball.
  [[nodiscard]] Transform moved(const Transform& tool, const PoseOf& pose_of, const ReachBall& ball,
                                Random& random) const;

 private:
  struct Motion {
    enum class Kind { Turn, Slide, HalfTurn } kind;
    FrameId frame;          ///< that the axis is fixed to
    Vec3 point, direction;  ///< in that frame
  };
  void add(const FrameId& frame, const Feature& feature, Motion::Kind kind);

  std::vector<Constraint> constraints_;
  FrameId tool_;
  double length_ = 1;
  std::vector<Motion> motions_;
};

}  // namespace kaboum::kinematics
