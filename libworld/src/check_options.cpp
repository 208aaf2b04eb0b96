// The options of checks of a world: their tables.

#include <kaboum/world/check_options.h>

namespace kaboum::world {

const std::vector<Option<Checker::Options>>& state_options() {
  using R = Checker::Options;
  static const std::vector<Option<R>> options{option<R>(
      {.name = "resting", .text = "Look at pairs of objects that rest, too"},
      [](auto& r) -> auto& { return r.resting; })};
  return options;
}

OptionDescription cloud_radius_option() {
  return {.name = "cloud-radius",
          .text =
              "How far from a point of a cloud what the sensor saw may be: free is what is "
              "apart from all balls of this radius",
          .absolute = true,
          .own_unit = "the scene's unit",
          .kind = OptionDescription::Kind::Length};
}

const std::vector<Option<MotionOptions>>& motion_options() {
  using R = MotionOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "resolution",
           .text = "How much nearer than epsilon bodies may come in a motion before it counts as "
                   "contact",
           .absolute = true},
          [](auto& r) -> auto& { return r.resolution; }),
      option<R>(
          {.name = "max-intervals",
           .text = "Most stretches of time that are looked at; then the motion is undecided",
           .low = 1,
           .high = 1e9},
          [](auto& r) -> auto& { return r.most_intervals; })};
  return options;
}

const std::vector<Option<PairOptions>>& pair_options() {
  using R = PairOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "max-boxes",
           .text = "Most boxes of joint values that are looked at for one pair",
           .low = 1,
           .high = 1e9},
          [](auto& r) -> auto& { return r.most_boxes; }),
      option<R>(
          {.name = "timeout",
           .text = "After so long, what is left stays unproved",
           .values = "SECONDS",
           .low = 0,
           .between = true,
           .otherwise = "never"},
          [](auto& r) -> auto& { return r.most_seconds; })};
  return options;
}

}  // namespace kaboum::world
