// Execution with replanning: from each state that the plan has no branch for, a plan of its own.
#include <kaboum/plan/replan.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <set>
#include <utility>

namespace kaboum::plan {
namespace {

std::string unsolvable_because(const Solution& s) {
  return s.refused.empty() ? "every possibility was tried" : s.refused;
}

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
    if (options_.planning) options_.planning(what, after);
    const auto number = static_cast<unsigned>(summary_.replans.size()) + 1;
    const auto [known, fresh] = known_.try_emplace(what.known, number);
    if (!fresh) {
      const Replan& then = summary_.replans[known->second - 1];
      made.reached = true;
      made.circle = leads_to(known->second, after);
      made.plan = then.plan;
      made.result = then.result;
      made.reason = made.circle ? "the plan for this leads back to it" : then.reason;
      made.nodes = then.nodes;
      goes_on_[after].push_back(known->second);
      add(std::move(made));
      return;
    }
    goes_on_[after].push_back(number);
    if (plans_.size() >= options_.most) {
      made.reason = "more than " + std::to_string(options_.most) + " new plans are needed";
      add(std::move(made));
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
                  : found.outcome == Outcome::Unsolvable  ? unsolvable_because(found)
                                                          : "";
    made.nodes = found.plan.nodes.size();
    if (found.outcome == Outcome::Solved) made.plan = static_cast<unsigned>(plans_.size()) + 1;
    add(std::move(made));
    if (found.outcome != Outcome::Solved) return;
    plans_.emplace_back(std::move(model), std::move(found.plan));
    carry_out(plans_.back().first, plans_.back().second, number);
  }

  void add(Replan made) {
    summary_.replans.push_back(std::move(made));
    if (options_.planned) options_.planned(summary_.replans.back());
  }

  /// Whether carrying out the plan `from` has come to that of number `to`.
  [[nodiscard]] bool leads_to(unsigned from, unsigned to) const {
    std::set<unsigned> seen = {from};
    std::vector<unsigned> open = {from};
    while (!open.empty()) {
      const unsigned at = open.back();
      open.pop_back();
      if (at == to) return true;
      if (const auto next = goes_on_.find(at); next != goes_on_.end())
        for (const unsigned n : next->second)
          if (seen.insert(n).second) open.push_back(n);
    }
    return false;
  }

  const TaskTexts& texts_;
  const ReplanOptions& options_;
  const StepsOf& steps_;
  std::deque<std::pair<Unplanned, unsigned>> open_;
  std::map<KnownFacts, unsigned> known_;  ///< states, and which of the replans is for them, from 1
  std::map<unsigned, std::vector<unsigned>> goes_on_;  ///< plans, and those that take over
  std::deque<std::pair<Model, Plan>> plans_;  ///< they outlive what carries out their steps
  ReplanSummary summary_;
};

}  // namespace

bool ReplanSummary::complete() const {
  return std::ranges::all_of(
      replans, [](const Replan& r) { return r.result == Outcome::Solved && !r.circle; });
}

ReplanSummary run_and_replan(const TaskTexts& texts, const Model& model, const Plan& plan,
                             const ReplanOptions& options, const StepsOf& steps) {
  return Runs(texts, options, steps).run(model, plan);
}

}  // namespace kaboum::plan
