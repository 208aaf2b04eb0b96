#pragma once

#include <kaboum/plan/solve.h>

#include <array>
#include <optional>
#include <vector>

#include "search/state_store.h"
#include "task/solve_limits.h"
#include "worlds/belief_estimates.h"
#include "worlds/belief_policy.h"
#include "worlds/belief_space.h"

namespace kaboum::plan::worlds {

/// And-or search over beliefs. All beliefs that were made are nodes of one graph; a node is solved
/// as soon as it has an edge all outcomes of which are, and so are then those before it.
///
/// What is expanded next is found by weak plans: a best-first search that may choose outcomes looks
/// for a solved node, then the other outcomes along its way are achieved in turn, from the end. Two
/// estimates guide that in turn. If it fails too often, or for good, every belief is expanded: when
/// none is left, what is not solved has no plan. docs/planning/knowledge-states.md, "Possible
/// worlds".
class BeliefSearch {
 public:
  /// @param guided  whether estimates order the search; else breadth first.
  BeliefSearch(BeliefSpace& space, const Model& model, bool guided, Limits& limits,
               Statistics& statistics);

  /// Solved or Unsolvable. @throws LimitExceeded
  kaboum::plan::Outcome run(const std::vector<Outcome>& start);
  [[nodiscard]] Plan plan() const;

 private:
  struct Node {
    std::array<int, 2> estimates = {-1, -1};  ///< by Guide
    Index entry = kNone;                      ///< of the policy; kNone: not solved
    Index first_edge = 0, edges = 0;
    bool expanded = false;
    bool dead = false;
    std::vector<Index> incoming;  ///< edges
  };
  struct Edge {
    Index source = 0, op = 0;
    Index first = 0, outcomes = 0;  ///< in outcomes_
    Index unsolved = 0;
    bool dead = false;
    bool blocked = false;  ///< an outcome was not achieved, for now
  };
  struct Hop {
    Index edge, outcome;
  };
  using Path = std::vector<Hop>;
  enum class Attempt : std::uint8_t { Solved, Failed, TurnOver };

  Index node(const Word* belief);
  int estimate(Index n);
  void expand(Index n);
  Index enter(const Edge& e);
  void solve(Index n, Index entry);
  void bury(Index n);
  [[nodiscard]] bool usable(const Edge& e) const;
  std::optional<Path> weak_plan(Index from, bool& proved);
  void leave_needless_sensing_out(Index from, Path& path);
  std::optional<Path> replay(Index from, const Path& path, std::size_t without);
  bool achieve(Index n);
  Attempt attempt(Guide guide, std::size_t most_expanded);
  bool take_turns();
  bool exhaust();
  [[nodiscard]] bool all_solved() const;
  [[nodiscard]] bool done() const;
  void check_limits();

  BeliefSpace& space_;
  bool guided_;
  Limits& limits_;
  Statistics& statistics_;
  BeliefEstimates estimates_;
  Guide guide_ = Guide::Worlds;
  std::size_t turn_end_ = 0;  ///< of expanded nodes
  BeliefPolicy policy_;
  StateStore store_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  std::vector<Index> outcomes_;                               ///< nodes
  std::vector<std::vector<std::pair<Index, Index>>> sensed_;  ///< of each of them
  std::vector<Index> roots_;
  std::vector<std::vector<std::pair<Index, Index>>> root_sensed_;
  std::vector<char> open_obligation_;  ///< by node
  std::size_t failures_ = 0;
  std::size_t depth_ = 0;
  // Of one search for a weak plan:
  std::uint64_t search_ = 0;
  std::vector<std::uint64_t> seen_;
  std::vector<Hop> came_;
};

}  // namespace kaboum::plan::worlds
