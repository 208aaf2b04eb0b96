// Contingent planning by weak plans and their repair, docs/planning/search.md, "Branches".
#include "search/contingent.h"

#include <kaboum/base/error.h>

#include <algorithm>

#include "search/exhaustive.h"

namespace kaboum::plan {

namespace {

constexpr std::size_t kMaximumOpen = 2000;  // nested problems: the recursion's depth

void merge(std::vector<Index>& into, const std::vector<Index>& from) {
  for (const Index d : from)
    if (std::find(into.begin(), into.end(), d) == into.end()) into.push_back(d);
}

}  // namespace

ContingentPlanner::ContingentPlanner(Task& task, SearchFunction search,
                                     const Assumptions& assumptions, Limits& limits,
                                     Statistics& statistics)
    : task_(task),
      search_(search),
      assumptions_(assumptions),
      limits_(limits),
      statistics_(statistics),
      regression_(task) {
  Entry goal;
  goal.condition = task.goal();
  entries_.push_back(std::move(goal));
}

Index ContingentPlanner::match(const Word* state) const {
  for (Index i = 0; i < entries_.size(); ++i)
    if (task_.evaluator().holds(entries_[i].condition, state)) return i;
  return kNone;
}

bool ContingentPlanner::reached(const Word* state) { return match(state) != kNone; }

bool ContingentPlanner::allowed(const Word* state, OperatorId outcome) {
  if (!expects(state, outcome)) return false;
  if (forbidden_.empty()) return true;
  const auto found = forbidden_.find(State(state, state + task_.layout().words()));
  return found == forbidden_.end() || !found->second.contains(task_.outcome(outcome).fluent);
}

/// Equal sub-plans may be entered under several conditions; they are one node of the plan.
Index ContingentPlanner::add(Entry entry) {
  const auto index = static_cast<Index>(entries_.size());
  entry.same_as = index;
  const auto same = [this](Index a) { return entries_[a].same_as; };
  std::uint64_t h = word_hash(entry.branch ? 1 : 0, (Word{entry.step} << 32U) | same(entry.next));
  for (const auto& [step, next] : entry.cases) h += word_hash(step, same(next));
  for (const Index i : entry_index_[h]) {
    const Entry& e = entries_[i];
    const bool equal = e.branch == entry.branch && e.step == entry.step && e.calls == entry.calls &&
                       same(e.next) == same(entry.next) &&
                       std::equal(e.cases.begin(), e.cases.end(), entry.cases.begin(),
                                  entry.cases.end(), [&](const auto& a, const auto& b) {
                                    return a.first == b.first && same(a.second) == same(b.second);
                                  });
    if (!equal) continue;
    if (e.condition == entry.condition) return i;
    entry.same_as = e.same_as;
  }
  entry_index_[h].push_back(index);
  entries_.push_back(std::move(entry));
  return index;
}

/// Enters an action for the state `at`, and all others of its regressed condition.
Index ContingentPlanner::act(const State& at, OperatorId step, Index next) {
  Entry e;
  e.condition = regression_.before(step, entries_[next].condition, at.data());
  e.step = step;
  e.next = next;
  ExternalCalls& calls = task_.calls();
  for (const Index call : task_.action(step).lets) {
    const ExternalCalls::Reply reply = calls.evaluate(call, at.data());
    e.calls.push_back({calls.external(call), calls.argument_names(call, at.data()),
                       task_.model().name_of(reply.value, calls.handles()),
                       calls.payload(reply.leaf)});
  }
  return add(std::move(e));
}

/// The problem at this depth of the stack is no longer open: failures that ran into it are void.
void ContingentPlanner::close_problem(Index depth) {
  const auto ran_into = [depth](const ConflictSet& b) {
    return std::find(b.begin(), b.end(), depth) != b.end();
  };
  std::erase_if(dead_, [&](const auto& d) { return ran_into(d.second); });
  for (auto& [state, fluents] : forbidden_)
    std::erase_if(fluents, [&](const auto& f) { return ran_into(f.second); });
  std::erase_if(forbidden_, [](const auto& f) { return f.second.empty(); });
}

/// Enters `step`, after which `next` goes on, for the state `at`; of an outcome, plans for the
/// others.
Outcome ContingentPlanner::cover(const State& at, OperatorId step, Index next, Index& entry,
                                 ConflictSet& conflict) {
  if (!task_.is_outcome(step)) {
    entry = act(at, step, next);
    return Outcome::Solved;
  }
  const Index fluent = task_.outcome(step).fluent;
  std::vector<std::pair<OperatorId, Index>> cases;
  for (const Index value : task_.outcomes(fluent, at.data())) {
    const OperatorId other = task_.outcome_id(fluent, value);
    Index then = next;
    if (other != step) {
      if (!expects(at.data(), other)) continue;
      Knowledge k(task_.layout());
      k.assign(at.data());
      if (!task_.apply(other, k)) continue;  // cannot happen
      const Outcome s = solve(State(k.words(), k.words() + task_.layout().words()), then, conflict);
      if (s != Outcome::Solved) return s;
    }
    cases.emplace_back(other, then);
  }
  entry = branch(at, std::move(cases));
  return Outcome::Solved;
}

/// Where outcomes of a branch were left out because of what is assumed, that must still be possible
/// wherever the branch is used: not known, and not ruled out. What Kx ties to an atom is required
/// as it is by the regression.
/// @param outcome  of the branch; what is assumed, if anything is.
void ContingentPlanner::require_assumption(const State& at, OperatorId outcome,
                                           std::vector<Formula>& conditions) {
  const auto [fluent, value] = task_.outcome(outcome);
  const Fluent& f = task_.layout().fluents()[fluent];
  const Index values = f.function ? static_cast<Index>(task_.layout().range_size(f)) : 2;
  bool all = true;
  for (Index v = 0; v < values; ++v) all = all && expects(at.data(), task_.outcome_id(fluent, v));
  if (all) return;
  FormulaPool& pool = task_.pool();
  conditions.push_back(pool.bits(f.word, f.mask, at[f.word] & f.mask));
  if (f.exclusion_words > 0)
    conditions.push_back(pool.bits(f.exclusions + value / 64, Word{1} << (value % 64), 0));
}

/// A branch, for the state `at` and all others of its regressed condition.
Index ContingentPlanner::branch(const State& at, std::vector<std::pair<OperatorId, Index>> cases) {
  FormulaPool& pool = task_.pool();
  std::vector<Formula> conditions;
  conditions.reserve(cases.size());
  for (const auto& [outcome, then] : cases)
    conditions.push_back(regression_.before(outcome, entries_[then].condition, at.data()));
  // Values that are ruled out here must be ruled out wherever this branch is used.
  const Index fluent = task_.outcome(cases.front().first).fluent;
  const Fluent& f = task_.layout().fluents()[fluent];
  if (f.function) {
    for (Index v = 0; v < task_.layout().range_size(f); ++v) {
      const OperatorId missing = task_.outcome_id(fluent, v);
      if (std::none_of(cases.begin(), cases.end(),
                       [&](const auto& c) { return c.first == missing; }) &&
          expects(at.data(), missing))
        conditions.push_back(pool.leaf(FormulaPool::Kind::ValueIsNot, fluent, v));
    }
  }
  require_assumption(at, cases.front().first, conditions);
  Entry e;
  e.branch = true;
  e.step = cases.front().first;
  e.condition = pool.all(conditions);
  e.cases = std::move(cases);
  return add(std::move(e));
}

Outcome ContingentPlanner::solve(const State& start, Index& entry, ConflictSet& conflict) {
  entry = match(start.data());
  if (entry != kNone) {
    if (entry != kGoal) ++statistics_.reused;
    return Outcome::Solved;
  }
  if (const auto known = dead_.find(start); known != dead_.end()) {
    conflict = known->second;
    return Outcome::Unsolvable;
  }
  if (const auto open = open_problems_.find(start); open != open_problems_.end()) {
    conflict = {open->second};
    return Outcome::Unsolvable;
  }
  if (open_problems_.size() >= kMaximumOpen) return Outcome::Limit;
  const auto depth = static_cast<Index>(open_problems_.size());
  open_problems_.emplace(start, depth);

  Outcome outcome = Outcome::Limit;
  while (true) {
    ++statistics_.searches;
    const SearchResult found = search_({task_, start, *this, limits_, statistics_, heuristics_});
    if (found.outcome != Outcome::Solved) {
      outcome = found.outcome;
      break;
    }
    std::vector<State> states = {start};
    Knowledge k(task_.layout());
    k.assign(start.data());
    for (const OperatorId step : found.steps) {
      ensure(task_.apply(step, k), "a found plan can be replayed");
      states.emplace_back(k.words(), k.words() + task_.layout().words());
    }
    Index next = match(states.back().data());
    ensure(next != kNone, "a found plan ends at the goal or in the policy");
    if (next != kGoal) ++statistics_.reused;
    bool covered = true;
    for (std::size_t i = found.steps.size(); i-- > 0 && covered;) {
      ConflictSet why;
      const Outcome s = cover(states[i], found.steps[i], next, entry, why);
      if (s == Outcome::Limit) {
        open_problems_.erase(start);
        return s;
      }
      covered = s == Outcome::Solved;
      if (covered) {
        ensure(task_.evaluator().holds(entries_[entry].condition, states[i].data()),
               "regression keeps its own state");
        next = entry;
      } else {
        forbidden_[states[i]][task_.outcome(found.steps[i]).fluent] = std::move(why);
        if (decided_otherwise()) return Outcome::Limit;  // of this search; run() knows better
      }
    }
    if (!covered) continue;
    entry = next;
    outcome = Outcome::Solved;
    break;
  }
  open_problems_.erase(start);
  if (outcome == Outcome::Unsolvable) {
    // It failed for good unless some branch was given up only because of a problem further up.
    conflict.clear();
    for (const auto& [state, fluents] : forbidden_)
      for (const auto& [fluent, why] : fluents) merge(conflict, why);
    std::erase(conflict, depth);
    close_problem(depth);
    dead_[start] = conflict;
    if (conflict.empty()) ++statistics_.dead_ends;
  } else {
    close_problem(depth);
  }
  return outcome;
}

Outcome ContingentPlanner::run() {
  task_.branch(Task::Branching::OnNeed);
  ConflictSet conflict;
  const Outcome outcome = solve(task_.initial(), root_, conflict);
  if (verdict_) return *verdict_;
  if (outcome != Outcome::Unsolvable || !task_.pruned_branch()) return outcome;
  // Nothing is proved yet: branches that nothing needed were left out.
  return exhaust(~std::size_t{0});
}

/// After many failures: a look at all states that costs no more than the searches so far.
bool ContingentPlanner::decided_otherwise() {
  if (++failures_ < next_attempt_) return false;
  next_attempt_ *= 2;
  const Outcome s = exhaust(1000 + 2 * statistics_.expanded);
  if (s != Outcome::Limit) verdict_ = s;
  return verdict_.has_value();
}

Outcome ContingentPlanner::exhaust(std::size_t most_states) {
  task_.branch(Task::Branching::Anywhere);
  ++statistics_.searches;
  Exhaustive all({task_, task_.initial(), *this, limits_, statistics_, heuristics_});
  const Outcome outcome = all.run(most_states);
  task_.branch(Task::Branching::OnNeed);
  if (outcome != Outcome::Solved) return outcome;
  std::vector<Index> entry;  // by decision
  for (const Exhaustive::Decision& d : all.plan()) {
    const Index known = match(d.state.data());
    if (known != kNone) {
      entry.push_back(known);
      continue;
    }
    std::vector<std::pair<OperatorId, Index>> cases = d.cases;
    for (auto& [step, next] : cases) next = entry[next];
    const auto [step, next] = cases.front();
    entry.push_back(task_.is_outcome(step) ? branch(d.state, std::move(cases))
                                           : act(d.state, step, next));
  }
  root_ = entry.back();
  return outcome;
}

Plan ContingentPlanner::plan() const {
  // An action followed by a branch becomes one node; node numbers follow the order of first visit.
  Plan plan;
  std::unordered_map<Index, Index> node_of;
  const Layout& layout = task_.layout();
  std::vector<Index> todo;
  const auto node = [&](Index e) {
    if (e == kGoal) return kNone;
    e = entries_[e].same_as;
    const auto [it, fresh] = node_of.emplace(e, static_cast<Index>(plan.nodes.size()));
    if (fresh) {
      plan.nodes.emplace_back();
      todo.push_back(e);
    }
    return it->second;
  };
  plan.root = node(root_);
  for (std::size_t i = 0; i < todo.size(); ++i) {
    const Entry* e = &entries_[todo[i]];
    const Index n = node_of.at(todo[i]);
    Plan::Node made;
    if (!e->branch) {
      const GroundAction& a = task_.action(e->step);
      made.acts = true;
      made.action = {a.schema, a.arguments};
      made.calls = e->calls;
      if (entries_[e->next].branch) {
        e = &entries_[e->next];
      } else {
        made.next = node(e->next);
      }
    }
    if (e->branch) {
      const Fluent& f = layout.fluents()[task_.outcome(e->step).fluent];
      made.branches = true;
      made.branch = {f.function, f.symbol, f.arguments, {}};
      for (const auto& [step, next] : e->cases) {
        const Index value = task_.outcome(step).value;
        made.branch.cases.push_back(
            {f.function ? task_.model().types[f.range].objects[value] : value, node(next)});
      }
    }
    plan.nodes[n] = std::move(made);
  }
  return plan;
}

}  // namespace kaboum::plan
