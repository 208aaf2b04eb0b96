// The options of reading a path: their table.

#include <kaboum/robot/path_options.h>

namespace kaboum::robot {

namespace {

using R = PathOptions;

std::vector<Option<R>> table() {
  const auto checks = [](auto& r) -> auto& { return r.check_limits; };
  Option<R> ignored = option<R>({.name = "ignore-limits",
                                 .text = "Allow waypoints outside the joints' limits",
                                 .unrecorded = true},
                                checks);
  ignored.value = [](const R& r) { return option_text::of(!r.check_limits); };
  ignored.assign = [](R& r, const std::string& text) { r.check_limits = text != "true"; };
  return {option<R>(
              {.name = "joint",
               .text = "Value of a joint that does not move and has no column in the path, in "
                       "radians or metres; for each such joint"},
              [](auto& r) -> auto& { return r.fixed; }),
          option<R>(
              {.name = "degrees",
               .text = "Angles of the path and of {joint} are in degrees, not radians"},
              [](auto& r) -> auto& { return r.degrees; }),
          std::move(ignored)};
}

}  // namespace

const std::vector<Option<PathOptions>>& path_options() {
  static const std::vector<Option<R>> options = table();
  return options;
}

OptionDescription base_pose_option() {
  return {.name = "base-pose",
          .text =
              "Where the robot's root stands in the world, in the robot's unit of length and "
              "radians: X,Y,Z or X,Y,Z,ROLL,PITCH,YAW or X,Y,Z,QX,QY,QZ,QW or X,Y,Z and a "
              "matrix, row by row",
          .values = "POSE",
          .otherwise = "the origin"};
}

}  // namespace kaboum::robot
