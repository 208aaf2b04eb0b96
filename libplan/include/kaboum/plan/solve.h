#pragma once

#include <kaboum/plan/model.h>
#include <kaboum/plan/plan.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace kaboum::plan {

enum class Algorithm {
  DepthFirst,          ///< thesis: first plan in order of declaration
  BreadthFirst,        ///< thesis: fewest steps (of each unbranched part)
  IterativeDeepening,  ///< thesis: fewest steps
  Greedy,              ///< best first by the relaxed plan, preferred operators
  AStar                ///< least cost (without sensing), landmark cost partitioning
};

/// Counters in the spirit of Table 6.4.
struct Statistics {
  std::uint64_t expanded = 0;        ///< states whose steps were generated
  std::uint64_t generated = 0;       ///< successor states made
  std::uint64_t states = 0;          ///< distinct states kept, of the largest single search
  std::uint64_t state_bytes = 0;     ///< their storage: contents, links and index
  std::uint64_t ground_actions = 0;  ///< instances that came into being
  std::uint64_t external_calls = 0;  ///< calls of external functions, cached ones not counted
  std::uint64_t external_bytes = 0;  ///< of handles, and of what was called where
  double external_seconds = 0;       ///< spent in them: the thesis's time of geometric search
  std::uint64_t searches = 0;        ///< searches for one unbranched part
  std::uint64_t dead_ends = 0;       ///< states proved to have no plan
  std::uint64_t reused = 0;          ///< sub-plans found again by their regressed condition
  std::uint64_t depth = 0;           ///< deepest layer or path so far
  /// Heuristic value of the initial state, where one was used and it is no dead end.
  std::optional<std::int64_t> initial_estimate = {};
};

struct SolveOptions {
  Algorithm algorithm = Algorithm::BreadthFirst;
  double timeout = 0;                               ///< seconds; 0: none
  std::size_t max_memory = 0;                       ///< bytes of grounding and search; 0: none
  std::function<void(const Statistics&)> progress;  ///< called now and then
  std::uint64_t seed = 1;                           ///< of external functions that choose at random
  /// Number of times that a call that finds nothing is made, with more samples each time, before
  /// the search gives up: all calls once, then all that found nothing once more, and so on.
  unsigned attempts = 8;
  /// Number of times that the search begins anew with other choices, where it fails and external
  /// functions say that they chose among several things.
  unsigned choices = 64;
  /// Assumed outcomes of sensing, by atom or term, "isSpillable(o1)": "true", "false", or
  /// the value's name. The plan has branches for nothing else of these, unless it is known not to
  /// be so (run_and_replan goes on from there).
  std::map<std::string, std::string> assumed = {};
};

enum class Outcome {
  Solved,
  Unsolvable,   ///< proved: all was tried, and the knowledge states lose nothing
  NotInferred,  ///< all was tried, but the knowledge states know less than could be concluded
  Limit         ///< time, memory or size ran out first
};

/// "solved", "unsolvable", "not inferred", "limit".
const char* name_of(Outcome outcome);

struct Solution {
  Outcome outcome = Outcome::Limit;
  std::string limit;  ///< which, when the outcome is Limit
  /// Why there is no plan, when an external function was asked: the first call that was impossible.
  std::string refused;
  std::string lost;  ///< what the knowledge states do not keep, when the outcome is NotInferred
  Plan plan;
  Statistics statistics;
};

/// Plans from the model's initial knowledge to its goal. Deterministic, timeouts apart.
/// @throws Error of what an external function or an inconsistent initial state causes, and
///   Error{InvalidArgument} for assumptions of what the model does not have.
Solution solve(const Model& model, const SolveOptions& options);

}  // namespace kaboum::plan
