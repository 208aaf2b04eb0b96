#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/sweep/motion.h>

#include <optional>

namespace kaboum::motion {

/// What a constraint asks of one point or direction x that moves with a link:
/// low ≤ |across · (x − center)| ≤ high, in the world.
struct ConstraintBand {
  enum class Measure : std::uint8_t {
    Length,  ///< the norm itself
    Chord,   ///< of unit vectors at an angle: 2 sin(angle / 2)
    Sine     ///< of the angle out of a plane, or off a right angle
  };
  std::size_t constraint = 0;
  std::uint32_t link = 0;
  bool is_direction = false;
  geom::Vec3 own = geom::Vec3::Zero();  ///< x in the link's frame
  geom::Vec3 center = geom::Vec3::Zero();
  Eigen::Matrix3d across = Eigen::Matrix3d::Identity();  ///< a projection
  /// What x is to be near, instead; then low is 0.
  std::optional<kinematics::Surface> surface = {};
  double low = 0, high = 0;
  Measure measure = Measure::Length;
  double value = 0, within = 0;  ///< that the bounds are of [length or rad]

  [[nodiscard]] geom::Vec3 residual(const geom::Transform& link_in_world) const {
    const geom::Vec3 x =
        is_direction ? geom::Vec3(link_in_world.linear * own) : geom::Vec3(link_in_world * own);
    if (surface) return x - nearest_point(*surface, x);
    return across * (x - center);
  }
  /// How far a residual's norm is off. [length or rad]
  [[nodiscard]] double deviation(double norm) const;
};

/// @param start  senses of directions that are to be parallel are those there
std::vector<ConstraintBand> bands_of(std::span<const PathConstraint> constraints,
                                     const world::RobotModel& robot, std::span<const double> start);

/// Decides a straight segment; the answer is added to.
/// @param options  its limit is of all instants of the answer
/// @return whether all bands are kept all along it
bool check_segment(const world::RobotModel& robot, std::span<const ConstraintBand> bands,
                   std::span<const double> from, std::span<const double> to,
                   const world::MotionOptions& options, ConstraintAnswer& answer);

/// Decides all segments of a path.
/// @pre the path has a waypoint
ConstraintAnswer check_bands(const world::RobotModel& robot, std::span<const ConstraintBand> bands,
                             std::size_t constraints, const robot::Path& path,
                             const world::MotionOptions& options);

/// Moves configurations onto constraints: Gauss–Newton with the least change of the variables,
/// damped, within their limits.
class ConstraintProjection {
 public:
  /// Refers to all of them.
  ConstraintProjection(const world::RobotModel& robot, std::span<const PathConstraint> constraints,
                       std::span<const ConstraintBand> bands);

  /// @return whether every deviation is now at most `share` of what is allowed
  bool project(std::vector<double>& q, double share) const;

  /// The largest deviation, in parts of what is allowed.
  [[nodiscard]] double largest(std::span<const geom::Transform> links) const;

 private:
  const world::RobotModel& robot_;
  std::span<const PathConstraint> constraints_;
  std::span<const ConstraintBand> bands_;
};

}  // namespace kaboum::motion
