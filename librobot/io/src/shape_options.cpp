// The options of which shapes of a robot are meant: their table.

#include <kaboum/robot/shape_options.h>

#include <array>
#include <utility>

namespace kaboum::robot {

const std::vector<Option<ShapeChoice>>& shape_options() {
  static constexpr std::array<std::pair<const char*, bool>, 2> kGeometries{
      {{"collision", false}, {"visual", true}}};
  static const std::vector<Option<ShapeChoice>> options{
      option<ShapeChoice>(
          {.name = "links",
           .text = "Only these links",
           .otherwise = "all",
           .kind = OptionDescription::Kind::Names},
          [](auto& r) -> auto& { return r.links; }),
      choice<ShapeChoice>(
          {.name = "geometry", .text = "Which shapes of a robot"},
          [](auto& r) -> auto& { return r.visual; }, kGeometries),
      option<ShapeChoice>(
          {.name = "package-path",
           .text = "A package of package:// or a folder that holds it, besides $ROS_PACKAGE_PATH, "
                   "$AMENT_PREFIX_PATH and the folders above the robot's file; there may be "
                   "several",
           .values = "DIR",
           .unrecorded = true},
          [](auto& r) -> auto& { return r.packages; })};
  return options;
}

const std::vector<Option<ShapeChoice>>& held_shape_options() {
  static constexpr std::array<std::pair<const char*, bool>, 2> kMissing{
      {{"error", false}, {"skip", true}}};
  static const std::vector<Option<ShapeChoice>> options = [] {
    std::vector<Option<ShapeChoice>> out = shape_options();
    out.push_back(choice<ShapeChoice>(
        {.name = "missing-meshes",
         .text = "What meshes without a file do: refuse the robot, or leave out their shapes, and "
                 "name their links as not verified",
         .unrecorded = true},
        [](auto& r) -> auto& { return r.skip_missing; }, kMissing));
    return out;
  }();
  return options;
}

}  // namespace kaboum::robot
