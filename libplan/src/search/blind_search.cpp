// Depth-first, breadth-first and iterative-deepening search, as the thesis compares them in
// Tables 6.2, 6.4 and 6.7.
#include <algorithm>
#include <optional>

#include "search/deferred_calls.h"
#include "search/search.h"
#include "search/state_store.h"

namespace kaboum::plan {

namespace {

void count_states(const StateStore& store, Statistics& s) {
  if (store.size() < s.states) return;
  s.states = store.size();
  s.state_bytes = store.bytes();
}

/// For the limit of memory: what the table of states takes for a while when it grows included.
std::size_t held(const StateStore& store) { return store.bytes() + store.growth(); }

/// Steps as they are: external functions are asked.
struct AskedSteps {
  static constexpr bool kAsked = true;
  static constexpr std::size_t kMostStates = ~std::size_t{0};
  Task& task;
  void expand(const Word* state, std::vector<OperatorId>& steps) { task.expand(state, steps); }
  bool apply(OperatorId step, Knowledge& state) { return task.apply(step, state); }
};

/// Steps as they are, which are asked when their turn comes: most are never taken.
struct StepsAskedInTurn {
  static constexpr std::size_t kMostStates = ~std::size_t{0};
  Task& task;
  void expand(const Word* state, std::vector<OperatorId>& steps) {
    task.expand_unasked(state, steps);
  }
  bool is_possible(const Word* state, OperatorId step, std::vector<OperatorId>& outcomes) {
    return !task.asks(step) || task.decide(state, step, outcomes);
  }
  bool apply(OperatorId step, Knowledge& state) { return task.apply(step, state); }
};

/// Successors of one state, made together so that the table's lines are fetched ahead.
template <class Steps>
struct Successors {
  Steps& from;
  std::vector<OperatorId> steps = {};
  std::vector<Word> words = {};
  std::vector<std::uint64_t> hashes = {};

  void make(const SearchInput& in, const Word* state, Knowledge& scratch, const StateStore& store) {
    from.expand(state, steps);
    const Index n = in.task.layout().words();
    words.clear();
    hashes.clear();
    std::size_t kept = 0;
    for (const OperatorId step : steps) {
      if (in.task.is_outcome(step) && !in.target.allowed(state, step)) continue;
      scratch.assign(state);
      if (!from.apply(step, scratch)) continue;
      words.insert(words.end(), scratch.words(), scratch.words() + n);
      hashes.push_back(scratch.hash());
      store.prefetch(scratch.hash());
      steps[kept++] = step;
    }
    steps.resize(kept);
    ++in.statistics.expanded;
    in.statistics.generated += kept;
  }
};

/// A step of one layer that reaches the target, of those that ask external functions and would
/// reach it if they were possible: only these are asked. The plan is no longer than one that is
/// found without this look, and most calls of the last layer are not made.
std::optional<std::pair<Index, OperatorId>> last_step(const SearchInput& in,
                                                      const StateStore& store, std::size_t begin,
                                                      std::size_t end) {
  if (in.task.model().external_functions.empty()) return std::nullopt;
  Knowledge scratch(in.task.layout());
  std::vector<OperatorId> steps, outcomes;
  for (auto state = static_cast<Index>(begin); state < end; ++state) {
    if (in.limits.exceeded(held(store))) return std::nullopt;
    in.task.expand_unasked(store[state], steps);
    for (const OperatorId step : steps) {
      if (!in.task.asks(step)) continue;
      scratch.assign(store[state]);
      {
        const ExternalCalls::Supposing supposing(in.task.calls());
        if (!in.task.suppose(step, scratch) || !in.target.reached(scratch.words())) continue;
      }
      if (!in.task.decide(store[state], step, outcomes)) continue;
      scratch.assign(store[state]);
      if (in.task.apply(step, scratch) && in.target.reached(scratch.words()))
        return std::pair(state, step);
    }
  }
  return std::nullopt;
}

/// Breadth first.
template <class Steps>
SearchResult search_layers(const SearchInput& in, Steps& from) {
  const Index n = in.task.layout().words();
  StateStore store(n);
  Knowledge scratch(in.task.layout());
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), kNone, 0);
  SearchResult found;
  if (in.target.reached(in.start.data())) {
    found.outcome = Outcome::Solved;
    return found;
  }
  Successors<Steps> next{from};
  std::size_t layer_end = 0;
  std::uint64_t depth = 0;
  const auto solved = [&](std::vector<OperatorId> steps) {
    in.statistics.depth = std::max(in.statistics.depth, depth);
    count_states(store, in.statistics);
    found.outcome = Outcome::Solved;
    found.steps = std::move(steps);
    return found;
  };
  for (std::size_t i = 0; i < store.size(); ++i) {
    if (i == layer_end) {
      layer_end = store.size();
      ++depth;  // of the states that are made
      in.statistics.depth = std::max(in.statistics.depth, depth - 1);
      if (const auto last = Steps::kAsked ? last_step(in, store, i, layer_end) : std::nullopt) {
        std::vector<OperatorId> steps = store.path(last->first);
        steps.push_back(last->second);
        return solved(std::move(steps));
      }
    }
    if (in.limits.exceeded(held(store)) || store.size() > Steps::kMostStates) {
      count_states(store, in.statistics);
      return found;
    }
    next.make(in, store[static_cast<Index>(i)], scratch, store);
    for (std::size_t k = 0; k < next.steps.size(); ++k) {
      const Word* state = next.words.data() + k * n;
      const auto [number, fresh] =
          store.insert(state, next.hashes[k], static_cast<Index>(i), next.steps[k]);
      if (fresh && in.target.reached(state)) return solved(store.path(number));
    }
  }
  count_states(store, in.statistics);
  found.outcome = Outcome::Unsolvable;
  return found;
}

