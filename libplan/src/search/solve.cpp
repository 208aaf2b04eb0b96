// One call of the planner: the task is made, a planner run, limits become an outcome. Sets of
// possible worlds are kept where databases of knowledge would lose something.
#include <kaboum/base/error.h>
#include <kaboum/plan/solve.h>

#include <algorithm>

#include "search/choices.h"
#include "search/contingent.h"
#include "search/fact_table.h"
#include "search/reachability.h"
#include "search/search.h"
#include "task/exactness.h"
#include "task/knowledge_view.h"
#include "task/task.h"
#include "worlds/belief_search.h"
#include "worlds/world_grounder.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMostWorlds = 1U << 18U;  // of one component

ContingentPlanner::SearchFunction search_function(Algorithm a) {
  switch (a) {
    case Algorithm::DepthFirst:
      return depth_first;
    case Algorithm::BreadthFirst:
      return breadth_first;
    case Algorithm::IterativeDeepening:
      return iterative_deepening;
    case Algorithm::Greedy:
      return greedy_best_first;
    case Algorithm::AStar:
      return a_star;
  }
  throw Error(ErrorCode::InvalidArgument, "unknown search algorithm");
}

/// Steps of a search after which it is first looked whether what was refused leaves a plan
/// possible, and how many times as many there are before the next look.
constexpr std::uint64_t kFirstLook = 2'000, kLaterLook = 8;

/// Whether no state that the delete relaxation reaches meets the goal, if calls that had no value
/// have none wherever what they read has not changed. Objects that do not matter then multiply
/// nothing.
bool is_refuted(Task& task, Limits& limits, Reachability::Answers answers) {
  const FactTable facts(task.model(), task.layout());
  return !Reachability(task, limits, facts, answers).possible(task.goal(), true);
}

/// Why a search need not begin, or go on.
enum class Refutation : std::uint8_t {
  None,
  Proved,   ///< there is no plan, whatever functions choose and still may find
  NotFound  ///< nor is there one with what they found so far
};

Refutation refutation(Task& task, Limits& limits) {
  using Answers = Reachability::Answers;
  {
    const ExternalCalls::Supposing supposing(task.calls());
    if (!is_refuted(task, limits, Answers::AsFound)) return Refutation::None;
  }
  if (is_refuted(task, limits, Answers::AsGiven)) return Refutation::Proved;
  is_refuted(task, limits, Answers::AsFound);  // what is missed then, is
  return Refutation::NotFound;
}

/// A search, stopped now and then to look whether it can succeed at all. What it asks external
/// functions the second time is known by then.
/// @param proved  no choice and no further attempt can change that there is no plan.
Outcome run_planner(Task& task, const SolveOptions& options, const Assumptions& assumptions,
                    Limits& limits, Solution& solution, bool& proved) {
  std::uint64_t steps = kFirstLook;
  const auto& functions = task.model().external_functions;
  const bool looks = std::ranges::any_of(functions, &ExternalFunction::reads_state);
  const auto is_hopeless = [&] {
    const Refutation found = refutation(task, limits);
    proved = found == Refutation::Proved;
    return proved || (found == Refutation::NotFound && !task.calls().missed().empty());
  };
  if (std::ranges::any_of(functions, &ExternalFunction::refuses_early)) {
    // What was not found ends no first search: that may prove more without it.
    if (task.calls().attempts() > 1) {
      if (is_hopeless()) return Outcome::Unsolvable;
    } else {
      const ExternalCalls::Supposing supposing(task.calls());
      proved = is_refuted(task, limits, Reachability::Answers::AsGiven);
      if (proved) return Outcome::Unsolvable;
    }
  }
  while (true) {
    if (looks) limits.pause_after(steps);
    ContingentPlanner planner(task, search_function(options.algorithm), assumptions, limits,
                              solution.statistics);
    const Outcome out = planner.run();
    const bool paused = out == Outcome::Limit && limits.paused();
    limits.never_pause();
    if (out == Outcome::Solved) solution.plan = planner.plan();
    if (!paused) return out;
    const bool failed = !task.calls().refused().empty() || !task.calls().missed().empty();
    if (failed && is_hopeless()) return Outcome::Unsolvable;
    steps *= kLaterLook;
  }
}

/// Whether a search that has failed may succeed with more attempts, or with other choices.
struct Remedies {
  bool attempts = false, choices = false;
};

