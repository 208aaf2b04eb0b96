// The relaxed plan [hoffmann2001ff] with additive costs, by a generalised Dijkstra search over what
// matters to the goal.
#include "search/relaxed_plan.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "search/engine.h"
#include "search/evaluator.h"

namespace kaboum::plan {
namespace {

constexpr std::uint32_t kLargest = std::uint32_t{1} << 30U;  // sums may grow exponentially
constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kMostTries = 16;

}  // namespace

/// The and-or graph without what does not matter to the goal, and without conjunctions that only
/// are parts of one other.
class RelaxedPlan::Builder {
  using Node = Relaxation::Node;

 public:
  Builder(RelaxedPlan& plan, const Relaxation& relaxation)
      : plan_(plan),
        relaxation_(relaxation),
        nodes_(relaxation.nodes()),
        operator_of_(nodes_.size(), kNone),
        parents_(nodes_.size(), 0),
        matters_(nodes_.size(), 0),
        ref_(nodes_.size(), 0) {}

  void build(Index goal) {
    const auto& operators = relaxation_.operators();
    for (Index o = 0; o < operators.size(); ++o) operator_of_[operators[o].node] = o;
    for (const auto& n : nodes_)
      for (const Index c : n.children) ++parents_[c];
    find_what_matters(goal);
    for (Index n = 0; n < nodes_.size(); ++n) {
      if (!matters_[n]) continue;
      if (nodes_[n].kind != Node::Kind::All) {
        ref_[n] = static_cast<Ref>(values_.size()) | kValue;
        values_.push_back(n);
      } else if (n == goal || !is_part(n)) {
        ref_[n] = static_cast<Ref>(conjunctions_.size());
        conjunctions_.push_back(n);
      }
    }
    plan_.goal_ = ref_[goal];
    make_conjunctions();
    make_values();
  }

 private:
  /// Whether its children stand for it in every conjunction that it is part of.
  [[nodiscard]] bool is_part(Index n) const {
    return nodes_[n].kind == Node::Kind::All && operator_of_[n] == kNone && !option_[n] &&
           (parents_[n] <= 1 || nodes_[n].children.size() <= 1);
  }

  void find_what_matters(Index goal) {
    const auto& operators = relaxation_.operators();
    std::vector<std::vector<Index>> achievers(relaxation_.facts().size());
    for (const auto& o : operators)
      for (const FactId f : o.adds) achievers[f].push_back(o.node);
    option_.assign(nodes_.size(), 0);
    std::vector<Index> todo = {goal};
    matters_[goal] = 1;
    const auto want = [&](Index n) {
      if (matters_[n]) return;
      matters_[n] = 1;
      todo.push_back(n);
    };
    while (!todo.empty()) {
      const Index n = todo.back();
      todo.pop_back();
      for (const Index c : nodes_[n].children) {
        if (nodes_[n].kind == Node::Kind::Any) option_[c] = 1;
        want(c);
      }
      if (nodes_[n].kind == Node::Kind::Fact)
        for (const Index a : achievers[n]) want(a);
    }
  }

  void collect(Index n, Index goal, std::vector<Index>& out) const {
    for (const Index c : nodes_[n].children) {
      if (c != goal && is_part(c)) {
        collect(c, goal, out);
      } else {
        out.push_back(ref_[c]);
      }
    }
  }

  void make_conjunctions() {
    const auto count = static_cast<Index>(conjunctions_.size());
    std::vector<std::vector<Index>> part_of(count);
    needed_by_.resize(values_.size());
    for (Index a = 0; a < count; ++a) {
      const Index n = conjunctions_[a];
      std::vector<Index> children;
      collect(n, plan_.goal_ < kValue ? conjunctions_[plan_.goal_] : kNone, children);
      std::sort(children.begin(), children.end());
      children.erase(std::unique(children.begin(), children.end()), children.end());
      for (const Ref c : children) {
        if (c >= kValue) {
          needed_by_[c - kValue].push_back(a);
        } else {
          part_of[c].push_back(a);
        }
      }
      if (children.empty()) plan_.empty_.push_back(a);
      plan_.children_.add(children);
      plan_.size_ += children.size() + 1;
      add_step(a, n, static_cast<Index>(children.size()));
    }
    for (const auto& p : part_of) plan_.part_of_.add(p);
  }

  void add_step(Index a, Index n, Index children) {
    const Index o = operator_of_[n];
    if (o == kNone) {
      plan_.step_.push_back(kNoOperator);
      plan_.at_start_.push_back({children, 0});
      return;
    }
    const OperatorId step = relaxation_.operators()[o].step;
    plan_.step_.push_back(step);
    plan_.at_start_.push_back({children, plan_.cost_of(step)});
    if (plan_.task_.asks(step)) plan_.asking_.push_back(a);
  }

