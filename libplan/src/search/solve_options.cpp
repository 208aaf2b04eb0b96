// The options of a search for a plan: their table.

#include <kaboum/plan/solve_options.h>

#include <array>
#include <utility>

namespace kaboum::plan {

const std::vector<Option<SearchRequest>>& solve_options() {
  using R = SearchRequest;
  static constexpr std::array<std::pair<const char*, Algorithm>, 5> kSearches{
      {{"dfs", Algorithm::DepthFirst},
       {"bfs", Algorithm::BreadthFirst},
       {"ids", Algorithm::IterativeDeepening},
       {"greedy", Algorithm::Greedy},
       {"astar", Algorithm::AStar}}};
  static const std::vector<Option<R>> options{
      choice<R>(
          {.name = "search",
           .text = "greedy: a plan, soon; astar: least cost; bfs, ids: fewest steps; dfs: any "
                   "plan. With sensing, the last three minimise parts, not the whole"},
          [](auto& r) -> auto& { return r.algorithm; }, kSearches),
      limit_option<R>(
          {.name = "timeout",
           .text = "Give up after this time",
           .values = "SECONDS",
           .low = 0,
           .between = true,
           .otherwise = "never"},
          [](auto& r) -> auto& { return r.timeout; }),
      limit_option<R>(
          {.name = "max-memory",
           .text = "Give up when grounding and search hold this much, e.g. 500M or 2G",
           .otherwise = "no limit",
           .kind = OptionDescription::Kind::Memory},
          [](auto& r) -> auto& { return r.max_memory; }),
      option<R>(
          {.name = "seed", .text = "Seed of external functions that choose at random"},
          [](auto& r) -> auto& { return r.seed; })};
  return options;
}

}  // namespace kaboum::plan