/// Depth-first within a growing depth limit. A state is searched again only with more depth left
/// than ever before, so each round is at most as long as a breadth-first search of the same depth
/// and the plan has the fewest steps. A round that reaches no new state proves that there is none.
template <class Steps>
SearchResult search_deeper(const SearchInput& in, Steps& from) {
  const Index n = in.task.layout().words();
  StateStore store(n);  // link.step: most depth left with which it was searched
  Knowledge state(in.task.layout());
  state.keep_log(true);
  SearchResult found;
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), 0, 0);
  if (in.target.reached(in.start.data())) {
    found.outcome = Outcome::Solved;
    return found;
  }
  std::vector<std::vector<OperatorId>> steps;
  std::vector<OperatorId> path;
  enum class Round { Solved, Limit, Failed };
  const auto descend = [&](const auto& self, Index left) -> Round {
    const std::size_t depth = path.size();
    if (in.limits.exceeded(held(store)) || store.size() > Steps::kMostStates) return Round::Limit;
    from.expand(state.words(), steps[depth]);
    ++in.statistics.expanded;
    for (std::size_t i = 0; i < steps[depth].size(); ++i) {
      const OperatorId step = steps[depth][i];
      if (in.task.is_outcome(step) && !in.target.allowed(state.words(), step)) continue;
      const std::size_t mark = state.mark();
      if (from.apply(step, state)) {
        ++in.statistics.generated;
        const auto [number, fresh] = store.insert(state.words(), state.hash(), 0, left - 1);
        path.push_back(step);
        if (fresh && in.target.reached(state.words())) return Round::Solved;
        if (left > 1 && (fresh || store.link(number).step < left - 1)) {
          store.link(number).step = left - 1;
          const Round r = self(self, left - 1);
          if (r != Round::Failed) return r;
        }
        path.pop_back();
      }
      state.undo(mark);
    }
    return Round::Failed;
  };
  constexpr Index kLongestPlan = 10'000;  // the recursion's depth
  for (Index limit = 1; limit <= kLongestPlan; ++limit) {
    in.statistics.depth = std::max<std::uint64_t>(in.statistics.depth, limit);
    steps.resize(limit);
    path.clear();
    state.assign(in.start.data());
    const std::size_t before = store.size();
    store.link(0).step = limit;
    const Round r = descend(descend, limit);
    count_states(store, in.statistics);
    if (r == Round::Solved) {
      found.outcome = Outcome::Solved;
      found.steps = path;
      return found;
    }
    if (r == Round::Limit) return found;
    if (store.size() == before) {
      found.outcome = Outcome::Unsolvable;
      return found;
    }
  }
  return found;
}

