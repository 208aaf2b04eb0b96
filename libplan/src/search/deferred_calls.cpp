// Searches that take calls for granted, and what of their results holds.
#include "search/deferred_calls.h"

#include <algorithm>

namespace kaboum::plan {

DeferredCalls::DeferredCalls(const SearchInput& in) : in_(in), start_(in.start) {
  const Task& task = in.task;
  const auto& functions = task.model().external_functions;
  possible_ = !task.layout().sensing() && !task.pool().node(task.goal()).calls &&
              std::ranges::any_of(functions, &ExternalFunction::reads_state);
  for (const Fluent& f : task.layout().fluents())
    if (f.handle) start_[f.word] = (start_[f.word] & ~f.mask) | (kValueUnknown << f.shift);
}

SearchInput DeferredCalls::input() const {
  return {in_.task, start_, in_.target, in_.limits, in_.statistics, in_.heuristics};
}

/// Whether a formula that was made so far, and makes no call, says something of a handle.
bool DeferredCalls::reads_handles() const {
  const FormulaPool& pool = in_.task.pool();
  const std::vector<Fluent>& fluents = in_.task.layout().fluents();
  std::vector<Word> handles(in_.task.layout().words(), 0);
  for (const Fluent& f : fluents)
    if (f.handle) handles[f.word] |= f.mask;
  for (Formula f = 0; f < pool.size(); ++f) {
    const FormulaPool::Node& n = pool.node(f);
    switch (n.kind) {
      case FormulaPool::Kind::ValueIs:
      case FormulaPool::Kind::ValueIsNot:
      case FormulaPool::Kind::ValueWhether:
      case FormulaPool::Kind::ValueKnown:
        if (fluents[n.a].handle) return true;
        break;
      case FormulaPool::Kind::Bits:
        if ((pool.bits_mask(n) & handles[n.a]) != 0) return true;
        break;
      default:
        break;
    }
  }
  return false;
}

bool DeferredCalls::confirms(const SearchResult& found) const {
  if (found.outcome == Outcome::Limit) return in_.limits.exceeded(0);
  if (!all_told_ || reads_handles()) return false;
  if (found.outcome != Outcome::Solved) return true;
  Task& task = in_.task;
  Knowledge state(task.layout());
  state.assign(in_.start.data());
  std::vector<OperatorId> outcomes;
  for (const OperatorId step : found.steps) {
    if (in_.limits.exceeded(0)) return false;
    if (task.asks(step) && !task.decide(state.words(), step, outcomes)) return false;
    if (!task.apply(step, state)) return false;
  }
  return in_.target.reached(state.words());
}

}  // namespace kaboum::plan
