// The options of a search for a path: their table.

#include <kaboum/motion/path_options.h>
#include <kaboum/world/check_options.h>

namespace kaboum::motion {
namespace {

using R = PathOptions;

std::vector<Option<R>> table() {
  std::vector<Option<R>> out{
      option<R>(
          {.name = "max-work",
           .text = "End the search after so much work, counted in steps that take about so many "
                   "seconds of one core, so that the result is the same on any machine",
           .values = "SECONDS",
           .low = 1e-6,
           .high = 1e9},
          [](auto& r) -> auto& { return r.most_work; }),
      option<R>(
          {.name = "max-nodes",
           .text = "End the search at so many nodes of its trees",
           .low = 1,
           .high = 1e9},
          [](auto& r) -> auto& { return r.most_nodes; }),
      option<R>(
          {.name = "timeout",
           .text = "Give up after this time; a path that is found before is the same as without",
           .values = "SECONDS",
           .low = 0,
           .between = true,
           .otherwise = "never"},
          [](auto& r) -> auto& { return r.most_seconds; }),
      option<R>(
          {.name = "shortcuts",
           .text = "How many shortcuts are tried; 0 leaves the path as it was found",
           .low = 0,
           .high = 1e6},
          [](auto& r) -> auto& { return r.shortcuts; }),
      option<R>(
          {.name = "seed", .text = "Seed of the search: another one may find another path"},
          [](auto& r) -> auto& { return r.seed; })};
  const auto checks = options_of_part<R>(
      world::motion_options(), [](auto& r) -> auto& { return r.check; });
  out.push_back(option_named(checks, "resolution"));
  return out;
}

}  // namespace

const std::vector<Option<PathOptions>>& path_options() {
  static const std::vector<Option<R>> options = table();
  return options;
}

}  // namespace kaboum::motion
