// Landmark events [karpas2009landmarks], [buechner2021cyclic]; claims and bounds by number as in
// docs/planning/search.md, "Landmark events".
#include "search/landmarks.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "search/evaluator.h"
#include "search/relaxed_plan.h"
#include "search/search.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kLargestOption = 4;  // disjunctive landmarks of more facts are left out
constexpr std::size_t kMaximumEvents = 1500;

std::vector<FactId> intersection(const std::vector<FactId>& a, const std::vector<FactId>& b) {
  std::vector<FactId> r;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(r));
  return r;
}

std::vector<FactId> united(const std::vector<FactId>& a, const std::vector<FactId>& b) {
  std::vector<FactId> r;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(r));
  return r;
}

}  // namespace

LandmarkHeuristic::LandmarkHeuristic(Task& task, const Relaxation& relaxation,
                                     const Invariants& invariants, Formula goal)
    : task_(task), relaxation_(relaxation), invariants_(invariants) {
  number_of_.assign(task.action_count(), kNone);
  for (const OperatorId a : relaxation.actions()) {
    number_of_[a] = static_cast<Index>(costs_.size());
    costs_.push_back(task.cost(a));
  }
  // Outcomes of sensing are steps as well, free ones.
  for (const Relaxation::Operator& o : relaxation.operators())
    if (task.is_outcome(o.step) && number_of_outcome_.try_emplace(o.step, costs_.size()).second)
      costs_.push_back(0);
  words_ = (costs_.size() + 63) / 64;
  achievers_.resize(relaxation.facts().size());
  common_.resize(relaxation.facts().size());
  common_ready_.assign(relaxation.facts().size(), 0);
  infos_.resize(relaxation.facts().size());
  const auto& operators = relaxation.operators();
  for (Index o = 0; o < operators.size(); ++o)
    for (const FactId f : operators[o].adds) achievers_[f].push_back(o);
  // Facts that disjunctive knowledge can bring about without a step are no events.
  const auto opaque = [&](FactId f) {
    const Fluent& fluent = task.layout().fluents()[relaxation.facts().fluent_of(f)];
    return !fluent.groups.empty() || fluent.exclusions != kNone || fluent.handle;
  };
  opaque_.resize(relaxation.facts().size());
  for (FactId f = 0; f < relaxation.facts().size(); ++f) opaque_[f] = opaque(f) ? 1 : 0;
  for (const FactId f : relaxation.necessary_facts(goal))
    if (!opaque_[f]) goals_.push_back(f);
  goals_in_group_.resize(invariants.groups());
  for (Index g = 0; g < goals_.size(); ++g)
    for (const Index group : invariants.groups_of(goals_[g])) goals_in_group_[group].push_back(g);
}

/// Facts that every achiever of `f` needs.
std::vector<FactId> LandmarkHeuristic::common_conditions(FactId f) {
  if (!common_ready_[f]) {
    common_ready_[f] = 1;
    bool first = true;
    for (const Index o : achievers_[f]) {
      const auto& conditions = relaxation_.operators()[o].preconditions;
      common_[f] = first ? conditions : intersection(common_[f], conditions);
      first = false;
    }
  }
  return common_[f];
}

LandmarkHeuristic::FactInfo& LandmarkHeuristic::info(FactId f) {
  FactInfo& info = infos_[f];
  if (info.ready) return info;
  info.ready = true;
  info.conditions = common_conditions(f);
  std::map<std::vector<FactId>, std::vector<Index>> by_guards;
  for (const Index o : achievers_[f]) {
    // A condition that itself needs f first cannot lead to f's first achievement, unless it holds
    // now.
    std::vector<FactId> guards;
    for (const FactId c : relaxation_.operators()[o].preconditions) {
      if (c == f || opaque_[c]) continue;
      common_conditions(c);
      if (std::binary_search(common_[c].begin(), common_[c].end(), f)) guards.push_back(c);
    }
    by_guards[guards].push_back(o);
  }
  for (const auto& [guards, operators] : by_guards) {
    Bucket b;
    b.guards = guards;
    b.actions.assign(words_, 0);
    bool first = true;
    std::map<std::pair<bool, Index>, std::vector<FactId>> options;
    for (const Index o : operators) {
      const Relaxation::Operator& op = relaxation_.operators()[o];
      const Index number =
          task_.is_outcome(op.step) ? number_of_outcome_.at(op.step) : number_of_[op.step];
      b.actions[number / 64] |= std::uint64_t{1} << (number % 64);
      b.conditions = first ? op.preconditions : intersection(b.conditions, op.preconditions);
      std::map<std::pair<bool, Index>, std::vector<FactId>> mine;
      for (const FactId c : op.preconditions) {
        const Fluent& fluent = task_.layout().fluents()[relaxation_.facts().fluent_of(c)];
        if (!opaque_[c]) mine[{fluent.function, fluent.symbol}].push_back(c);
      }
      if (first) {
        options = std::move(mine);
      } else {
        std::erase_if(options, [&](const auto& e) { return !mine.contains(e.first); });
        for (auto& [symbol, facts] : options) facts = united(facts, mine[symbol]);
      }
      std::erase_if(options, [](const auto& e) { return e.second.size() > kLargestOption; });
      first = false;
    }
    for (auto& [symbol, facts] : options)
      if (facts.size() > 1) b.options.push_back(std::move(facts));
    info.buckets.push_back(std::move(b));
  }
  std::set<Index> excludes;
  for (const Index group : invariants_.groups_of(f))
    for (const Index g : goals_in_group_[group]) excludes.insert(g);
  for (Index g = 0; g < goals_.size(); ++g)
    if (relaxation_.facts().fluent_of(goals_[g]) == relaxation_.facts().fluent_of(f))
      excludes.insert(g);
  for (const Index g : excludes)
    if (goals_[g] != f) info.excludes.push_back(g);
  return info;
}

