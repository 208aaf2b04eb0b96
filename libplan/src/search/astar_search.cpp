// A* with the landmark heuristic; states are reopened, so the plan is of least cost (without
// sensing).
#include <algorithm>
#include <queue>
#include <tuple>

#include "search/landmarks.h"
#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan {

Found a_star(const SearchInput& in) {
  const Index n = in.task.layout().words();
  Found found;
  LandmarkHeuristic& heuristic = in.heuristics.landmark(in.task, in.limits);

  struct Open {
    std::uint64_t f, h, order;
    Index state;
    std::uint64_t g;
    bool operator>(const Open& o) const {
      return std::tuple(f, h, o.order) > std::tuple(o.f, o.h, order);
    }
  };
  constexpr std::uint64_t kDead = ~std::uint64_t{0};
  struct Info {
    std::uint64_t g = 0;
    std::uint64_t h = 0;
  };
  StateStore store(n);
  Knowledge scratch(in.task.layout());
  std::vector<Info> info(1);
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  std::uint64_t order = 0;
  std::size_t most_open = 0;
  const auto bytes = [&] {
    most_open = std::max(most_open, open.size());
    return store.bytes() + info.capacity() * sizeof(Info) + most_open * sizeof(Open);
  };
  const auto finish = [&](Status status) {
    in.statistics.states = std::max<std::uint64_t>(in.statistics.states, store.size());
    in.statistics.state_bytes = std::max<std::uint64_t>(in.statistics.state_bytes, bytes());
    found.status = status;
    return found;
  };
  // A target may hold in states that are no goal states of the task (a known sub-plan): the
  // estimate only speaks of the goal, so it guides there but proves nothing. Without sensing both
  // are the same.
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), kNone, 0);
  const auto start = heuristic.evaluate(in.start.data());
  if (in.statistics.searches == 1)
    in.statistics.initial_estimate = start ? static_cast<std::int64_t>(*start) : -1;
  if (!start) return finish(Status::Unsolvable);
  info[0].h = *start;
  open.push({*start, *start, order++, 0, 0});
  std::vector<Step> steps;
  while (!open.empty()) {
    if (in.limits.check(bytes())) return finish(Status::Limit);
    const Open top = open.top();
    open.pop();
    if (top.g != info[top.state].g) continue;  // a cheaper way was found since
    if (in.target.reached(store[top.state])) {
      found.steps = store.path(top.state);
      in.statistics.depth = std::max<std::uint64_t>(in.statistics.depth, found.steps.size());
      return finish(Status::Solved);
    }
    in.task.expand(store[top.state], steps);
    ++in.statistics.expanded;
    for (const Step step : steps) {
      if (in.task.is_outcome(step) && !in.target.allowed(store[top.state], step)) continue;
      scratch.assign(store[top.state]);
      if (!in.task.apply(step, scratch)) continue;
      in.limits.work();
      ++in.statistics.generated;
      const auto cost = static_cast<std::uint64_t>(in.task.cost(step));
      const auto [number, fresh] = store.insert(scratch.words(), scratch.hash(), top.state, step);
      const std::uint64_t g = top.g + cost;
      if (fresh) {
        const auto h = heuristic.evaluate(scratch.words());
        info.push_back({g, h ? *h : kDead});
      } else {
        if (g >= info[number].g) continue;
        info[number].g = g;
        store.link(number) = {top.state, step};
      }
      if (info[number].h == kDead) continue;
      // Along a path the estimate may drop by no more than the step's cost.
      const std::uint64_t h = std::max(info[number].h, top.h > cost ? top.h - cost : 0);
      open.push({g + h, h, order++, number, g});
    }
  }
  return finish(Status::Unsolvable);
}

}  // namespace kaboum::plan
