// The options of who decides contacts: their table.

#include <kaboum/engines/engine_options.h>
#include <kaboum/robot/shape_options.h>

#include <array>
#include <utility>

namespace kaboum::engines {

const std::vector<Option<EngineRequest>>& engine_options() {
  using R = EngineRequest;
  static constexpr std::array<std::pair<const char*, Library>, 4> kLibraries{
      {{"own", Library::Own},
       {"fcl", Library::Fcl},
       {"bullet", Library::Bullet},
       {"ode", Library::Ode}}};
  static constexpr std::array<std::pair<const char*, Shapes>, 2> kShapes{
      {{"sets", Shapes::Sets}, {"meshes", Shapes::Meshes}}};
  static const std::vector<Option<R>> options{
      choice<R>(
          {.name = "engine",
           .text = "Who decides contacts: own bounded predicates, or a library of others, to "
                   "compare with: what it says is not certified"},
          [](auto& r) -> auto& { return r.library; }, kLibraries),
      choice<R>(
          {.name = "engine-shapes",
           .text = "What that library is given: the bounding sets, or the meshes that they were "
                   "made of"},
          [](auto& r) -> auto& { return r.shapes; }, kShapes),
      option<R>(
          {.name = "engine-step",
           .text = "How far a point may move between the samples at which that library looks at a "
                   "motion",
           .absolute = true},
          [](auto& r) -> auto& { return r.step; }),
      option<R>(
          option_named(robot::shape_options(), "package-path"),
          [](auto& r) -> auto& { return r.packages; })};
  return options;
}

}  // namespace kaboum::engines
