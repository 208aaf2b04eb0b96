// The options of deciding pairs of links: their table.

#include <kaboum/pairs/decide_options.h>

namespace kaboum::pairs {

const std::vector<Option<DecideOptions>>& decide_options() {
  using R = DecideOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "max-boxes",
           .text = "Most boxes of joint values that are looked at for one pair",
           .low = 1,
           .high = 1e9},
          [](auto& r) -> auto& { return r.most_boxes; }),
      option<R>(
          {.name = "samples",
           .text = "Places all over the limits at which contacts of a pair are looked for first",
           .low = 1,
           .high = 1e9},
          [](auto& r) -> auto& { return r.samples; }),
      option<R>(
          {.name = "timeout",
           .text = "After so long, what is left stays open",
           .values = "SECONDS",
           .low = 0,
           .between = true},
          [](auto& r) -> auto& { return r.most_seconds; })};
  return options;
}

}  // namespace kaboum::pairs
