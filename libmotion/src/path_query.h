#pragma once

#include "search_space.h"

namespace kaboum::motion {

/// A question for a path: its ends, and the only way to an answer.
class PathQuery {
 public:
  using Outcome = PathAnswer::Outcome;

  /// Refers to all of it.
  PathQuery(SearchSpace& space, const Values& start, std::span<const Values> goals)
      : space_(space), start_(start), goals_(goals) {}

  /// Whether start and some goals are free, within the limits and keep the constraints; else the
  /// answer says so.
  bool look_at_ends() { return look_at_start() && look_at_goals(); }
  /// Those goals, the nearest first.
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }
  /// Straight lines to the goals.
  bool go_straight();

  /// The only way to an answer with a path: what is returned has been decided as it is.
  bool accept(const robot::Path& path, std::size_t goal);
  void end(Outcome outcome) { answer_.outcome = outcome; }
  PathAnswer take();

 private:
  bool look_at_start();
  bool look_at_goals();

  SearchSpace& space_;
  const Values& start_;
  std::span<const Values> goals_;
  std::vector<std::size_t> order_;
  PathAnswer answer_;
};

/// Answers a question by RRT-Connect, or ends it.
/// @pre look_at_ends of it was true
void grow_trees(SearchSpace& space, PathQuery& query, const Values& start,
                std::span<const Values> goals, const PathOptions& options);

/// @throws Error{InvalidArgument} for ends, limits and constraints that fit nothing
void require_query(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                   const Values& start, std::span<const Values> goals, const PathOptions& options);

}  // namespace kaboum::motion