Index LandmarkHeuristic::first_event(std::vector<FactId> facts, const Word* state) {
  const auto [it, fresh] = first_.emplace(facts, static_cast<Index>(events_.size()));
  if (!fresh) return it->second;
  LandmarkEvent e;
  e.facts = std::move(facts);
  e.actions.assign(words_, 0);
  bool first = true;
  bool one_bucket = true;
  for (const FactId f : e.facts)
    for (const Bucket& b : info(f).buckets) {
      if (!std::all_of(b.guards.begin(), b.guards.end(),
                       [&](FactId g) { return relaxation_.facts().holds(g, state); }))
        continue;
      for (std::size_t i = 0; i < words_; ++i) e.actions[i] |= b.actions[i];
      e.conditions = first ? b.conditions : intersection(e.conditions, b.conditions);
      if (first) {
        e.options = b.options;
      } else {
        one_bucket = false;
      }
      first = false;
    }
  if (!one_bucket && e.facts.size() == 1) {
    // Options of several buckets: unite those of the same symbol.
    std::vector<std::vector<FactId>> merged;
    for (const auto& option : e.options) {
      const Fluent& symbol = task_.layout().fluents()[relaxation_.facts().fluent_of(option[0])];
      std::vector<FactId> all = option;
      bool everywhere = true;
      for (const Bucket& b : info(e.facts[0]).buckets) {
        if (!std::all_of(b.guards.begin(), b.guards.end(),
                         [&](FactId g) { return relaxation_.facts().holds(g, state); }))
          continue;
        const auto same = std::find_if(b.options.begin(), b.options.end(), [&](const auto& o) {
          const Fluent& f = task_.layout().fluents()[relaxation_.facts().fluent_of(o[0])];
          return f.function == symbol.function && f.symbol == symbol.symbol;
        });
        everywhere = everywhere && same != b.options.end();
        if (everywhere) all = united(all, *same);
      }
      if (everywhere && all.size() <= kLargestOption) merged.push_back(std::move(all));
    }
    e.options = std::move(merged);
  } else if (!one_bucket) {
    e.options.clear();
  }
  if (first) dead_ = true;  // nothing can achieve it first
  events_.push_back(std::move(e));
  return static_cast<Index>(events_.size() - 1);
}

Index LandmarkHeuristic::last_event(Index goal) {
  if (last_[goal] != kNone) return last_[goal];
  last_[goal] = static_cast<Index>(events_.size());
  const FactInfo& i = info(goals_[goal]);
  LandmarkEvent e;
  e.last = true;
  e.facts = {goals_[goal]};
  e.actions.assign(words_, 0);
  e.conditions = i.conditions;
  for (const Bucket& b : i.buckets)
    for (std::size_t w = 0; w < words_; ++w) e.actions[w] |= b.actions[w];
  if (i.buckets.size() == 1) e.options = i.buckets[0].options;
  if (i.buckets.empty()) dead_ = true;
  events_.push_back(std::move(e));
  return last_[goal];
}

void LandmarkHeuristic::order(Index before, Index after, bool strict) {
  if (before != after || strict) orders_.push_back({before, after, strict});
}