/// A task that is searched with some choices of external functions.
class ChosenSearch {
 public:
  ChosenSearch(const Model& model, const SolveOptions& options, Choices choices, Limits& limits)
      : options_(options), choices_(std::move(choices)), limits_(limits), task_(model, limits),
        assumptions_(task_, options.assumed) {
    task_.calls().seed(options.seed, choices_);
  }

  /// Searches; the first time with `attempts`, then with one more than before.
  Remedies run(unsigned attempts, Solution& solution) {
    ExternalCalls& calls = task_.calls();
    if (searched_) calls.try_again();
    searched_ = true;
    try {
      while (true) {
        const Remedies out = run_once(solution);
        if (!out.attempts || calls.attempts() >= attempts) {
          count(solution.statistics);
          return out;
        }
        calls.try_again();
      }
    } catch (const LimitExceeded&) {
      count(solution.statistics);
      throw;
    }
  }

  [[nodiscard]] const Choices& choices() const { return choices_; }
  [[nodiscard]] ChoosingCalls choosing_calls() { return task_.calls().choosing_calls(); }

 private:
  Remedies run_once(Solution& solution) {
    ExternalCalls& calls = task_.calls();
    bool proved = false;
    solution.limit.clear();
    solution.refused.clear();
    solution.outcome = run_planner(task_, options_, assumptions_, limits_, solution, proved);
    if (solution.outcome == Outcome::Solved) {
      const auto& functions = task_.model().external_functions;
      if (std::ranges::any_of(functions, &ExternalFunction::takes_seed)) {
        solution.plan.seed = options_.seed;
        solution.plan.attempts = calls.attempts();
        solution.plan.choices = choices_;
      }
    }
    if (solution.outcome == Outcome::Unsolvable && !proved) {
      if (!calls.missed().empty()) {
        solution.outcome = Outcome::Limit;
        solution.limit = "an external function found nothing in " +
                         std::to_string(calls.attempts()) +
                         (calls.attempts() == 1 ? " attempt, " : " attempts, ") + calls.missed();
        return {true, true};
      }
    }
    if (solution.outcome == Outcome::Unsolvable) {
      solution.refused = calls.refused();
      if (!calls.listed().empty()) {
        solution.outcome = Outcome::Limit;
        solution.limit =
            "with what the scene lists there is none, others may do: " + calls.listed();
        return {false, true};
      }
      if (!proved && !calls.chosen().empty()) {
        solution.outcome = Outcome::Limit;
        solution.limit = "with the value that was chosen for " + calls.chosen() +
                         " there is none; others may do, and are not tried" +
                         (solution.refused.empty() ? "" : "; " + solution.refused);
        return {false, true};
      }
    }
    if (solution.outcome != Outcome::Limit) calls.confirm();
    return {};
  }

  /// Adds to a solution's figures what came since the last time.
  void count(Statistics& s) {
    const ExternalCalls& calls = task_.calls();
    s.ground_actions = task_.action_count();
    s.external_calls += calls.calls_made() - counted_calls_;
    s.external_bytes = std::max<decltype(s.external_bytes)>(s.external_bytes, calls.bytes());
    s.external_seconds += calls.seconds() - counted_seconds_;
    counted_calls_ = calls.calls_made();
    counted_seconds_ = calls.seconds();
  }

  const SolveOptions& options_;
  Choices choices_;
  Limits& limits_;
  Task task_;
  Assumptions assumptions_;
  bool searched_ = false;
  std::uint64_t counted_calls_ = 0;
  double counted_seconds_ = 0;
};

/// Whether it is known at the start that one of several atoms holds, and not which.
bool has_disjunctions(const Model& model) {
  return std::any_of(model.initial.begin(), model.initial.end(), [](const Update& u) {
    return u.database == Update::Database::Kx && !u.literals[0].function;
  });
}

