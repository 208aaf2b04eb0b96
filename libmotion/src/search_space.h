#pragma once

#include <kaboum/base/random.h>
#include <kaboum/filter/motion_checker.h>
#include <kaboum/motion/find_path.h>

#include <chrono>
#include <map>

#include "constraint_bands.h"
#include "decided_motions.h"

namespace kaboum::motion {

using Values = std::vector<double>;  ///< one per variable

/// How far the variables of a robot move points of it.
struct Metric {
  Values weight;     ///< per unit of each variable; none is 0
  double range = 1;  ///< what extensions of trees are as long as: the largest weight [length]
};

/// @param state  whose attachments move with the robot
Metric metric_of(const world::Checker& checker, const world::WorldState& state, std::size_t robot);

/// What one thread has for searches, and what that thread's searches leave for the next ones. It
/// changes how long answers take, not what they are.
struct SearchMemory {
  world::Scratch scratch;
  std::optional<filter::MotionChecker> motions;  ///< none: motions are decided exactly
  DecidedMotions decided;
};

/// The configurations of a robot as a search sees them: distances, samples, contacts, and what all
/// that has cost.
class SearchSpace {
 public:
  /// @param start  directions that are to stay parallel have the sense that they have there
  /// @param metric, memory  that are referred to
  SearchSpace(const world::Checker& checker, world::WorldState state, std::size_t robot,
              const Values& start, const PathOptions& options, const Metric& metric,
              SearchMemory& memory);

  /// Samples are drawn within the limits, of joints that turn mostly within half a turn of these.
  void draw_around(const Values& start, std::span<const Values> goals);
  Values sample(Random& random);

  /// Root of the squares of how far the variables move points of the robot [length].
  [[nodiscard]] double distance(const Values& a, const Values& b) const;
  /// Its square. @param a, b  a value per variable
  [[nodiscard]] double squared_distance(const double* a, const double* b) const;
  /// Extensions of trees are as long as this. [length]
  [[nodiscard]] double range() const { return metric_.range; }

  /// The contact at a configuration.
  std::optional<world::Contact> find_contact(const Values& q);
  /// True if a motion checker looks at motions: what looks free is then mostly certain.
  [[nodiscard]] bool decides_motions() const {
    return memory_.motions.has_value() && check_.around.empty();
  }
  /// Whether a motion looks free, which is cheap, and certifies nothing: the end and configurations
  /// on the way, not far from each other; by a motion checker, what vector code leaves open.
  bool looks_free(const Values& from, const Values& to);
  /// The waypoints after `from` of a way to `to` that looks free and keeps the constraints: `to`
  /// alone where nothing is to be kept or the straight line does; else points between are projected
  /// onto the constraints until all stretches keep them.
  /// @param back  it is gone the other way
  std::optional<robot::Path> way(const Values& from, const Values& to, bool back = false);
  /// Moves a configuration onto the constraints. @return whether it is there
  bool project(Values& q);
  [[nodiscard]] bool has_constraints() const { return !bands_.empty(); }
  /// True if looks_free has said for certain that the motion is free at every instant.
  [[nodiscard]] bool is_known_free(const Values& from, const Values& to) {
    const Known* known = memory_.decided.find(from, to);
    return known != nullptr && *known == Known::Free;
  }
  /// True if the motion is free at every instant, for certain; by a motion checker, only where
  /// vector code says so.
  bool is_soon_certain(const Values& from, const Values& to);
  /// What of the constraints a path does not keep; nullopt: it keeps all.
  std::optional<ConstraintAnswer> find_broken(const robot::Path& path);
  /// Largest deviations of the path that find_broken looked at last.
  [[nodiscard]] const std::vector<double>& deviations() const { return kept_.parts; }
  /// Decides a motion at every instant.
  world::MotionAnswer check(const robot::Path& path);

  /// What has ended the search, if something has.
  [[nodiscard]] std::optional<PathAnswer::Outcome> ended() const;
  /// The same on any machine; time is not looked at.
  [[nodiscard]] bool work_ended() const { return spent_.work >= options_.most_work; }
  void count_nodes(std::size_t looked_at);
  [[nodiscard]] Spent& spent() { return spent_; }
  /// @param found  else some motions that were not free are asked what is in the way of them
  [[nodiscard]] std::vector<Blocker> blockers(bool found);
  [[nodiscard]] const robot::Robot& kinematics() const;

 private:
  void note(const std::optional<world::Contact>& contact);
  void tell(std::size_t count) const;
  /// @param closely  what vector code leaves open is looked at
  Known look(const Values& from, const Values& to, bool closely);
  void note_blocked(const Values& from, const Values& to);
  bool is_certain(const Values& from, const Values& to);
  filter::MotionChecker::Answer filter(const Values& from, const Values& to);
  bool looks_free_where_open(const Values& from, const Values& to);
  /// Whether nothing is in contact at places of the motion, evenly.
  bool looks_free_at_places(const Values& from, const Values& to);
  world::MotionAnswer check_exactly(const robot::Path& path);
  [[nodiscard]] const world::RobotModel& kinematic_model() const;
  bool keeps(const Values& from, const Values& to);
  bool trace(const Values& from, const Values& to, int depth, robot::Path& out);

  const world::Checker& checker_;
  world::WorldState state_;
  std::size_t robot_;
  const PathOptions& options_;
  world::MotionOptions check_ = options_.check;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const Metric& metric_;
  SearchMemory& memory_;
  world::Scratch& scratch_;
  Values lower_, upper_, near_lower_, near_upper_;
  std::vector<ConstraintBand> bands_;
  ConstraintProjection projection_;
  ConstraintAnswer kept_;  ///< of what was looked at last
  Spent spent_;
  std::map<std::array<world::Item, 2>, std::size_t> met_;
  std::vector<robot::Path> blocked_;  ///< some motions that were not free
  std::size_t blocked_count_ = 0;
};

/// @throws Error{InvalidArgument} unless q is a finite value per variable of a robot that there is.
void require_fits(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                  const Values& q);

/// q between two configurations.
Values between(const Values& a, const Values& b, double share);

}  // namespace kaboum::motion