  void make_values() {
    const auto& operators = relaxation_.operators();
    std::vector<std::vector<Index>> brings(conjunctions_.size()), option_of(values_.size());
    for (Index v = 0; v < values_.size(); ++v) {
      if (nodes_[values_[v]].kind != Node::Kind::Any) continue;
      for (const Index c : nodes_[values_[v]].children) {
        if (ref_[c] >= kValue) {
          option_of[ref_[c] - kValue].push_back(v);
        } else {
          brings[ref_[c]].push_back(v);
        }
      }
    }
    for (Index a = 0; a < conjunctions_.size(); ++a) {
      const Index o = operator_of_[conjunctions_[a]];
      if (o != kNone)
        for (const FactId f : operators[o].adds)
          if (matters_[f]) brings[a].push_back(ref_[f] - kValue);
      plan_.size_ += brings[a].size();
      plan_.brings_.add(brings[a]);
    }
    for (Index v = 0; v < values_.size(); ++v) {
      plan_.needed_by_.add(needed_by_[v]);
      plan_.option_of_.add(option_of[v]);
    }
    const FactTable& facts = relaxation_.facts();
    for (FactId f = 0; f < facts.size();) {
      const Index fluent = facts.fluent_of(f);
      const Word contents = facts.contents(fluent);
      bool any = false;
      for (Word c = 0; c < contents; ++c) any |= matters_[f + c] != 0;
      if (any) {
        plan_.fluents_.push_back(fluent);
        plan_.contents_.push_back(contents);
        plan_.first_fact_.push_back(static_cast<Index>(plan_.value_of_.size()));
        for (Word c = 0; c < contents; ++c)
          plan_.value_of_.push_back(matters_[f + c] ? ref_[f + c] - kValue : kNone);
      }
      f += static_cast<FactId>(contents);
    }
  }

