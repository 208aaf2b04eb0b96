#pragma once

#include <kaboum/kinematics/constraint.h>
#include <kaboum/world/motion_check.h>

#include <span>
#include <string>
#include <vector>

/// Constraints that motions keep at every instant. docs/algorithms/motion-planning.md,
/// "Constraints that are kept".
namespace kaboum::motion {

/// A relation of a feature that moves with a link of a robot to one that stays, to be kept within
/// tolerances. Directions that are to be parallel keep the sense that they have at the start.
struct PathConstraint {
  std::string name;  ///< in messages
  kinematics::Relation relation = kinematics::Relation::Coincident;
  std::uint32_t link = 0;       ///< of the robot
  kinematics::Feature moving;   ///< in the link's frame
  kinematics::Feature resting;  ///< in the world
  double value = 0;             ///< of a distance [length] or an angle [rad]
  double within = 1e-3;         ///< [length]
  double within_angle = 0.02;   ///< [rad]
};

/// True if of each constraint's features one moves with the robot, or with what it carries, and the
/// other stays; of the preferred ones, too.
bool is_of_motion(const world::World& world, const world::WorldState& state, std::size_t robot,
                  const world::ConstraintSet& set);

/// The constraints of a set, for motions of one robot while all else stays. Of two lines or planes
/// that coincide, the one that moves has its point within the tolerance of the other.
/// @param preferred  so many of those that the set prefers are among them, at most
/// @throws Error{InvalidArgument} unless is_of_motion, and as require_keepable.
std::vector<PathConstraint> path_constraints(const world::World& world,
                                             const world::WorldState& state, std::size_t robot,
                                             const world::ConstraintSet& set,
                                             std::size_t preferred = 0);

/// The constraint of an object that a link carries: it leans by no more than an angle from how it
/// stands in the scene.
PathConstraint upright_constraint(const world::World& world, const world::Attachment& held,
                                  std::size_t object, double within_angle);

/// What a robot keeps because of what it carries: world::Object::upright.
std::vector<PathConstraint> carried_constraints(const world::World& world,
                                                const world::WorldState& state, std::size_t robot);

/// @throws Error{InvalidArgument} for relations that are not defined (kinematics::require_valid), a
///   tolerance that is not above 0, a link that the robot lacks, and where a line or a plane moves
///   and is to hold a point that stays, or a plane a line: these are not decided.
void require_keepable(const PathConstraint& constraint, const robot::Robot& robot);

/// A constraint between frames: of a link, and of the world.
kinematics::Constraint kinematics_constraint(const PathConstraint& constraint);

/// Answer to whether constraints are kept at every instant of a path.
struct ConstraintAnswer {
  enum class Outcome {
    Kept,      ///< by all, for certain
    Broken,    ///< by `constraint` at the place, for certain
    Undecided  ///< there: it touches its tolerance, or a limit was reached
  };
  Outcome outcome = Outcome::Kept;
  std::size_t segment = 0;  ///< from waypoint i to i + 1
  double share = 0;         ///< of the segment
  std::size_t constraint = 0;
  double deviation = 0;       ///< there [length or rad]
  bool of_direction = false;  ///< the deviation is an angle
  std::size_t instants = 0;   ///< that were looked at
  std::vector<double>
      parts{};  ///< largest deviation seen of each constraint, in parts of what is allowed
};

/// "kept", "broken", "undecided".
const char* name_of(ConstraintAnswer::Outcome outcome);

/// Decides whether a robot keeps constraints at every instant of a path of straight segments of
/// joint values. A stretch of a segment keeps one when its ends do with the room that the second
/// derivative of the motion may take between them; other stretches are halved.
/// @param options  its progress is told, and undecided is the answer at most_intervals instants
/// @pre path_constraints made the constraints, or require_keepable was asked of them; each waypoint
///   has a finite value per variable.
ConstraintAnswer check_constraints(const world::RobotModel& robot, const robot::Path& path,
                                   std::span<const PathConstraint> constraints,
                                   const world::MotionOptions& options = {});

/// One line of what breaks a constraint: "'upright' is off by 0.3 rad, 0.05 rad are allowed".
std::string describe(const ConstraintAnswer& answer, std::span<const PathConstraint> constraints);

}  // namespace kaboum::motion
