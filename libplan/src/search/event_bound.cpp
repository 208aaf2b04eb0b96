// Bounds that ordered events give [karpas2009landmarks], [buechner2021cyclic]: those that cannot be
// one and the same occurrence, and uniform cost partitioning.
#include "search/event_bound.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace kaboum::plan {
namespace {

using Bits = std::vector<std::uint64_t>;

void set(Bits& b, std::size_t i) { b[i / 64] |= std::uint64_t{1} << (i % 64); }
bool get(const Bits& b, std::size_t i) { return ((b[i / 64] >> (i % 64)) & 1U) != 0; }

/// Words of a set of actions that are not empty: most are.
using Sparse = std::vector<std::pair<std::size_t, std::uint64_t>>;

Sparse sparse(const ActionSet& actions) {
  Sparse out;
  for (std::size_t w = 0; w < actions.size(); ++w)
    if (actions[w] != 0) out.emplace_back(w, actions[w]);
  return out;
}

bool disjoint(const Sparse& a, const ActionSet& b) {
  return std::none_of(a.begin(), a.end(),
                      [&](const auto& w) { return (b[w.first] & w.second) != 0; });
}

/// By event: those that it comes before. Transitive closure of "not after", then "before" through
/// any strict order.
std::vector<Bits> closure(std::size_t n, const std::vector<EventOrder>& orders) {
  const std::size_t words = (n + 63) / 64;
  std::vector<Bits> not_after(n, Bits(words, 0)), before(n, Bits(words, 0));
  for (std::size_t i = 0; i < n; ++i) set(not_after[i], i);
  for (const EventOrder& o : orders) set(not_after[o.before], o.after);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      if (get(not_after[i], k))
        for (std::size_t w = 0; w < words; ++w) not_after[i][w] |= not_after[k][w];
  for (const EventOrder& o : orders) {
    if (!o.strict) continue;
    for (std::size_t i = 0; i < n; ++i)
      if (get(not_after[i], o.before))
        for (std::size_t w = 0; w < words; ++w) before[i][w] |= not_after[o.after][w];
  }
  return before;
}

template <class Visit>
void each_action(const Sparse& actions, const Visit& visit) {
  for (const auto& [w, bits] : actions)
    for (std::uint64_t left = bits; left != 0; left &= left - 1)
      visit(w * 64 + static_cast<std::size_t>(std::countr_zero(left)));
}

struct Size {
  std::size_t event;
  int actions;
  std::uint64_t cost;  ///< the least
};

/// Uniform cost partitioning: an action's cost is shared by the events it could be.
std::uint64_t shared_cost(const std::vector<Sparse>& actions, const std::vector<Size>& sizes,
                          const std::vector<std::int64_t>& costs,
                          const std::vector<std::uint32_t>& uses) {
  constexpr std::uint64_t kUnit = 720720;  // divisible by 1 ... 16
  std::uint64_t shared = 0;
  for (std::size_t i = 0; i < actions.size(); ++i) {
    std::uint64_t least = ~std::uint64_t{0};
    each_action(actions[i], [&](std::size_t a) {
      least = std::min(least, static_cast<std::uint64_t>(costs[a]) * kUnit / uses[a]);
    });
    if (sizes[i].actions > 0) shared += least;
  }
  return (shared + kUnit - 1) / kUnit;
}

/// Events that pairwise cannot be the same occurrence, greedily: those of few actions first.
std::uint64_t distinct_cost(const std::vector<LandmarkEvent>& events,
                            const std::vector<Sparse>& actions, std::vector<Size> sizes,
                            const std::vector<Bits>& before) {
  std::stable_sort(sizes.begin(), sizes.end(), [](const Size& a, const Size& b) {
    return std::pair(a.cost == 0, a.actions) < std::pair(b.cost == 0, b.actions);
  });
  std::vector<std::size_t> chosen;
  ActionSet taken(events.empty() ? 0 : events[0].actions.size(), 0);  // by those chosen
  std::uint64_t distinct = 0;
  for (const Size& s : sizes) {
    const bool fits = disjoint(actions[s.event], taken) ||
                      std::all_of(chosen.begin(), chosen.end(), [&](std::size_t c) {
                        return get(before[c], s.event) || get(before[s.event], c) ||
                               disjoint(actions[s.event], events[c].actions);
                      });
    if (!fits) continue;
    chosen.push_back(s.event);
    for (const auto& [word, bits] : actions[s.event]) taken[word] |= bits;
    distinct += s.cost;
  }
  return distinct;
}

}  // namespace

std::optional<std::uint64_t> distinct_events(const std::vector<LandmarkEvent>& events,
                                             const std::vector<EventOrder>& orders) {
  const std::vector<Bits> before = closure(events.size(), orders);
  std::vector<Sparse> actions;
  std::vector<Size> sizes;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (get(before[i], i)) return std::nullopt;
    actions.push_back(sparse(events[i].actions));
    int count = 0;
    for (const auto& [word, bits] : actions.back()) count += std::popcount(bits);
    sizes.push_back({i, count, 1});
  }
  return distinct_cost(events, actions, std::move(sizes), before);
}

std::optional<std::uint64_t> event_bound(const std::vector<LandmarkEvent>& events,
                                         const std::vector<EventOrder>& orders,
                                         const std::vector<std::int64_t>& costs) {
  const std::vector<Bits> before = closure(events.size(), orders);
  for (std::size_t i = 0; i < events.size(); ++i)
    if (get(before[i], i)) return std::nullopt;
  std::vector<Sparse> actions;
  std::vector<Size> sizes;
  std::vector<std::uint32_t> uses(costs.size(), 0);
  for (std::size_t i = 0; i < events.size(); ++i) {
    Size s{i, 0, ~std::uint64_t{0}};
    actions.push_back(sparse(events[i].actions));
    each_action(actions[i], [&](std::size_t a) {
      ++s.actions;
      ++uses[a];
      s.cost = std::min(s.cost, static_cast<std::uint64_t>(costs[a]));
    });
    sizes.push_back(s);
  }
  return std::max(distinct_cost(events, actions, sizes, before),
                  shared_cost(actions, sizes, costs, uses));
}

}  // namespace kaboum::plan