/// Draws the conclusions of one event. @return false if there are too many events to go on.
bool LandmarkHeuristic::relate(Index event, const Word* state) {
  if (events_.size() > kMaximumEvents) return false;
  const LandmarkEvent e = events_[event];
  for (const FactId p : e.conditions) {
    if (opaque_[p]) continue;
    if (!relaxation_.facts().holds(p, state)) order(first_event({p}, state), event, true);
    // p holds just before the event: goals that exclude it are achieved (again) with it or later.
    for (const Index g : info(p).excludes) order(event, last_event(g), false);
  }
  for (const auto& option : e.options) {
    if (std::any_of(option.begin(), option.end(),
                    [&](FactId f) { return relaxation_.facts().holds(f, state); }))
      continue;
    order(first_event(option, state), event, true);
  }
  if (e.facts.size() == 1) {
    // The fact holds just after the event: excluded goals are achieved strictly later.
    for (const Index g : info(e.facts[0]).excludes) order(event, last_event(g), true);
    if (!e.last)
      for (Index g = 0; g < goals_.size(); ++g)
        if (goals_[g] == e.facts[0]) order(event, last_event(g), false);
  }
  return true;
}

std::optional<std::uint64_t> LandmarkHeuristic::evaluate(const Word* state) {
  if (!find_events(state)) return std::nullopt;
  return event_bound(events_, orders_, costs_);
}

std::optional<std::uint64_t> LandmarkHeuristic::count(const Word* state) {
  if (!find_events(state)) return std::nullopt;
  return distinct_events(events_, orders_);
}

ActionSet LandmarkHeuristic::achievers() const {
  ActionSet all(words_, 0);
  for (const LandmarkEvent& e : events_)
    for (std::size_t w = 0; w < words_; ++w) all[w] |= e.actions[w];
  return all;
}

std::vector<std::vector<FactId>> LandmarkHeuristic::landmarks() const {
  std::vector<std::vector<FactId>> out;
  for (const LandmarkEvent& e : events_)
    if (!e.last) out.push_back(e.facts);
  return out;
}

/// @return false: a dead end.
bool LandmarkHeuristic::find_events(const Word* state) {
  events_.clear();
  first_.clear();
  orders_.clear();
  last_.assign(goals_.size(), kNone);
  dead_ = false;
  for (Index g = 0; g < goals_.size(); ++g)
    if (!relaxation_.facts().holds(goals_[g], state)) last_event(g);
  for (Index i = 0; i < events_.size() && !dead_; ++i)
    if (!relate(i, state)) break;
  return !dead_;
}

namespace {

constexpr std::uint64_t kPerEvent = 1'500;  // work

/// How many steps are left at least, by events that cannot be one step.
class LandmarkSteps final : public Evaluator {
 public:
  /// @param worth  work that pays off for each evaluation.
  LandmarkSteps(LandmarkHeuristic& landmarks, std::uint64_t worth)
      : landmarks_(landmarks), worth_(worth) {}

  Estimate evaluate(const Word* state) override {
    const auto steps = landmarks_.count(state);
    if (!steps) return {0, true, 0};
    return {*steps, false, kPerEvent * landmarks_.events() + triples()};
  }
  [[nodiscard]] bool is_safe() const override { return true; }
  /// Not where events are so many that their orders take longer than all the rest.
  [[nodiscard]] bool is_worthwhile() const override { return triples() < worth_; }

  void prefer(std::span<const OperatorId> steps, std::vector<char>& marked) const override {
    const ActionSet awaited = landmarks_.achievers();
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (landmarks_.is_in(steps[i], awaited)) marked[i] = 1;
  }

 private:
  [[nodiscard]] std::uint64_t triples() const {
    const std::uint64_t events = landmarks_.events();
    return events * events * (events / 64 + 1);
  }

  LandmarkHeuristic& landmarks_;
  std::uint64_t worth_;
};

class LandmarkCost final : public Evaluator {
 public:
  explicit LandmarkCost(LandmarkHeuristic& landmarks) : landmarks_(landmarks) {}

  Estimate evaluate(const Word* state) override {
    const auto cost = landmarks_.evaluate(state);
    return {cost.value_or(0), !cost, 0};
  }
  [[nodiscard]] bool is_safe() const override { return true; }
  [[nodiscard]] bool is_admissible() const override { return true; }

 private:
  LandmarkHeuristic& landmarks_;
};

}  // namespace

std::unique_ptr<Evaluator> landmark_steps(Task& task, Limits& limits, Heuristics& heuristics) {
  const std::uint64_t worth = 200 * heuristics.relaxed(task, limits).size() + 1'000'000;
  return std::make_unique<LandmarkSteps>(heuristics.landmark(task, limits), worth);
}

std::unique_ptr<Evaluator> landmark_cost(Task& task, Limits& limits, Heuristics& heuristics) {
  return std::make_unique<LandmarkCost>(heuristics.landmark(task, limits));
}

}  // namespace kaboum::plan
