// The options of measuring two shapes: their table.

#include <kaboum/distance/compare_options.h>

#include <array>
#include <utility>

namespace kaboum::distance {

const std::vector<Option<CompareOptions>>& compare_options() {
  using R = CompareOptions;
  static constexpr std::array<std::pair<const char*, Backend>, 2> kBackends{
      {{"embree", Backend::Embree}, {"own", Backend::Own}}};
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "solid",
           .text = "Measure solid to solid: 0 inside the other one, the largest distance also of "
                   "inner points, no interior folds; both must be closed chains or sets"},
          [](auto& r) -> auto& { return r.solid; }),
      option<R>(
          {.name = "gap",
           .text = "Wished relative width of the certified intervals; never finer than 1e-9 of the "
                   "diagonal",
           .values = "G",
           .low = 1e-9,
           .high = 1},
          [](auto& r) -> auto& { return r.relative_gap; }),
      option<R>(
          {.name = "samples",
           .text = "Points for mean and rms, each way",
           .low = 2,
           .high = 1'000'000'000},
          [](auto& r) -> auto& { return r.samples; }),
      option<R>(
          {.name = "seed", .text = "Seed of the points behind mean and rms"},
          [](auto& r) -> auto& { return r.seed; }),
      choice<R>(
          {.name = "backend", .text = "Search structure: both give certified intervals"},
          [](auto& r) -> auto& { return r.backend; }, kBackends)};
  return options;
}

}  // namespace kaboum::distance
