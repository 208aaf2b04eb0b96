// Greedy best-first search with several evaluators, each with a queue of all states and one of
// those that preferred operators lead to; preferred queues are boosted on progress, and estimates
// deferred to expansion [helmert2006fd]. Without sensing and external functions, states too are
// made when their turn comes, and what a relaxed plan makes of a state comes next
// [vidal2004yahsp].
#include <kaboum/base/error.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "search/applicable_steps.h"
#include "search/difference_store.h"
#include "search/engine.h"
#include "search/evaluator.h"
#include "search/queues.h"

namespace kaboum::plan {
namespace {

/// Items of queues: states, or with this steps that are not taken yet.
constexpr Index kStep = Index{1} << 31U;

constexpr std::uint64_t kPerState = 5'000;  // work, besides that of engine.h

/// States that are expanded before a search looks ahead, which makes plans longer and uses up what
/// cannot be replaced: fewer where each takes long.
std::uint64_t patience(const Evaluator& guide) {
  constexpr std::uint64_t kEdges = 60'000'000;
  return std::clamp<std::uint64_t>(kEdges / (guide.size() + 1), 500, 3'000);
}

/// States that may be expanded in all, as far as progress so far tells, for a search to go on
/// without.
std::uint64_t most_steady(const Evaluator& guide) {
  constexpr std::uint64_t kEdges = 1'000'000'000;
  return kEdges / (guide.size() + 1);
}

class GreedySearch final : public Engine {
 public:
  /// @param most_expanded  states, before it gives up.
  GreedySearch(const SearchInput& in, std::span<EvaluatorMaker* const> evaluators,
               std::uint64_t most_expanded)
      : in_(in),
        most_expanded_(in.statistics.expanded + most_expanded),
        evaluators_(made(in, evaluators)),
        calls_(!in.task.model().external_functions.empty()),
        at_once_(calls_ || in.task.layout().sensing()),
        patience_(patience(*evaluators_[0])),
        most_steady_(most_steady(*evaluators_[0])),
        store_(in.start.data(), in.task.layout().words()),
        scratch_(in.task.layout()),
        open_(2 * evaluators_.size()),
        best_(evaluators_.size(), kFar),
        used_(evaluators_.size(), 1) {
    scratch_.keep_log(true);
    open_.push(queue_of(0, false), 0, 0);
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
    return store_.bytes() + open_.bytes() + values_.size() * sizeof(std::uint32_t) +
           waiting_.size() * sizeof(Waiting);
  }

 private:
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

  static std::vector<std::unique_ptr<Evaluator>> made(const SearchInput& in,
                                                      std::span<EvaluatorMaker* const> makers) {
    std::vector<std::unique_ptr<Evaluator>> evaluators;
    for (EvaluatorMaker* make : makers)
      evaluators.push_back(make(in.task, in.limits, in.heuristics));
    ensure(!evaluators.empty(), "greedy search needs an evaluator");
    return evaluators;
  }

  /// Of an evaluator: the queue of all states, or that of those that preferred steps lead to.
  static std::size_t queue_of(std::size_t evaluator, bool preferred) {
    return 2 * evaluator + (preferred ? 1 : 0);
  }
  /// What an evaluator said of a state; kFar of the first one: it was not expanded.
  [[nodiscard]] std::uint32_t& value(Index state, std::size_t evaluator) {
    return values_[state * evaluators_.size() + evaluator];
  }

  /// Expands the state and, as long as that leads nearer, where its relaxed plan leads.
  /// @return how the search ends, if it does.
  std::optional<Outcome> follow(Index state) {
    ahead_ = looks_ahead();
    for (std::uint32_t nearest = kFar; state != kNone;) {
      if (state * evaluators_.size() >= values_.size())
        values_.resize(store_.size() * evaluators_.size(), kFar);
      if (value(state, 0) != kFar) break;
      value(state, 0) = 0;
      if (in_.limits.check(held()) || in_.statistics.expanded >= most_expanded_)
        return Outcome::Limit;
      if (!evaluate(state)) break;
      note_progress(state);
      if (expand(state)) return Outcome::Solved;
      if (!ahead_ || value(state, 0) >= nearest) break;
      nearest = value(state, 0);
      const Expansion ahead = look_ahead(state);
      if (ahead.reached) return Outcome::Solved;
      state = ahead.state;
    }
    return std::nullopt;
  }

  /// Whether to look ahead from the next state, where that takes no calls: once the first estimate
  /// did not fall steadily.
  [[nodiscard]] bool looks_ahead() {
    if (at_once_ || expanded_ < patience_) return false;
    impatient_ = impatient_ || !steady();
    return impatient_;
  }

  /// Whether the first estimate falls so fast that the goal is not far.
  [[nodiscard]] bool steady() const {
    const std::uint64_t fallen = first_ - best_[0];
    return expanded_ * first_ <= most_steady_ * fallen;
  }

  /// Makes the steps that the first evaluator outlines from the state at hand, each once, while one
  /// is possible.
  Expansion look_ahead(Index state) {
    std::vector<OperatorId> left = evaluators_[0]->outline();
    Expansion at{state};
    const auto use = [&](OperatorId step) {
      if (at.reached || in_.task.is_outcome(step) ||
          !in_.task.evaluator().holds(in_.task.action(step).precondition, store_.read(at.state)))
        return false;
      const Expansion next = make(at.state, step);
      if (next.state == kNone) return false;
      at = next;
      if (at.fresh) push(at.state, state, false);
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
      if (taken.fresh) push(taken.state, w.parent, w.preferred);
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

  /// @return false: a dead end.
  bool evaluate(Index state) {
    for (std::size_t i = 0; i < evaluators_.size(); ++i) {
      if (used_[i] == 0) continue;
      const Estimate e = evaluators_[i]->evaluate(store_.read(state));
      work_ += e.work;
      const std::uint64_t left = e.dead_end ? kFar : e.value;
      if (i == 0 && state == 0) first_ = e.dead_end ? 0 : std::min<std::uint64_t>(left, kFar - 1);
      if (i == 0 && state == 0 && in_.statistics.searches == 1 && !e.dead_end)
        in_.statistics.initial_estimate = static_cast<std::int64_t>(left);
      if (e.dead_end && evaluators_[i]->is_safe()) return false;
      value(state, i) = static_cast<std::uint32_t>(std::min<std::uint64_t>(left, kFar - 1));
      // The first one says when to look ahead, too: it stays.
      if (i > 0 && !evaluators_[i]->is_worthwhile()) used_[i] = 0;
    }
    return true;
  }

  void note_progress(Index state) {
    bool any = false;
    nearer_.assign(evaluators_.size(), 0);
    for (std::size_t i = 0; i < evaluators_.size(); ++i) {
      if (used_[i] == 0 || value(state, i) >= best_[i]) continue;
      best_[i] = value(state, i);
      nearer_[i] = 1;
      any = true;
    }
    if (!any) return;
    pause_ = work_ + turn_;
    // Progress of one estimate is for all, but where calls take longer than all else.
    for (std::size_t i = 0; i < evaluators_.size(); ++i)
      if (!calls_ || nearer_[i] != 0) open_.boost(queue_of(i, true));
  }

  /// @return whether a successor reaches the target.
  bool expand(Index state) {
    if (in_.task.layout().sensing()) {
      in_.task.expand_unasked(store_.read(state), steps_);
    } else {
      in_.heuristics.steps(in_.task, in_.limits).find(store_.read(state), steps_);
    }
    ++expanded_;
    ++in_.statistics.expanded;
    // What others than the first prefer is for when it leads nowhere.
    preferred_.assign(steps_.size(), 0);
    for (std::size_t i = 0; i < (ahead_ ? evaluators_.size() : 1); ++i)
      if (used_[i] != 0) evaluators_[i]->prefer(steps_, preferred_);
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const OperatorId step = steps_[k];
      const bool preferred = preferred_[k] != 0;
      if (!at_once_ || in_.task.asks(step)) {
        ensure(waiting_.size() < kStep, "steps are numbered");
        push(static_cast<Index>(waiting_.size()) | kStep, state, preferred);
        waiting_.push_back({state, step, preferred});
        continue;
      }
      const Expansion taken = make(state, step);
      if (taken.reached) return true;
      if (taken.fresh) push(taken.state, state, preferred);
    }
    return false;
  }

  /// @param like  the state whose estimates it takes until its turn comes.
  void push(Index item, Index like, bool preferred) {
    for (std::size_t i = 0; i < evaluators_.size(); ++i) {
      if (used_[i] == 0) continue;
      const std::uint32_t estimate = value(like, i);
      open_.push(queue_of(i, false), estimate, item);
      if (preferred) open_.push(queue_of(i, true), estimate, item);
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
  std::vector<std::unique_ptr<Evaluator>> evaluators_;
  bool calls_;    ///< external functions
  bool at_once_;  ///< steps are made when their state is expanded: it may be in a plan already
  std::uint64_t expanded_ = 0;  ///< states
  std::uint64_t patience_;
  std::uint64_t most_steady_;
  std::uint64_t first_ = 0;  ///< the first state's first estimate
  bool impatient_ = false;
  bool ahead_ = false;  ///< it looks ahead from the state at hand
  DifferenceStore store_;
  Knowledge scratch_;
  Index scratch_of_ = kNone;  ///< the state that it was made of
  Queues open_;
  // In chunks: memory is never held twice while they grow.
  std::deque<std::uint32_t> values_;  ///< by state and evaluator
  std::deque<Waiting> waiting_;
  std::vector<std::uint32_t> best_;  ///< by evaluator
  std::vector<char> used_;           ///< by evaluator: it was worth its time so far
  std::vector<char> nearer_, preferred_;
  std::vector<OperatorId> steps_, outcomes_;
  SearchResult found_;
};

}  // namespace

std::unique_ptr<Engine> greedy_engine(const SearchInput& in,
                                      std::span<EvaluatorMaker* const> evaluators,
                                      std::uint64_t most_expanded) {
  return std::make_unique<GreedySearch>(in, evaluators, most_expanded);
}

}  // namespace kaboum::plan
