// The options of inverse kinematics: their table.

#include <kaboum/kinematics/inverse_options.h>

namespace kaboum::kinematics {

const std::vector<Option<InverseRequest>>& inverse_options() {
  using R = InverseRequest;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "copies",
           .text = "All that differ by whole turns within the limits, at most 4096 of a solution"},
          [](auto& r) -> auto& { return r.copies; }),
      option<R>(
          {.name = "ignore-limits", .text = "Solutions outside the limits as well"},
          [](auto& r) -> auto& { return r.ignore_limits; }),
      option<R>(
          {.name = "free-heading",
           .text = "Of five axes: keep the pose's position, pitch and roll, and turn its heading "
                   "(about axis 1) so that it can be reached"},
          [](auto& r) -> auto& { return r.free_heading; }),
      option<R>(
          {.name = "numeric", .text = "Search numerically although there is a closed form"},
          [](auto& r) -> auto& { return r.numeric; }),
      option<R>(
          {.name = "starts",
           .text = "Random configurations that numeric search begins at",
           .low = 1,
           .high = 1e6},
          [](auto& r) -> auto& { return r.starts; }),
      option<R>(
          {.name = "seed", .text = "Seed of these configurations"},
          [](auto& r) -> auto& { return r.seed; })};
  return options;
}

}  // namespace kaboum::kinematics
