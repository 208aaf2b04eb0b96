// One call of the planner: the task is made, a planner run, limits become an outcome. Sets of
// possible worlds are kept where databases of knowledge would lose something.
#include <kaboum/base/error.h>
#include <kaboum/plan/solve.h>

#include <algorithm>
#include <set>
#include <string>

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

/// Calls in vain after which it is looked whether other choices are to be tried, how many times as
/// many there are before the next look, and failed calls that are looked at.
constexpr std::uint64_t kPatience = 24, kMorePatience = 8;
constexpr std::size_t kMostFailed = 64;

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

/// Of the calls that had no value for what was chosen, those without which there is no plan: the
/// delete relaxation does not reach the goal.
std::vector<Index> needed_calls(Task& task, Limits& limits) {
  std::vector<Index> failed = task.calls().failed_by_choice();
  if (failed.size() > kMostFailed) failed.resize(kMostFailed);
  if (failed.empty()) return failed;
  const FactTable facts(task.model(), task.layout());
  std::erase_if(failed, [&](Index call) {
    const Limits::Scope scope(limits);
    return Reachability(task, limits, facts, Reachability::Answers::Any, call)
        .possible(task.goal(), true);
  });
  return failed;
}

/// How a search has ended.
struct SearchEnd {
  Outcome outcome = Outcome::Limit;
  bool proved = false;   ///< no choice and no further attempt can change that there is no plan
  bool in_vain = false;  ///< it was given up, since a call that is needed fails by what was chosen
};

/// A search, stopped now and then to look whether it can succeed at all. What it asks external
/// functions the second time is known by then.
/// @param patience  calls in vain after which it is given up; 0: never
SearchEnd run_planner(Task& task, const SolveOptions& options, const Assumptions& assumptions,
                      std::uint64_t patience, Limits& limits, Solution& solution) {
  bool proved = false;
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
      if (is_hopeless()) return {Outcome::Unsolvable, proved};
    } else {
      const ExternalCalls::Supposing supposing(task.calls());
      if (is_refuted(task, limits, Reachability::Answers::AsGiven))
        return {Outcome::Unsolvable, true};
    }
  }
  while (true) {
    if (looks) limits.pause_after(steps);
    task.calls().pause_after(patience);
    ContingentPlanner planner(task, search_function(options.algorithm), assumptions, limits,
                              solution.statistics);
    const Outcome out = planner.run();
    const bool paused = out == Outcome::Limit && limits.paused();
    const bool in_vain = paused && task.calls().is_in_vain();
    limits.never_pause();
    task.calls().pause_after(0);
    if (out == Outcome::Solved) solution.plan = planner.plan();
    if (!paused) return {out};
    if (in_vain) {
      if (!needed_calls(task, limits).empty()) return {Outcome::Limit, false, true};
      patience *= kMorePatience;
      continue;
    }
    const bool failed = !task.calls().refused().empty() || !task.calls().missed().empty();
    if (failed && is_hopeless()) return {Outcome::Unsolvable, proved};
    steps *= kLaterLook;
  }
}

/// Whether a search that has failed may succeed with more attempts, with other choices, or with
/// more patience.
struct Remedies {
  bool attempts = false, choices = false, patience = false;
};

/// As choices are stated, "fetch(robot1, o1, home)".
std::string text_of(const Model& model, const Plan::Call& call) {
  std::string text;
  for (const std::string& a : call.arguments) text += (text.empty() ? "(" : ", ") + a;
  return model.externals[call.external].name + text + (text.empty() ? "" : ")");
}

/// A task that is searched with some choices of external functions.
class ChosenSearch {
 public:
  ChosenSearch(const Model& model, const SolveOptions& options, Choices choices, Limits& limits)
      : options_(options),
        choices_(std::move(choices)),
        limits_(limits),
        task_(model, limits),
        assumptions_(task_, options.assumed) {
    task_.calls().seed(options.seed, choices_);
  }

  /// Searches anew, with so many attempts of each call. @param patience  as of run_planner.
  Remedies run(unsigned attempts, std::uint64_t patience, Solution& solution) {
    while (task_.calls().attempts() < attempts) task_.calls().try_again();
    try {
      const Remedies out = run_once(patience, solution);
      count(solution.statistics);
      return out;
    } catch (const LimitExceeded&) {
      count(solution.statistics);
      throw;
    }
  }

  [[nodiscard]] const Choices& choices() const { return choices_; }
  [[nodiscard]] ChoosingCalls choosing_calls() {
    return task_.calls().choosing_calls(needed_calls(task_, limits_));
  }

