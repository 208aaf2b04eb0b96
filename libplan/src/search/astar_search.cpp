// A* with an admissible evaluator, the landmark heuristic; states are reopened, so the plan is of
// least cost (without sensing). The estimate: docs/planning/search.md, "Landmark events".
#include <kaboum/base/error.h>

#include <algorithm>
#include <queue>
#include <tuple>

#include "search/evaluator.h"
#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan {
namespace {

/// The estimate of dead ends.
constexpr std::uint64_t kDeadEnd = ~std::uint64_t{0};

class AStarSearch {
 public:
  /// @param evaluator  safe and admissible.
  AStarSearch(const SearchInput& in, Evaluator& evaluator)
      : in_(in),
        evaluator_(evaluator),
        words_(in.task.layout().words()),
        store_(words_),
        scratch_(in.task.layout()) {
    ensure(evaluator.is_safe() && evaluator.is_admissible(), "A* needs lower bounds");
  }

  SearchResult run() {
    // A target may hold in states that are no goal states of the task (a known sub-plan): the
    // estimate only speaks of the goal, so it guides there but proves nothing. Without sensing both
    // are the same.
    store_.insert(in_.start.data(), Knowledge::hash_of(in_.start.data(), words_), kNone, 0);
    const std::uint64_t start = estimate(in_.start.data());
    const bool dead = start == kDeadEnd;
    if (in_.statistics.searches == 1 && !dead)
      in_.statistics.initial_estimate = static_cast<std::int64_t>(start);
    if (dead) return finish(Outcome::Unsolvable);
    info_[0].h = start;
    open_.push({start, start, order_++, 0, 0});
    while (!open_.empty()) {
      if (in_.limits.check(bytes())) return finish(Outcome::Limit);
      const Open top = open_.top();
      open_.pop();
      if (top.g != info_[top.state].g) continue;  // a cheaper way was found since
      if (in_.target.reached(store_[top.state])) {
        found_.steps = store_.path(top.state);
        in_.statistics.depth = std::max<std::uint64_t>(in_.statistics.depth, found_.steps.size());
        return finish(Outcome::Solved);
      }
      expand(top);
    }
    return finish(Outcome::Unsolvable);
  }

 private:
  struct Open {
    std::uint64_t f, h, order;
    Index state;
    std::uint64_t g;
    bool operator>(const Open& o) const {
      return std::tuple(f, h, o.order) > std::tuple(o.f, o.h, order);
    }
  };
  struct Info {
    std::uint64_t g = 0;  ///< cost of the cheapest way so far
    std::uint64_t h = 0;
  };

  std::uint64_t estimate(const Word* state) {
    const Estimate e = evaluator_.evaluate(state);
    return e.dead_end ? kDeadEnd : e.value;
  }

  void expand(const Open& top) {
    in_.task.expand(store_[top.state], steps_);
    ++in_.statistics.expanded;
    for (const OperatorId step : steps_) {
      if (in_.task.is_outcome(step) && !in_.target.allowed(store_[top.state], step)) continue;
      scratch_.assign(store_[top.state]);
      if (!in_.task.apply(step, scratch_)) continue;
      in_.limits.work();
      ++in_.statistics.generated;
      reach(top, step);
    }
  }

  /// The state at hand, by `step` from `top`: opened if it is new, or reopened if this is cheaper.
  void reach(const Open& top, OperatorId step) {
    const auto cost = static_cast<std::uint64_t>(in_.task.cost(step));
    const auto [number, fresh] = store_.insert(scratch_.words(), scratch_.hash(), top.state, step);
    const std::uint64_t g = top.g + cost;
    if (fresh) {
      info_.push_back({g, estimate(scratch_.words())});
    } else {
      if (g >= info_[number].g) return;
      info_[number].g = g;
      store_.link(number) = {top.state, step};
    }
    if (info_[number].h == kDeadEnd) return;
    // Along a path the estimate may drop by no more than the step's cost.
    const std::uint64_t h = std::max(info_[number].h, top.h > cost ? top.h - cost : 0);
    open_.push({g + h, h, order_++, number, g});
  }

  std::size_t bytes() {
    most_open_ = std::max(most_open_, open_.size());
    return store_.bytes() + info_.capacity() * sizeof(Info) + most_open_ * sizeof(Open);
  }

  SearchResult finish(Outcome outcome) {
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes());
    found_.outcome = outcome;
    return std::move(found_);
  }

  const SearchInput& in_;
  Evaluator& evaluator_;
  Index words_;
  StateStore store_;
  Knowledge scratch_;
  std::vector<Info> info_ = std::vector<Info>(1);  ///< by state
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::uint64_t order_ = 0;
  std::size_t most_open_ = 0;
  std::vector<OperatorId> steps_;
  SearchResult found_;
};

}  // namespace

SearchResult a_star(const SearchInput& in) {
  const auto evaluator = landmark_cost(in.task, in.limits, in.heuristics);
  return AStarSearch(in, *evaluator).run();
}

}  // namespace kaboum::plan
