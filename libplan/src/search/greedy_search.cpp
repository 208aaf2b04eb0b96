// Greedy best-first search with two estimates, each with a queue of all states and one of those
// that preferred operators lead to; preferred queues are boosted on progress, and estimates
// deferred to expansion [helmert2006fd]. The relaxed plan guides where deletions do
// little harm, the landmark events where they do. Both count steps, whatever these cost. Without
// sensing and external functions, states too are made when their turn comes.
#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "search/applicable_steps.h"
#include "search/landmarks.h"
#include "search/relaxed_plan.h"
#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan {
namespace {

/// Searches where external functions refuse steps: what the first one has learned of that makes the
/// plans of later ones shorter, and most of what they ask has been asked before.
constexpr int kRounds = 3;

/// Items of queues: states, or with this steps that are not taken yet.
constexpr Index kStep = Index{1} << 31U;

constexpr std::size_t kRelaxed = 0, kRelaxedPreferred = 1, kEvents = 2, kEventsPreferred = 3;

/// Queues that take turns: the one that was served least, counting boosts.
class Queues {
 public:
  void push(std::size_t queue, std::uint64_t estimate, Index item) {
    queues_[queue][estimate].push_back(item);
    most_ = std::max(most_, ++size_);
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  Index pop() {
    std::size_t next = queues_.size();
    for (std::size_t q = 0; q < queues_.size(); ++q)
      if (!queues_[q].empty() && (next == queues_.size() || served_[q] < served_[next])) next = q;
    ++served_[next];
    --size_;
    const auto best = queues_[next].begin();
    const Index item = best->second.front();
    best->second.pop_front();
    if (best->second.empty()) queues_[next].erase(best);
    return item;
  }
  /// What is in the queue comes first for a while.
  void boost(std::size_t queue) { served_[queue] -= kBoost; }
  [[nodiscard]] std::size_t bytes() const { return most_ * sizeof(Index); }

 private:
  static constexpr std::int64_t kBoost = 1000;  // turns, on progress

  /// By estimate; first come, first served.
  std::array<std::map<std::uint64_t, std::deque<Index>>, 4> queues_;
  std::array<std::int64_t, 4> served_{};
  std::size_t size_ = 0;
  std::size_t most_ = 0;
};

class GreedySearch {
 public:
  /// @param most_expanded  states, before it gives up.
  GreedySearch(const SearchInput& in, std::uint64_t most_expanded)
      : in_(in),
        most_expanded_(in.statistics.expanded + most_expanded),
        relaxed_(in.heuristics.relaxed(in.task, in.limits)),
        landmarks_(in.heuristics.landmark(in.task, in.limits)),
        words_(in.task.layout().words()),
        calls_(!in.task.model().external_functions.empty()),
        at_once_(calls_ || in.task.layout().sensing()),
        store_(words_),
        scratch_(in.task.layout()) {}

  Found run() {
    store_.insert(in_.start.data(), Knowledge::hash_of(in_.start.data(), words_), kNone, 0);
    open_.push(kRelaxed, 0, 0);
    while (!open_.empty()) {
      Index state = open_.pop();
      if ((state & kStep) != 0) {
        const Taken taken = take(waiting_[state & ~kStep]);
        if (taken.reached) return finish(Outcome::Solved);
        if (taken.state == kNone) {
          if (in_.limits.exceeded(bytes())) return finish(Outcome::Limit);
          continue;
        }
        state = taken.state;
      }
      if (state >= expanded_.size()) {
        expanded_.resize(store_.size(), 0);
        estimates_.resize(store_.size());
      }
      if (expanded_[state]) continue;
      expanded_[state] = 1;
      if (in_.limits.check(bytes()) || in_.statistics.expanded >= most_expanded_)
        return finish(Outcome::Limit);
      const std::optional<Estimates> estimates = evaluate(state);
      if (!estimates) continue;
      note_progress(*estimates);
      estimates_[state] = *estimates;
      if (expand(state)) return finish(Outcome::Solved);
    }
    return finish(Outcome::Unsolvable);
  }

 private:
  struct Estimates {
    std::uint64_t relaxed = 0;
    std::uint64_t events = 0;
  };

  /// A step from a state that is made, and whose external functions are asked, when its turn comes:
  /// for most it never does.
  struct Waiting {
    Index parent = 0;
    OperatorId step = kNoOperator;  ///< kNoOperator: its turn has come
    bool preferred = false;
  };

  struct Taken {
    Index state = kNone;  ///< a new one
    bool reached = false;
  };

  /// Asks, and makes the step if it is possible.
  Taken take(Waiting& waiting) {
    const Waiting w = std::exchange(waiting, {});
    if (w.step == kNoOperator) return {};  // in another queue
    if (!in_.task.asks(w.step)) return make(w.parent, w.step);
    if (in_.limits.check(bytes())) return {};
    outcomes_.clear();
    if (in_.task.decide(store_[w.parent], w.step, outcomes_)) return make(w.parent, w.step);
    for (const OperatorId outcome : outcomes_) {
      const Taken taken = make(w.parent, outcome);
      if (taken.reached) return taken;
      if (taken.state != kNone) push(taken.state, estimates_[w.parent], w.preferred);
    }
    return {};
  }