/// With sets of possible worlds. @return false if the model, or what is unknown in it, is not of a
/// size and kind that they are kept of; nothing is decided then.
bool search_worlds(const Model& model, const SolveOptions& options, Limits& limits,
                   Solution& solution) {
  const auto task = worlds::ground_worlds(model, limits);
  if (!task) return false;
  worlds::BeliefSpace space(*task);
  const auto start = space.start(kMostWorlds, limits);
  if (!start) return false;
  solution.statistics.ground_actions = task->operators.size();
  const bool guided =
      options.algorithm == Algorithm::Greedy || options.algorithm == Algorithm::AStar;
  worlds::BeliefSearch search(space, model, guided, limits, solution.statistics);
  try {
    solution.outcome = search.run(*start);
  } catch (const worlds::TooManyWorlds&) {
    return false;
  }
  if (solution.outcome == Outcome::Solved) solution.plan = search.plan();
  if (solution.outcome == Outcome::Unsolvable) {
    solution.lost = lost_in_worlds(model);
    if (!solution.lost.empty()) solution.outcome = Outcome::NotInferred;
  }
  return true;
}

/// Searches with other choices that are tried after each search with one more attempt.
constexpr int kChoicesPerAttempt = 2;

/// With knowledge states. Where what was found leads no further, in turns: with more attempts, and
/// with other choices of the calls that the failures rest on.
void search_knowledge(const Model& model, const SolveOptions& options, const std::string& lost,
                      Limits& limits, Solution& solution) {
  ChosenSearch first(model, options, {}, limits);
  ChoiceSearch choices;
  unsigned attempts = 1, others = 0;
  Remedies remedies = first.run(attempts, solution);
  if (remedies.choices) choices.add_failure({}, first.choosing_calls());
  bool more = remedies.attempts || remedies.choices;
  while (more) {
    more = false;
    for (int i = 0; i < kChoicesPerAttempt && remedies.choices && others < options.choices; ++i) {
      std::optional<Choices> next = choices.next();
      if (!next) break;
      more = true;
      ++others;
      Solution other;
      other.statistics = solution.statistics;
      ChosenSearch search(model, options, std::move(*next), limits);
      const Remedies failed = search.run(attempts, other);
      solution.statistics = other.statistics;
      if (other.outcome == Outcome::Solved) {
        solution = std::move(other);
        return;
      }
      if (failed.choices) choices.add_failure(search.choices(), search.choosing_calls());
    }
    if (remedies.attempts && attempts < options.attempts) {
      more = true;
      remedies = first.run(++attempts, solution);
      if (remedies.choices) choices.add_failure({}, first.choosing_calls());
    }
  }
  if (solution.outcome == Outcome::Limit && others > 0)
    solution.limit += "; nor with " + std::to_string(others) +
                      (others == 1 ? " set" : " sets") + " of other choices (" +
                      std::to_string(choices.conflicts()) + " conflicts)";
  if (solution.outcome != Outcome::Unsolvable || lost.empty()) return;
  solution.lost = lost;
  solution.outcome = Outcome::NotInferred;
}

}  // namespace

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::Solved:
      return "solved";
    case Outcome::Unsolvable:
      return "unsolvable";
    case Outcome::NotInferred:
      return "not inferred";
    case Outcome::Limit:
      break;
  }
  return "limit";
}

Solution solve(const Model& model, const SolveOptions& options) {
  Solution solution;
  Limits limits(options, solution.statistics);
  try {
    const std::optional<Model> view = knowledge_view(model);
    const Model& known = view ? *view : model;
    const std::string lost = view ? "conditions of the world (whenever, Or) are kept as far as "
                                    "they are known"
                                  : lost_knowledge(known);
    // Sets of worlds know no least cost or fewest steps: they come first where the databases would
    // mostly fail, else only after them.
    // Nor do they know assumptions.
    const bool use_worlds = options.assumed.empty();
    const bool worlds_first = view || (options.algorithm == Algorithm::Greedy &&
                                       has_disjunctions(model) && lost_in_worlds(model).empty());
    if (!use_worlds || !worlds_first || !search_worlds(model, options, limits, solution))
      search_knowledge(known, options, lost, limits, solution);
    Solution again;
    again.statistics = solution.statistics;
    if (use_worlds && !worlds_first && solution.outcome == Outcome::NotInferred &&
        search_worlds(model, options, limits, again))
      solution = std::move(again);
  } catch (const LimitExceeded&) {
    solution.outcome = Outcome::Limit;
    const std::string before = std::move(solution.limit);
    solution.limit = limits.reason();
    if (!before.empty()) solution.limit += (solution.limit.empty() ? "" : "; until then, ") + before;
  }
  if (solution.outcome == Outcome::Limit && solution.limit.empty())
    solution.limit =
        limits.reason().empty() ? "depth limit of nested searches reached" : limits.reason();
  return solution;
}

}  // namespace kaboum::plan