/// Depth-first, each state once.
template <class Steps>
SearchResult search_depth(const SearchInput& in, Steps& from) {
  const Index n = in.task.layout().words();
  StateStore store(n);
  Knowledge scratch(in.task.layout());
  SearchResult found;
  struct Frame {
    Index state;
    std::vector<OperatorId> steps;
    std::size_t next;
  };
  std::vector<Frame> stack;
  std::vector<OperatorId> outcomes;
  std::size_t top = 0;         // frames are kept for their capacity
  std::size_t step_bytes = 0;  // of all frames
  const auto push = [&](Index state) {
    if (stack.size() == top) stack.emplace_back();
    Frame& f = stack[top++];
    f.state = state;
    f.next = 0;
    const std::size_t before = f.steps.capacity();
    from.expand(store[state], f.steps);
    step_bytes += (f.steps.capacity() - before) * sizeof(OperatorId);
    ++in.statistics.expanded;
    in.statistics.depth = std::max<std::uint64_t>(in.statistics.depth, top);
  };
  store.insert(in.start.data(), Knowledge::hash_of(in.start.data(), n), kNone, 0);
  if (in.target.reached(in.start.data())) {
    found.outcome = Outcome::Solved;
    return found;
  }
  push(0);
  while (top > 0) {
    // A frame's list, as all small blocks, takes some bytes of the allocator's; a stack is copied
    // when it grows.
    const std::size_t frames =
        step_bytes + stack.size() * 2 * sizeof(void*) + stack.capacity() * sizeof(Frame) * 3 / 2;
    if (in.limits.exceeded(held(store) + frames) || store.size() > Steps::kMostStates) {
      count_states(store, in.statistics);
      return found;
    }
    Frame& f = stack[top - 1];
    if (f.next == f.steps.size()) {
      --top;
      continue;
    }
    const OperatorId step = f.steps[f.next++];
    const Word* state = store[f.state];
    if (in.task.is_outcome(step) && !in.target.allowed(state, step)) continue;
    outcomes.clear();
    const bool possible = from.is_possible(state, step, outcomes);
    for (const OperatorId o : outcomes)
      if (std::find(f.steps.begin(), f.steps.end(), o) == f.steps.end()) f.steps.push_back(o);
    if (!possible) continue;
    scratch.assign(state);
    if (!from.apply(step, scratch)) continue;
    ++in.statistics.generated;
    const auto [number, fresh] = store.insert(scratch.words(), scratch.hash(), f.state, step);
    if (!fresh) continue;
    if (in.target.reached(scratch.words())) {
      count_states(store, in.statistics);
      found.outcome = Outcome::Solved;
      found.steps = store.path(number);
      return found;
    }
    push(number);
  }
  count_states(store, in.statistics);
  found.outcome = Outcome::Unsolvable;
  return found;
}

/// By a search with calls put off; where its plan does not hold, with calls made as `Steps` does.
template <class Steps, class Search>
SearchResult with_deferred_calls(const SearchInput& in, const Search& search) {
  if (DeferredCalls deferred(in); deferred.possible()) {
    SearchResult found = search(deferred.input(), deferred);
    if (deferred.confirms(found)) return found;
  }
  Steps asked{in.task};
  return search(in, asked);
}

}  // namespace

SearchResult breadth_first(const SearchInput& in) {
  return with_deferred_calls<AskedSteps>(
      in, [](const SearchInput& of, auto& from) { return search_layers(of, from); });
}

SearchResult depth_first(const SearchInput& in) {
  return with_deferred_calls<StepsAskedInTurn>(
      in, [](const SearchInput& of, auto& from) { return search_depth(of, from); });
}

SearchResult iterative_deepening(const SearchInput& in) {
  return with_deferred_calls<AskedSteps>(
      in, [](const SearchInput& of, auto& from) { return search_deeper(of, from); });
}

}  // namespace kaboum::plan