  RelaxedPlan& plan_;
  const Relaxation& relaxation_;
  const std::vector<Relaxation::Node>& nodes_;
  std::vector<Index> operator_of_;            ///< by node
  std::vector<Index> parents_;                ///< by node: their number
  std::vector<char> matters_;                 ///< by node
  std::vector<char> option_;                  ///< by node: of a disjunction
  std::vector<Ref> ref_;                      ///< by node
  std::vector<Index> values_, conjunctions_;  ///< nodes
  std::vector<std::vector<Index>> needed_by_;
};

RelaxedPlan::RelaxedPlan(Task& task, Relaxation& relaxation, Formula goal) : task_(task) {
  const Index node = relaxation.node(goal);
  Builder(*this, relaxation).build(node);
  cost_.resize(needed_by_.first.size() - 1);
  supporter_.resize(cost_.size());
  seen_value_.assign(cost_.size(), 0);
  seen_conjunction_.assign(step_.size(), 0);
}

RelaxedPlan::Cost RelaxedPlan::cost_of(OperatorId step) const {
  if (task_.is_outcome(step)) return 0;
  const GroundAction& a = task_.action(step);
  const std::uint64_t tries = (std::uint64_t{a.granted} + a.refused + 1) / (a.granted + 1);
  return static_cast<Cost>(std::min(tries, kMostTries));
}

void RelaxedPlan::settle(Index value, Cost cost, Ref supporter) {
  if (cost >= cost_[value]) return;
  cost_[value] = cost;
  supporter_[value] = supporter;
  queue_.push(cost, value);
}

/// A part of a conjunction holds.
void RelaxedPlan::count(Index conjunction, Cost cost) {
  Counter& c = counters_[conjunction];
  c.sum = std::min(c.sum + cost, kLargest);
  if (--c.missing == 0) complete_.push_back(conjunction);
}

/// Draws the consequences of conjunctions that hold: their costs will not change any more.
void RelaxedPlan::complete() {
  while (!complete_.empty()) {
    const Index a = complete_.back();
    complete_.pop_back();
    if (a == goal_) reached_ = true;
    walked_ += brings_.size(a);
    const Cost cost = counters_[a].sum;
    // Of two that cost the same the first supports, in every state: relaxed plans share more steps
    // then and change less between states. (What is free might come to support itself.)
    const bool replaces = at_start_[a].sum > 0;
    for (const Index *v = brings_.begin(a), *end = brings_.end(a); v != end; ++v)
      if (replaces && cost == cost_[*v] && a < supporter_[*v]) {
        supporter_[*v] = a;
      } else {
        settle(*v, cost, a);
      }
    for (const Index *p = part_of_.begin(a), *end = part_of_.end(a); p != end; ++p) count(*p, cost);
  }
}

void RelaxedPlan::explore(const Word* state) {
  for (const Index a : asking_) at_start_[a].sum = cost_of(step_[a]);
  counters_ = at_start_;
  std::fill(cost_.begin(), cost_.end(), kUnreached);
  queue_.clear();
  complete_ = empty_;
  reached_ = false;
  walked_ = counters_.size() / 8;
  const auto& fluents = task_.layout().fluents();
  for (Index i = 0; i < fluents_.size(); ++i) {
    const Word content = std::min(fluents[fluents_[i]].get(state), contents_[i] - 1);
    const Index value = value_of_[first_fact_[i] + content];
    if (value != kNone) settle(value, 0, kNone);
  }
  complete();
  while (!reached_ && !queue_.empty()) {
    const auto [cost, value] = queue_.pop();
    if (cost != cost_[value]) continue;
    if ((value | kValue) == goal_) {
      reached_ = true;
      return;
    }
    for (const Index *d = option_of_.begin(value), *end = option_of_.end(value); d != end; ++d)
      settle(*d, cost, value | kValue);
    walked_ += needed_by_.size(value);
    for (const Index *a = needed_by_.begin(value), *end = needed_by_.end(value); a != end; ++a)
      count(*a, cost);
    complete();
  }
}

/// Puts the plan together from the goal; each action counts once.
std::uint64_t RelaxedPlan::extract() {
  const auto want = [&](Ref r) {
    char& seen = r >= kValue ? seen_value_[r - kValue] : seen_conjunction_[r];
    if (seen) return;
    seen = 1;
    seen_.push_back(r);
    todo_.push_back(r);
  };
  want(goal_);
  while (!todo_.empty()) {
    const Ref r = todo_.back();
    todo_.pop_back();
    if (r >= kValue) {
      if (supporter_[r - kValue] != kNone) want(supporter_[r - kValue]);
      continue;
    }
    if (step_[r] != kNoOperator) {
      steps_.push_back(step_[r]);
      used_.emplace_back(counters_[r].sum, step_[r]);
    }
    for (const Index *c = children_.begin(r), *end = children_.end(r); c != end; ++c) want(*c);
  }
  for (const Ref r : seen_) (r >= kValue ? seen_value_[r - kValue] : seen_conjunction_[r]) = 0;
  seen_.clear();
  std::sort(steps_.begin(), steps_.end());
  steps_.erase(std::unique(steps_.begin(), steps_.end()), steps_.end());
  std::uint64_t total = 0;
  for (const OperatorId s : steps_) total += cost_of(s);
  return total;
}

std::vector<OperatorId> RelaxedPlan::steps_in_order() const {
  auto ordered = used_;
  // Of a step, the effect that comes first.
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second, a.first) < std::pair(b.second, b.first);
  });
  ordered.erase(std::unique(ordered.begin(), ordered.end(),
                            [](const auto& a, const auto& b) { return a.second == b.second; }),
                ordered.end());
  std::sort(ordered.begin(), ordered.end());
  std::vector<OperatorId> steps;
  steps.reserve(ordered.size());
  for (const auto& [cost, step] : ordered) steps.push_back(step);
  return steps;
}

std::uint64_t RelaxedPlan::evaluate(const Word* state) {
  steps_.clear();
  used_.clear();
  explore(state);
  return reached_ ? extract() : kDeadEnd;
}

namespace {

constexpr std::uint64_t kPerState = 5'000;  // work, besides that of edges

class RelaxedPlanSteps final : public Evaluator {
 public:
  explicit RelaxedPlanSteps(RelaxedPlan& plan) : plan_(plan) {}

  Estimate evaluate(const Word* state) override {
    const std::uint64_t steps = plan_.evaluate(state);
    return {steps, steps == RelaxedPlan::kDeadEnd, kPerState + kPerEdge * plan_.walked()};
  }
  [[nodiscard]] std::size_t size() const override { return plan_.size(); }
  [[nodiscard]] bool is_safe() const override { return true; }

  void prefer(std::span<const OperatorId> steps, std::vector<char>& marked) const override {
    const std::vector<OperatorId>& own = plan_.steps();
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (std::binary_search(own.begin(), own.end(), steps[i])) marked[i] = 1;
  }
  [[nodiscard]] std::vector<OperatorId> outline() const override { return plan_.steps_in_order(); }

 private:
  RelaxedPlan& plan_;
};

}  // namespace

std::unique_ptr<Evaluator> relaxed_plan_steps(Task& task, Limits& limits, Heuristics& heuristics) {
  return std::make_unique<RelaxedPlanSteps>(heuristics.relaxed(task, limits));
}

}  // namespace kaboum::plan