  Taken make(Index parent, OperatorId step) {
    if (in_.task.is_outcome(step) && !in_.target.allowed(store_[parent], step)) return {};
    scratch_.assign(store_[parent]);
    if (!in_.task.apply(step, scratch_)) return {};
    ++in_.statistics.generated;
    const auto [number, fresh] = store_.insert(scratch_.words(), scratch_.hash(), parent, step);
    if (!fresh) return {};
    ensure(number < kStep, "states are numbered");
    if (!in_.target.reached(scratch_.words())) return {number, false};
    found_.steps = store_.path(number);
    in_.statistics.depth = std::max<std::uint64_t>(in_.statistics.depth, found_.steps.size());
    return {number, true};
  }

  /// nullopt: a dead end. Both estimates are safe: what they call one is one.
  std::optional<Estimates> evaluate(Index state) {
    Estimates e;
    e.relaxed = relaxed_.evaluate(store_[state]);
    const bool dead = e.relaxed == RelaxedPlan::kDeadEnd;
    if (state == 0 && in_.statistics.searches == 1)
      in_.statistics.initial_estimate = dead ? -1 : static_cast<std::int64_t>(e.relaxed);
    if (dead) return std::nullopt;
    if (!use_events_) return e;
    const auto events = landmarks_.count(store_[state]);
    if (!events) return std::nullopt;
    e.events = *events;
    // Not worth it where events are so many that their orders take longer than all the rest.
    const std::size_t count = landmarks_.events();
    use_events_ = count * count * (count / 64 + 1) < 200 * relaxed_.size() + 1'000'000;
    return e;
  }

  void note_progress(const Estimates& e) {
    const bool relaxed = e.relaxed < best_.relaxed;
    const bool events = use_events_ && e.events < best_.events;
    if (relaxed) best_.relaxed = e.relaxed;
    if (events) best_.events = e.events;
    // Progress of one estimate is for both, but where calls take longer than all else.
    const bool both = !calls_ && (relaxed || events);
    if (relaxed || both) open_.boost(kRelaxedPreferred);
    if (events || both) open_.boost(kEventsPreferred);
  }

  /// @return whether a successor reaches the target.
  bool expand(Index state) {
    const std::vector<OperatorId> helpful = relaxed_.steps();
    if (in_.task.layout().sensing()) {
      in_.task.expand_unasked(store_[state], steps_);
    } else {
      in_.heuristics.steps(in_.task, in_.limits).find(store_[state], steps_);
    }
    ++in_.statistics.expanded;
    for (const OperatorId step : steps_) {
      const bool preferred = std::binary_search(helpful.begin(), helpful.end(), step);
      if (!at_once_ || in_.task.asks(step)) {
        ensure(waiting_.size() < kStep, "steps are numbered");
        push(static_cast<Index>(waiting_.size()) | kStep, estimates_[state], preferred);
        waiting_.push_back({state, step, preferred});
        continue;
      }
      const Taken taken = make(state, step);
      if (taken.reached) return true;
      if (taken.state != kNone) push(taken.state, estimates_[state], preferred);
    }
    return false;
  }

  void push(Index item, const Estimates& e, bool preferred) {
    open_.push(kRelaxed, e.relaxed, item);
    if (preferred) open_.push(kRelaxedPreferred, e.relaxed, item);
    if (use_events_) {
      open_.push(kEvents, e.events, item);
      if (preferred) open_.push(kEventsPreferred, e.events, item);
    }
  }

  [[nodiscard]] std::size_t bytes() const {
    return store_.bytes() + open_.bytes() + expanded_.capacity() +
           estimates_.capacity() * sizeof(Estimates) + waiting_.capacity() * sizeof(Waiting);
  }

  Found finish(Outcome outcome) {
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes());
    found_.outcome = outcome;
    return std::move(found_);
  }

  const SearchInput& in_;
  std::uint64_t most_expanded_;
  RelaxedPlan& relaxed_;
  LandmarkHeuristic& landmarks_;
  Index words_;
  bool calls_;    ///< external functions
  bool at_once_;  ///< steps are made when their state is expanded: it may be in a plan already
  StateStore store_;
  Knowledge scratch_;
  Queues open_;
  std::vector<char> expanded_;        ///< by state
  std::vector<Estimates> estimates_;  ///< by state, once expanded
  Estimates best_{RelaxedPlan::kDeadEnd, RelaxedPlan::kDeadEnd};
  bool use_events_ = true;
  std::vector<OperatorId> steps_, outcomes_;
  std::vector<Waiting> waiting_;
  Found found_;
};

}  // namespace

Found greedy_best_first(const SearchInput& in) {
  if (in.target.reached(in.start.data())) return {Outcome::Solved, {}};
  Found best;
  std::uint64_t most_expanded = ~std::uint64_t{0} - in.statistics.expanded;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t refused = in.task.refused(), expanded = in.statistics.expanded;
    Found found = GreedySearch(in, most_expanded).run();
    if (round == 0 || (found.outcome == Outcome::Solved && found.steps.size() < best.steps.size()))
      best = std::move(found);
    if (best.outcome != Outcome::Solved || in.task.refused() == refused) break;
    most_expanded = in.statistics.expanded - expanded;
  }
  return best;
}

}  // namespace kaboum::plan
