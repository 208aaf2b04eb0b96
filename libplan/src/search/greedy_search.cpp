// Greedy best-first search with two estimates, each with a queue of all states and one of those
// that preferred operators lead to; preferred queues are boosted on progress, and estimates
// deferred to expansion (Helmert 2006, [helmert2006fd]). The relaxed plan guides where deletions do
// little harm, the landmark events where they do.
#include <algorithm>
#include <array>
#include <queue>

#include "search/landmarks.h"
#include "search/relaxed_plan.h"
#include "search/search.h"
#include "search/state_store.h"

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

/// Queues that take turns: the one that was served least, counting boosts.
class Queues {
 public:
  void push(std::size_t queue, const Open& open) {
    queues_[queue].push(open);
    most_ = std::max(most_, ++size_);
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  Index pop() {
    std::size_t next = queues_.size();
    for (std::size_t q = 0; q < queues_.size(); ++q)
      if (!queues_[q].empty() && (next == queues_.size() || served_[q] < served_[next])) next = q;
    ++served_[next];
    --size_;
    const Index state = queues_[next].top().state;
    queues_[next].pop();
    return state;
  }
  void boost(std::size_t queue) { served_[queue] -= 1000; }
  [[nodiscard]] std::size_t bytes() const { return most_ * sizeof(Open); }

 private:
  std::array<std::priority_queue<Open, std::vector<Open>, std::greater<>>, 4> queues_;
  std::array<std::int64_t, 4> served_{};
  std::size_t size_ = 0;
  std::size_t most_ = 0;
};

constexpr std::size_t kRelaxed = 0, kRelaxedPreferred = 1, kEvents = 2, kEventsPreferred = 3;

}  // namespace

Found greedy_best_first(const SearchInput& in) {
  const Index n = in.task.layout().words();
  Found found;
  if (in.target.reached(in.start.data())) {
    found.status = Status::Solved;
    return found;
  }
  RelaxedPlan& relaxed = in.heuristics.relaxed(in.task, in.limits);
  LandmarkHeuristic& landmarks = in.heuristics.landmark(in.task, in.limits);

  StateStore store(n);
  Knowledge scratch(in.task.layout());
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), kNone, 0);
  Queues open;
  std::vector<char> expanded;
  std::uint64_t order = 0;
  std::uint64_t best_relaxed = RelaxedPlan::kDeadEnd;
  std::uint64_t best_events = RelaxedPlan::kDeadEnd;
  bool use_events = true;
  open.push(kRelaxed, {0, order++, 0});
  std::vector<Step> steps;
  const auto bytes = [&] { return store.bytes() + open.bytes() + expanded.capacity(); };
  const auto finish = [&](Status status) {
    in.statistics.states = std::max<std::uint64_t>(in.statistics.states, store.size());
    in.statistics.state_bytes = std::max<std::uint64_t>(in.statistics.state_bytes, bytes());
    found.status = status;
    return found;
  };
  while (!open.empty()) {
    const Index state = open.pop();
    if (state >= expanded.size()) expanded.resize(store.size(), 0);
    if (expanded[state]) continue;
    expanded[state] = 1;
    if (in.limits.check(bytes())) return finish(Status::Limit);
    // Both estimates are safe: what they call a dead end is one.
    const std::uint64_t h = relaxed.evaluate(store[state]);
    if (state == 0 && in.statistics.searches == 1)
      in.statistics.initial_estimate =
          h == RelaxedPlan::kDeadEnd ? -1 : static_cast<std::int64_t>(h);
    if (h == RelaxedPlan::kDeadEnd) continue;
    std::uint64_t events = 0;
    if (use_events) {
      const auto estimate = landmarks.evaluate(store[state]);
      if (!estimate) continue;
      events = *estimate;
      // Not worth it where events are so many that their orders take longer than all the rest.
      const std::size_t count = landmarks.events();
      use_events = count * count * (count / 64 + 1) < 200 * relaxed.size() + 1'000'000;
    }
    if (h < best_relaxed) {
      best_relaxed = h;
      open.boost(kRelaxedPreferred);
    }
    if (use_events && events < best_events) {
      best_events = events;
      open.boost(kEventsPreferred);
    }
    const std::vector<Step> helpful = relaxed.steps();
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
      const bool preferred = std::binary_search(helpful.begin(), helpful.end(), step);
      open.push(kRelaxed, {h, order, number});
      if (preferred) open.push(kRelaxedPreferred, {h, order, number});
      if (use_events) {
        open.push(kEvents, {events, order, number});
        if (preferred) open.push(kEventsPreferred, {events, order, number});
      }
      ++order;
    }
  }
  return finish(Status::Unsolvable);
}

}  // namespace kaboum::plan
