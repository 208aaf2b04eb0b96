// Greedy best-first search with two estimates, each with a queue of all states and one of those
// that preferred operators lead to; preferred queues are boosted on progress, and estimates
// deferred to expansion [helmert2006fd]. The relaxed plan guides where deletions do
// little harm, the landmark events where they do. Both count steps, whatever these cost. Without
// sensing and external functions, states too are made when their turn comes, and what a relaxed
// plan makes of a state comes next [vidal2004yahsp].
#include <kaboum/base/error.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "search/applicable_steps.h"
#include "search/difference_store.h"
#include "search/engine.h"
#include "search/landmarks.h"
#include "search/queues.h"
#include "search/relaxed_plan.h"

namespace kaboum::plan {
namespace {

/// Items of queues: states, or with this steps that are not taken yet.
constexpr Index kStep = Index{1} << 31U;

constexpr std::size_t kRelaxed = 0, kRelaxedPreferred = 1, kEvents = 2, kEventsPreferred = 3;

constexpr std::uint64_t kPerState = 5'000, kPerEvent = 1'500;  // work, besides that of engine.h

/// States that are expanded before a search looks ahead, which makes plans longer and uses up what
/// cannot be replaced: fewer where each takes long.
std::uint64_t patience(const RelaxedPlan& relaxed) {
  constexpr std::uint64_t kEdges = 60'000'000;
  return std::clamp<std::uint64_t>(kEdges / (relaxed.size() + 1), 500, 3'000);
}

/// States that may be expanded in all, as far as progress so far tells, for a search to go on
/// without.
std::uint64_t most_steady(const RelaxedPlan& relaxed) {
  constexpr std::uint64_t kEdges = 1'000'000'000;
  return kEdges / (relaxed.size() + 1);
}

class GreedySearch final : public Engine {
 public:
  /// @param most_expanded  states, before it gives up.
  GreedySearch(const SearchInput& in, std::uint64_t most_expanded)
      : in_(in),
        most_expanded_(in.statistics.expanded + most_expanded),
        relaxed_(in.heuristics.relaxed(in.task, in.limits)),
        landmarks_(in.heuristics.landmark(in.task, in.limits)),
        calls_(!in.task.model().external_functions.empty()),
        at_once_(calls_ || in.task.layout().sensing()),
        patience_(patience(relaxed_)),
        most_steady_(most_steady(relaxed_)),
        store_(in.start.data(), in.task.layout().words()),
        scratch_(in.task.layout()) {
    scratch_.keep_log(true);
    open_.push(kRelaxed, 0, 0);
  }

  std::optional<SearchResult> advance(std::uint64_t work, std::size_t besides) override {
    besides_ = besides;
    turn_ = work;
    for (pause_ = work_ + turn_; work_ < pause_;) {
      if (open_.empty()) return finish(Outcome::Unsolvable);
      const Index item = open_.pop();
      Expansion taken{item, true, false};
      if ((item & kStep) != 0) taken = take(waiting_[item & ~kStep]);
      if (taken.reached) return finish(Outcome::Solved);
      if (!taken.fresh) {
        if (in_.limits.exceeded(held())) return finish(Outcome::Limit);
        continue;
      }
      if (const std::optional<Outcome> end = follow(taken.state)) return finish(*end);
    }
    return std::nullopt;
  }

  [[nodiscard]] std::size_t bytes() const override {
    return store_.bytes() + open_.bytes() + infos_.size() * sizeof(Info) +
           waiting_.size() * sizeof(Waiting);
  }

 private:
  struct Estimates {
    std::uint32_t relaxed = 0;
    std::uint32_t events = 0;
  };
  struct Info {
    Estimates estimates;  ///< once expanded
    bool expanded = false;
  };
  static constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();

  /// A step from a state that is made, and whose external functions are asked, when its turn comes:
  /// for most it never does.
  struct Waiting {
    Index parent = 0;
    OperatorId step = kNoOperator;  ///< kNoOperator: its turn has come
    bool preferred = false;
  };

  struct Expansion {
    Index state = kNone;
    bool fresh = false;
    bool reached = false;
  };

  /// Expands the state and, as long as that leads nearer, where its relaxed plan leads.
  /// @return how the search ends, if it does.
  std::optional<Outcome> follow(Index state) {
    ahead_ = looks_ahead();
    for (std::uint32_t nearest = kFar; state != kNone;) {
      if (state >= infos_.size()) infos_.resize(store_.size());
      if (infos_[state].expanded) break;
      infos_[state].expanded = true;
      if (in_.limits.check(held()) || in_.statistics.expanded >= most_expanded_)
        return Outcome::Limit;
      const std::optional<Estimates> e = evaluate(state);
      if (!e) break;
      note_progress(*e);
      infos_[state].estimates = *e;
      if (expand(state)) return Outcome::Solved;
      if (!ahead_ || e->relaxed >= nearest) break;
      nearest = e->relaxed;
      const Expansion ahead = look_ahead(state);
      if (ahead.reached) return Outcome::Solved;
      state = ahead.state;
    }
    return std::nullopt;
  }

  /// Whether to look ahead from the next state, where that takes no calls: once the relaxed
  /// estimate did not fall steadily.
  [[nodiscard]] bool looks_ahead() {
    if (at_once_ || expanded_ < patience_) return false;
    impatient_ = impatient_ || !steady();
    return impatient_;
  }

  /// Whether the relaxed estimate falls so fast that the goal is not far.
  [[nodiscard]] bool steady() const {
    const std::uint64_t fallen = first_ - best_.relaxed;
    return expanded_ * first_ <= most_steady_ * fallen;
  }

  /// Makes the steps of the relaxed plan of the state at hand, each once, while one is possible.
  Expansion look_ahead(Index state) {
    std::vector<OperatorId> left = relaxed_.steps_in_order();
    Expansion at{state};
    const auto use = [&](OperatorId step) {
      if (at.reached || in_.task.is_outcome(step) ||
          !in_.task.evaluator().holds(in_.task.action(step).precondition, store_.read(at.state)))
        return false;
      const Expansion next = make(at.state, step);
      if (next.state == kNone) return false;
      at = next;
      if (at.fresh) push(at.state, infos_[state].estimates, false);
      return true;
    };
    while (std::erase_if(left, use) > 0) {
    }
    return at;
  }

  /// Asks, and makes the step if it is possible.
  Expansion take(Waiting& waiting) {
    const Waiting w = std::exchange(waiting, {});
    if (w.step == kNoOperator) return {};  // in another queue
    if (!in_.task.asks(w.step)) return make(w.parent, w.step);
    if (in_.limits.check(held())) return {};
    outcomes_.clear();
    if (in_.task.decide(store_.read(w.parent), w.step, outcomes_)) return make(w.parent, w.step);
    for (const OperatorId outcome : outcomes_) {
      const Expansion taken = make(w.parent, outcome);
      if (taken.reached) return taken;
      if (taken.fresh) push(taken.state, infos_[w.parent].estimates, w.preferred);
    }
    return {};
  }

  Expansion make(Index parent, OperatorId step) {
    if (in_.task.is_outcome(step) && !in_.target.allowed(store_.read(parent), step)) return {};
    if (std::exchange(scratch_of_, parent) == parent) {
      scratch_.undo(0);
    } else {
      scratch_.assign(store_.read(parent), store_.hash(parent));
    }
    work_ += kPerStep;
    if (!in_.task.apply(step, scratch_)) return {};
    ++in_.statistics.generated;
    const auto [number, fresh] = store_.insert(scratch_, parent, step);
    ensure(number < kStep, "states are numbered");
    if (!fresh || !in_.target.reached(scratch_.words())) return {number, fresh, false};
    found_.steps = store_.path(number);
    in_.statistics.depth = std::max<std::uint64_t>(in_.statistics.depth, found_.steps.size());
    return {number, true, true};
  }

  /// nullopt: a dead end. Both estimates are safe: what they call one is one.
  std::optional<Estimates> evaluate(Index state) {
    const std::uint64_t relaxed = relaxed_.evaluate(store_.read(state));
    work_ += kPerState + kPerEdge * relaxed_.walked();
    const bool dead = relaxed == RelaxedPlan::kDeadEnd;
    if (state == 0) first_ = dead ? 0 : std::min<std::uint64_t>(relaxed, kFar - 1);
    if (state == 0 && in_.statistics.searches == 1)
      in_.statistics.initial_estimate = dead ? -1 : static_cast<std::int64_t>(relaxed);
    if (dead) return std::nullopt;
    Estimates e{static_cast<std::uint32_t>(std::min<std::uint64_t>(relaxed, kFar - 1)), 0};
    if (!use_events_) return e;
    const auto events = landmarks_.count(store_.read(state));
    if (!events) return std::nullopt;
    e.events = static_cast<std::uint32_t>(*events);
    // Not worth it where events are so many that their orders take longer than all the rest.
    const std::size_t count = landmarks_.events(), triples = count * count * (count / 64 + 1);
    work_ += kPerEvent * count + triples;
    use_events_ = triples < 200 * relaxed_.size() + 1'000'000;
    return e;
  }

  void note_progress(const Estimates& e) {
    const bool relaxed = e.relaxed < best_.relaxed;
    const bool events = use_events_ && e.events < best_.events;
    if (relaxed || events) pause_ = work_ + turn_;
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
      in_.task.expand_unasked(store_.read(state), steps_);
    } else {
      in_.heuristics.steps(in_.task, in_.limits).find(store_.read(state), steps_);
    }
    ++expanded_;
    ++in_.statistics.expanded;
    const ActionSet awaited = use_events_ && ahead_ ? landmarks_.achievers() : ActionSet();
    const Estimates estimates = infos_[state].estimates;
    for (const OperatorId step : steps_) {
      const bool preferred = std::binary_search(helpful.begin(), helpful.end(), step) ||
                             (!awaited.empty() && landmarks_.is_in(step, awaited));
      if (!at_once_ || in_.task.asks(step)) {
        ensure(waiting_.size() < kStep, "steps are numbered");
        push(static_cast<Index>(waiting_.size()) | kStep, estimates, preferred);
        waiting_.push_back({state, step, preferred});
        continue;
      }
      const Expansion taken = make(state, step);
      if (taken.reached) return true;
      if (taken.fresh) push(taken.state, estimates, preferred);
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

  /// For the limit of memory.
  [[nodiscard]] std::size_t held() const { return bytes() + store_.growth() + besides_; }

  SearchResult finish(Outcome outcome) {
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes());
    found_.outcome = outcome;
    return std::move(found_);
  }

  const SearchInput in_;
  std::uint64_t most_expanded_;
  std::uint64_t work_ = 0, pause_ = 0, turn_ = 0;
  std::size_t besides_ = 0;  ///< bytes that others hold
  RelaxedPlan& relaxed_;
  LandmarkHeuristic& landmarks_;
  bool calls_;    ///< external functions
  bool at_once_;  ///< steps are made when their state is expanded: it may be in a plan already
  std::uint64_t expanded_ = 0;  ///< states
  std::uint64_t patience_;
  std::uint64_t most_steady_;
  std::uint64_t first_ = 0;  ///< the first state's relaxed estimate
  bool impatient_ = false;
  bool ahead_ = false;  ///< it looks ahead from the state at hand
  DifferenceStore store_;
  Knowledge scratch_;
  Index scratch_of_ = kNone;  ///< the state that it was made of
  Queues<4> open_;
  // In chunks: memory is never held twice while they grow.
  std::deque<Info> infos_;  ///< by state
  std::deque<Waiting> waiting_;
  Estimates best_{kFar, kFar};
  bool use_events_ = true;
  std::vector<OperatorId> steps_, outcomes_;
  SearchResult found_;
};

}  // namespace

std::unique_ptr<Engine> greedy_engine(const SearchInput& in, std::uint64_t most_expanded) {
  return std::make_unique<GreedySearch>(in, most_expanded);
}

}  // namespace kaboum::plan
