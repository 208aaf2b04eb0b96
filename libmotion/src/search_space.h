#pragma once

#include <kaboum/base/random.h>
#include <kaboum/motion/find_path.h>

#include <chrono>
#include <map>

#include "constraint_bands.h"

namespace kaboum::motion {

using Values = std::vector<double>;  ///< one per variable

/// The configurations of a robot as a search sees them: distances, samples, contacts, and what all
/// that has cost.
class SearchSpace {
 public:
  /// @param start  directions that are to stay parallel have the sense that they have there
  SearchSpace(const world::Checker& checker, world::WorldState state, std::size_t robot,
              const Values& start, const PathOptions& options);

  /// Samples are drawn within the limits, of joints that turn mostly within half a turn of these.
  void draw_around(const Values& start, std::span<const Values> goals);
  Values sample(Random& random);

  /// Root of the squares of how far the variables move points of the robot [length].
  [[nodiscard]] double distance(const Values& a, const Values& b) const;
  /// Extensions of trees are as long as this. [length]
  [[nodiscard]] double range() const { return range_; }

  /// The contact at a configuration.
  std::optional<world::Contact> find_contact(const Values& q);
  /// Whether the end and configurations on the way, not far from each other, are free: cheap, and
  /// certifies nothing.
  bool looks_free(const Values& from, const Values& to);
  /// The waypoints after `from` of a way to `to` that looks free and keeps the constraints: `to`
  /// alone where nothing is to be kept or the straight line does; else points between are projected
  /// onto the constraints until all stretches keep them.
  std::optional<robot::Path> way(const Values& from, const Values& to);
  /// Moves a configuration onto the constraints. @return whether it is there
  bool project(Values& q);
  [[nodiscard]] bool has_constraints() const { return !bands_.empty(); }
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
  [[nodiscard]] std::vector<Blocker> blockers() const;
  [[nodiscard]] const robot::Robot& kinematics() const;

 private:
  void note(const std::optional<world::Contact>& contact);
  [[nodiscard]] const world::RobotModel& kinematic_model() const;
  bool keeps(const Values& from, const Values& to);
  bool trace(const Values& from, const Values& to, int depth, robot::Path& out);

  const world::Checker& checker_;
  world::WorldState state_;
  std::size_t robot_;
  const PathOptions& options_;
  world::MotionOptions check_ = options_.check;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<world::Scratch> own_;
  world::Scratch& scratch_;
  Values weight_;  ///< how far a variable moves points, per unit of it
  Values lower_, upper_, near_lower_, near_upper_;
  double range_ = 1, spacing_ = 1;
  std::vector<ConstraintBand> bands_;
  ConstraintProjection projection_;
  ConstraintAnswer kept_;  ///< of what was looked at last
  Spent spent_;
  std::map<std::array<world::Item, 2>, std::size_t> met_;
};

/// @throws Error{InvalidArgument} unless q is a finite value per variable of a robot that there is.
void require_fits(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                  const Values& q);

/// q between two configurations.
Values between(const Values& a, const Values& b, double share);

}  // namespace kaboum::motion
