// Greedy best-first search with the relaxed-plan heuristic, preferred operators in a second queue
// that is boosted on progress (Helmert 2006, [helmert2006fd]), and estimates deferred to expansion.
#include <algorithm>
#include <queue>

#include "relaxed_plan.h"
#include "search.h"
#include "state_store.h"

namespace kaboum::plan {
namespace {

struct Open {
  std::uint64_t estimate;
  std::uint64_t order;  // first come, first served
  Index state;
  bool operator>(const Open& o) const {
    return std::pair(estimate, order) > std::pair(o.estimate, o.order);
  }
};
using Queue = std::priority_queue<Open, std::vector<Open>, std::greater<>>;

}  // namespace

Found greedy_best_first(const SearchInput& in) {
  const Index n = in.task.layout().words();
  Found found;
  if (in.target.reached(in.start.data())) {
    found.status = Status::Solved;
    return found;
  }
  if (!in.heuristics.relaxation) in.heuristics.relaxation = std::make_unique<Relaxation>(in.task);
  if (!in.heuristics.relaxed_plan)
    in.heuristics.relaxed_plan = std::make_unique<RelaxedPlan>(in.task, *in.heuristics.relaxation);
  RelaxedPlan& heuristic = *in.heuristics.relaxed_plan;

  StateStore store(n);
  Knowledge scratch(in.task.layout());
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), kNone, 0);
  Queue all, preferred;
  std::vector<char> expanded;
  std::uint64_t order = 0;
  std::uint64_t best = RelaxedPlan::kDeadEnd;
  int boost = 0;
  all.push({0, order++, 0});
  std::vector<Step> steps;
  const auto finish = [&](Status status) {
    in.statistics.states = std::max<std::uint64_t>(in.statistics.states, store.size());
    in.statistics.state_bytes = std::max<std::uint64_t>(in.statistics.state_bytes, store.bytes());
    found.status = status;
    return found;
  };
  bool turn = false;
  while (!all.empty() || !preferred.empty()) {
    if (in.limits.exceeded(store.bytes())) return finish(Status::Limit);
    bool from_preferred = !preferred.empty() && (boost > 0 || turn || all.empty());
    if (boost > 0 && from_preferred) --boost;
    turn = !turn;
    Queue& queue = from_preferred ? preferred : all;
    const Index state = queue.top().state;
    queue.pop();
    if (state >= expanded.size()) expanded.resize(store.size(), 0);
    if (expanded[state]) continue;
    expanded[state] = 1;
    const std::uint64_t h = heuristic.evaluate(store[state]);
    if (state == 0)
      in.statistics.initial_estimate =
          h == RelaxedPlan::kDeadEnd ? -1 : static_cast<std::int64_t>(h);
    if (h == RelaxedPlan::kDeadEnd)
      continue;  // safe: the relaxation overestimates what is possible
    if (h < best) {
      best = h;
      boost = 1000;
    }
    const std::vector<Step> helpful = heuristic.steps();
    in.task.expand(store[state], steps);
    ++in.statistics.expanded;
    for (const Step step : steps) {
      if (in.task.is_outcome(step) && !in.target.allowed(store[state], step)) continue;
      scratch.assign(store[state]);
      if (!in.task.apply(step, scratch)) continue;
      ++in.statistics.generated;
      const auto [number, fresh] = store.insert(scratch.words(), scratch.hash(), state, step);
      if (!fresh) continue;
      if (in.target.reached(scratch.words())) {
        found.steps = store.path(number);
        in.statistics.depth = std::max<std::uint64_t>(in.statistics.depth, found.steps.size());
        return finish(Status::Solved);
      }
      all.push({h, order, number});
      if (std::binary_search(helpful.begin(), helpful.end(), step))
        preferred.push({h, order, number});
      ++order;
    }
  }
  return finish(Status::Unsolvable);
}

}  // namespace kaboum::plan
