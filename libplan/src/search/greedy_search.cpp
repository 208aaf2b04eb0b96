// Greedy best-first search with two estimates, each with a queue of all states and one of those
// that preferred operators lead to; preferred queues are boosted on progress, and estimates
// deferred to expansion [helmert2006fd]. The relaxed plan guides where deletions do
// little harm, the landmark events where they do.
#include <algorithm>
#include <array>
#include <optional>
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

constexpr std::size_t kRelaxed = 0, kRelaxedPreferred = 1, kEvents = 2, kEventsPreferred = 3;

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
  void boost(std::size_t queue) { served_[queue] -= kBoost; }
  [[nodiscard]] std::size_t bytes() const { return most_ * sizeof(Open); }

 private:
  static constexpr std::int64_t kBoost = 1000;  // turns, on progress

  std::array<std::priority_queue<Open, std::vector<Open>, std::greater<>>, 4> queues_;
  std::array<std::int64_t, 4> served_{};
  std::size_t size_ = 0;
  std::size_t most_ = 0;
};

class GreedySearch {
 public:
  explicit GreedySearch(const SearchInput& in)
      : in_(in),
        relaxed_(in.heuristics.relaxed(in.task, in.limits)),
        landmarks_(in.heuristics.landmark(in.task, in.limits)),
        words_(in.task.layout().words()),
        store_(words_),
        scratch_(in.task.layout()) {}

  Found run() {
    store_.insert(in_.start.data(), Knowledge::hash_of(in_.start.data(), words_), kNone, 0);
    open_.push(kRelaxed, {0, order_++, 0});
    while (!open_.empty()) {
      const Index state = open_.pop();
      if (state >= expanded_.size()) expanded_.resize(store_.size(), 0);
      if (expanded_[state]) continue;
      expanded_[state] = 1;
      if (in_.limits.check(bytes())) return finish(Outcome::Limit);
      const std::optional<Estimates> estimates = evaluate(state);
      if (!estimates) continue;
      note_progress(*estimates);
      if (expand(state, *estimates)) return finish(Outcome::Solved);
    }
    return finish(Outcome::Unsolvable);
  }

 private:
  struct Estimates {
    std::uint64_t relaxed = 0;
    std::uint64_t events = 0;
  };

  /// nullopt: a dead end. Both estimates are safe: what they call one is one.
  std::optional<Estimates> evaluate(Index state) {
    Estimates e;
    e.relaxed = relaxed_.evaluate(store_[state]);
    const bool dead = e.relaxed == RelaxedPlan::kDeadEnd;
    if (state == 0 && in_.statistics.searches == 1)
      in_.statistics.initial_estimate = dead ? -1 : static_cast<std::int64_t>(e.relaxed);
    if (dead) return std::nullopt;
    if (!use_events_) return e;
    const auto events = landmarks_.evaluate(store_[state]);
    if (!events) return std::nullopt;
    e.events = *events;
    // Not worth it where events are so many that their orders take longer than all the rest.
    const std::size_t count = landmarks_.events();
    use_events_ = count * count * (count / 64 + 1) < 200 * relaxed_.size() + 1'000'000;
    return e;
  }

  void note_progress(const Estimates& e) {
    if (e.relaxed < best_.relaxed) {
      best_.relaxed = e.relaxed;
      open_.boost(kRelaxedPreferred);
    }
    if (use_events_ && e.events < best_.events) {
      best_.events = e.events;
      open_.boost(kEventsPreferred);
    }
  }

  /// @return whether a successor reaches the target.
  bool expand(Index state, const Estimates& estimates) {
    const std::vector<OperatorId> helpful = relaxed_.steps();
    in_.task.expand(store_[state], steps_);
    ++in_.statistics.expanded;
    for (const OperatorId step : steps_) {
      if (in_.task.is_outcome(step) && !in_.target.allowed(store_[state], step)) continue;
      scratch_.assign(store_[state]);
      if (!in_.task.apply(step, scratch_)) continue;
      ++in_.statistics.generated;
      const auto [number, fresh] = store_.insert(scratch_.words(), scratch_.hash(), state, step);
      if (!fresh) continue;
      if (in_.target.reached(scratch_.words())) {
        found_.steps = store_.path(number);
        in_.statistics.depth = std::max<std::uint64_t>(in_.statistics.depth, found_.steps.size());
        return true;
      }
      push(number, estimates, std::binary_search(helpful.begin(), helpful.end(), step));
    }
    return false;
  }

  void push(Index state, const Estimates& e, bool preferred) {
    open_.push(kRelaxed, {e.relaxed, order_, state});
    if (preferred) open_.push(kRelaxedPreferred, {e.relaxed, order_, state});
    if (use_events_) {
      open_.push(kEvents, {e.events, order_, state});
      if (preferred) open_.push(kEventsPreferred, {e.events, order_, state});
    }
    ++order_;
  }

  [[nodiscard]] std::size_t bytes() const {
    return store_.bytes() + open_.bytes() + expanded_.capacity();
  }

  Found finish(Outcome outcome) {
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes());
    found_.outcome = outcome;
    return std::move(found_);
  }

  const SearchInput& in_;
  RelaxedPlan& relaxed_;
  LandmarkHeuristic& landmarks_;
  Index words_;
  StateStore store_;
  Knowledge scratch_;
  Queues open_;
  std::vector<char> expanded_;
  std::uint64_t order_ = 0;
  Estimates best_{RelaxedPlan::kDeadEnd, RelaxedPlan::kDeadEnd};
  bool use_events_ = true;
  std::vector<OperatorId> steps_;
  Found found_;
};

}  // namespace

Found greedy_best_first(const SearchInput& in) {
  if (in.target.reached(in.start.data())) return {Outcome::Solved, {}};
  return GreedySearch(in).run();
}

}  // namespace kaboum::plan