 private:
  Remedies run_once(std::uint64_t patience, Solution& solution) {
    ExternalCalls& calls = task_.calls();
    solution.limit.clear();
    solution.refused.clear();
    const SearchEnd end = run_planner(task_, options_, assumptions_, patience, limits_, solution);
    solution.outcome = end.outcome;
    const bool proved = end.proved;
    if (end.in_vain) {
      solution.limit =
          "it was given up; " + (calls.missed().empty() ? calls.refused() : calls.missed());
      return {!calls.missed().empty(), true, true};
    }
    if (solution.outcome == Outcome::Solved) {
      const auto& functions = task_.model().external_functions;
      if (std::ranges::any_of(functions, &ExternalFunction::takes_seed)) {
        solution.plan.seed = options_.seed;
        solution.plan.attempts = calls.attempts();
        solution.plan.choices = choices_of(solution.plan);
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

  /// Those of calls that the plan makes; of truth values, which nodes do not list, all.
  [[nodiscard]] Choices choices_of(const Plan& plan) const {
    const std::vector<Symbol>& functions = task_.model().externals;
    std::set<std::string> made;
    for (const Plan::Node& node : plan.nodes)
      for (const Plan::Call& call : node.calls) made.insert(text_of(task_.model(), call));
    Choices out = choices_;
    std::erase_if(out, [&](const auto& choice) {
      const auto& [call, number] = choice;
      const std::string name = call.substr(0, call.find('('));
      return std::ranges::find(functions, name, &Symbol::name)->range != kNone &&
             !made.contains(call);
    });
    return out;
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

/// Memory that counts as held while this lives.
class HeldBytes {
 public:
  explicit HeldBytes(Limits& limits) : limits_(limits) {}
  ~HeldBytes() { limits_.give_back(bytes_); }
  HeldBytes(const HeldBytes&) = delete;
  HeldBytes& operator=(const HeldBytes&) = delete;
  /// It is so much now, not less than before. @throws LimitExceeded
  void tell(std::size_t bytes) {
    const std::size_t more = bytes - bytes_;
    bytes_ = bytes;
    limits_.hold(more);
  }

 private:
  Limits& limits_;
  std::size_t bytes_ = 0;
};

/// Searches with other choices that are tried after each search with one more attempt.
constexpr int kChoicesPerAttempt = 2;

/// With knowledge states. Where what was found leads no further, in turns: with more attempts, and
/// with other choices of the calls that the failures rest on.
void search_knowledge(const Model& model, const SolveOptions& options, const std::string& lost,
                      Limits& limits, Solution& solution) {
  ChosenSearch first(model, options, {}, limits);
  unsigned attempts = 1, others = 0;
  std::size_t conflicts = 0;
  bool again = true;
  for (std::uint64_t patience = kPatience; again; patience *= kMorePatience) {
    // What was given up is no conflict of those with more patience.
    again = false;
    ChoiceSearch choices;
    HeldBytes held(limits);
    const auto note = [&](ChosenSearch& search, const Remedies& failed) {
      if (failed.choices) choices.add_failure(search.choices(), search.choosing_calls());
      again |= failed.patience;
    };
    if (others >= options.choices) patience = 0;
    Remedies remedies = first.run(attempts, patience, solution);
    note(first, remedies);
    held.tell(choices.bytes());
    for (bool more = true; more && (remedies.attempts || remedies.choices);) {
      more = false;
      for (int i = 0; i < kChoicesPerAttempt && others < options.choices; ++i) {
        std::optional<Choices> next = choices.next();
        if (!next) break;
        more = true;
        ++others;
        Solution other;
        other.statistics = solution.statistics;
        {
          const Limits::Scope scope(limits);
          ChosenSearch search(model, options, std::move(*next), limits);
          const Remedies failed = search.run(attempts, patience, other);
          solution.statistics = other.statistics;
          if (other.outcome == Outcome::Solved) {
            solution = std::move(other);
            return;
          }
          note(search, failed);
        }
        held.tell(choices.bytes());
      }
      if (remedies.attempts && attempts < options.attempts) {
        more = true;
        remedies = first.run(++attempts, patience, solution);
        note(first, remedies);
      }
    }
    conflicts += choices.conflicts();
    if (!remedies.attempts && !remedies.choices) break;
  }
  if (solution.outcome == Outcome::Limit && others > 0)
    solution.limit += "; nor with " + std::to_string(others) + (others == 1 ? " set" : " sets") +
                      " of other choices (" + std::to_string(conflicts) + " conflicts)";
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
    if (!before.empty())
      solution.limit += (solution.limit.empty() ? "" : "; until then, ") + before;
  }
  if (solution.outcome == Outcome::Limit && solution.limit.empty())
    solution.limit =
        limits.reason().empty() ? "depth limit of nested searches reached" : limits.reason();
  return solution;
}

}  // namespace kaboum::plan
