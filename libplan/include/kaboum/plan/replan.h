#pragma once

#include <kaboum/plan/load.h>
#include <kaboum/plan/replay.h>
#include <kaboum/plan/solve.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::plan {

/// A task as it is read, so that it can be read again from another state.
struct TaskTexts {
  Text domain;
  std::optional<Text> problem;
  ExternalBindings bindings = {};
};

/// A plan that was made during a run.
struct Replan {
  std::string outcome;        ///< that no branch was there for: "!isSpillable(o1)"
  std::uint64_t actions = 0;  ///< done before, by the plan that had no branch
  unsigned after = 0;         ///< 0: that was the first plan; else which of these, from 1
  Outcome result = Outcome::Limit;
  std::string reason;     ///< why there is no plan
  std::size_t nodes = 0;  ///< of the new plan
  double seconds = 0;     ///< of planning
  unsigned plan = 0;      ///< that is carried out then: which new one, from 1; 0: there is none
  bool reached = false;   ///< the same was known before: that plan is carried out
  bool circle = false;    ///< that plan, or one that took over from it, has led here
};

struct ReplanOptions {
  RunOptions run = {};      ///< `unplanned` is not looked at
  SolveOptions solve = {};  ///< how it is planned again
  std::size_t most = 100;   ///< new plans; those that are needed beyond are not made
  /// Is told, before it is planned again, why. @param after  as Replan::after
  std::function<void(const Unplanned&, unsigned after)> planning = {};
  /// Is told what has come of that, before a new plan is carried out.
  std::function<void(const Replan&)> planned = {};
};

struct ReplanSummary {
  RunSummary run;  ///< of all plans together; a way is counted in each plan that it is a part of
  std::vector<Replan> replans;
  /// True if there was a plan for all that happened, and every way has come to its end.
  [[nodiscard]] bool complete() const;
};

/// Maker of what carries out the steps of a plan of a model. Both live as long as the run.
using StepsOf =
    std::function<std::function<void(const RunStep&)>(const Model& model, const Plan& plan)>;

/// Carries out a plan as `run` does; where sensing turns out as the plan has no branch for, it is
/// planned again. That is done from what is known then, by the same external functions, and the new
/// plan is carried out [gaschler2016, §3.3.1: assumptions that fail]. Each state is planned for
/// once. Random outcomes of the new plans have seeds of their own.
/// @throws Error as `run` and `load_from`.
ReplanSummary run_and_replan(const TaskTexts& texts, const Model& model, const Plan& plan,
                             const ReplanOptions& options, const StepsOf& steps);

}  // namespace kaboum::plan
