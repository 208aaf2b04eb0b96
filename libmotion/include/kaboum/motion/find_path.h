#pragma once

#include <kaboum/motion/path_constraint.h>
#include <kaboum/world/motion_check.h>

#include <limits>
#include <span>

/// Motions of robots among things: paths that are certified free at every instant, and how they are
/// executed. docs/algorithms/motion-planning.md.
namespace kaboum::motion {

struct PathOptions {
  std::uint64_t seed = 1;
  /// The search ends after so many steps; counted, not measured, so that the answer is the same on
  /// any machine. About seconds of one core.
  double most_work = 10;
  std::size_t most_nodes = 100'000;  ///< of the search trees
  /// The search ends after this time. It changes no path that is found. [s]
  double most_seconds = std::numeric_limits<double>::infinity();
  /// Number of shortcuts that are tried; 0: the path is as the search found it.
  std::size_t shortcuts = 60;
  std::vector<PathConstraint> constraints = {};  ///< that are kept at every instant
  /// Variables that stay as at the start, as those of fingers that hold something.
  std::vector<std::uint32_t> still = {};
  world::MotionOptions check = {};  ///< its progress is told of the whole search
};

/// Two things that stood in the way, and how often.
struct Blocker {
  std::array<world::Item, 2> items;
  std::size_t times = 0;
};

/// Counts of a search.
struct Spent {
  std::size_t configurations = 0;  ///< that were looked at
  std::size_t motions = 0;         ///< decided at every instant
  std::size_t intervals = 0;       ///< of time, for these
  std::size_t samples = 0;         ///< random configurations that the trees grew towards
  std::size_t nodes = 0;           ///< of the trees
  double work = 0;                 ///< as PathOptions::most_work
};

struct PathAnswer {
  enum class Outcome {
    Found,                  ///< `path` is free at every instant, for certain
    StartOutsideLimits,     ///< `variable` says where
    GoalOutsideLimits,      ///< all goals are; of the first
    StartInContact,         ///< outer sets meet: `contact`
    GoalInContact,          ///< all goals are, or outside the limits; of the first that is
    StartBreaksConstraint,  ///< `broken` says which
    GoalBreaksConstraint,   ///< all goals do that are free and within the limits; of the first
    // No path was found, which does not say that there is none.
    WorkEnded,
    NodesEnded,
    TimeEnded,
  };
  Outcome outcome = Outcome::WorkEnded;
  robot::Path path;       ///< from the start to a goal
  std::size_t goal = 0;   ///< which, when found
  bool straight = false;  ///< the first try, a straight line, was free
  std::optional<world::Contact> contact;
  std::uint32_t variable = 0;
  std::optional<ConstraintAnswer> broken;
  /// Largest deviation from each constraint that was seen on the path, in parts of what is allowed.
  std::vector<double> deviations;
  std::vector<Blocker> blockers;  ///< what was met most often first, at most five
  Spent spent;
};

const char* name_of(PathAnswer::Outcome outcome);

/// A path of straight segments of joint values from `start` to one of `goals`: a straight line if
/// that is free, else by RRT-Connect, made shorter; where constraints are to be kept, its steps are
/// projected onto them. Whatever the search does, a path is returned only when world::check_motion
/// has found the whole of it free at every instant, as it is, and check_constraints that it keeps
/// its constraints. What the robot carries moves with it; all else stays where `state` has it. The
/// same arguments give the same answer, to the bit, unless time ends the search.
///
/// @param goals  one or more, a value per variable each.
/// @throws Error{InvalidArgument} as world::check_motion and require_keepable; for no goals, and
///   limits that are not above 0.
PathAnswer find_path(const world::Checker& checker, const world::WorldState& state,
                     std::size_t robot, const std::vector<double>& start,
                     std::span<const std::vector<double>> goals, const PathOptions& options);

}  // namespace kaboum::motion
