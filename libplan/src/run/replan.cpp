// Execution with replanning: from each state that the plan has no branch for, a plan of its own.
#include <kaboum/plan/replan.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <utility>

namespace kaboum::plan {
namespace {

/// Runs of plans one after another, in the order in which they turn out to be needed.
class Runs {
 public:
  Runs(const TaskTexts& texts, const ReplanOptions& options, const StepsOf& steps)
      : texts_(texts), options_(options), steps_(steps) {}

  ReplanSummary run(const Model& model, const Plan& plan) {
    carry_out(model, plan, 0);
    while (!open_.empty()) {
      auto [what, after] = std::move(open_.front());
      open_.pop_front();
      plan_for(what, after);
    }
    return std::move(summary_);
  }

 private:
  void carry_out(const Model& model, const Plan& plan, unsigned number) {
    RunOptions options = options_.run;
    options.seed += number;
    options.unplanned = [&](const Unplanned& what) { open_.emplace_back(what, number); };
    const RunSummary done = plan::run(model, plan, options, steps_(model, plan));
    constexpr std::uint64_t kMost = 1'000'000'000'000'000'000ULL;
    summary_.run.states += done.states;
    summary_.run.ends += done.ends;
    summary_.run.branches = std::min(kMost, summary_.run.branches + done.branches);
  }

  void plan_for(const Unplanned& what, unsigned after) {
    Replan made;
    made.outcome = what.outcome;
    made.actions = what.actions;
    made.after = after;
    if (const auto known = known_.find(what.known); known != known_.end()) {
      made.reached = true;
      made.result = known->second.result;
      made.reason = known->second.reason;
      made.nodes = known->second.nodes;
      summary_.replans.push_back(std::move(made));
      return;
    }
    if (plans_.size() >= options_.most) {
      made.reason = "more than " + std::to_string(options_.most) + " new plans are needed";
      summary_.replans.push_back(std::move(made));
      return;
    }
    const auto started = std::chrono::steady_clock::now();
    Model model = load_from(what.known, texts_.domain, texts_.problem ? &*texts_.problem : nullptr,
                            texts_.bindings);
    Solution found = solve(model, options_.solve);
    made.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    made.result = found.outcome;
    made.reason = found.outcome == Outcome::Limit         ? found.limit
                  : found.outcome == Outcome::NotInferred ? found.lost
                  : found.outcome == Outcome::Unsolvable  ? "every possibility was tried"
                                                          : "";
    made.nodes = found.plan.nodes.size();
    known_[what.known] = made;
    summary_.replans.push_back(std::move(made));
    if (found.outcome != Outcome::Solved) return;
    plans_.emplace_back(std::move(model), std::move(found.plan));
    const auto number = static_cast<unsigned>(summary_.replans.size());
    carry_out(plans_.back().first, plans_.back().second, number);
  }

  const TaskTexts& texts_;
  const ReplanOptions& options_;
  const StepsOf& steps_;
  std::deque<std::pair<Unplanned, unsigned>> open_;
  std::map<KnownFacts, Replan> known_;
  std::deque<std::pair<Model, Plan>> plans_;  ///< they outlive what carries out their steps
  ReplanSummary summary_;
};

}  // namespace

bool ReplanSummary::complete() const {
  return std::ranges::all_of(replans, [](const Replan& r) { return r.result == Outcome::Solved; });
}

ReplanSummary run_and_replan(const TaskTexts& texts, const Model& model, const Plan& plan,
                             const ReplanOptions& options, const StepsOf& steps) {
  return Runs(texts, options, steps).run(model, plan);
}

}  // namespace kaboum::plan
