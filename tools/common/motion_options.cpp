// Options of tools that read motions.

#include "motion_options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

namespace kaboum::tools {

CLI::Option* add_degrees_option(CLI::App& app, bool& degrees) {
  return app.add_flag("--degrees", degrees,
                      "Angles of the path and of --joint are in degrees, not radians");
}

CLI::Option* add_base_option(CLI::App& app, std::string& value) {
  return app
      .add_option("--base-pose", value,
                  "Where the robot's root stands in the world, in the robot's unit of length and "
                  "radians: X,Y,Z or X,Y,Z,ROLL,PITCH,YAW or X,Y,Z,QX,QY,QZ,QW or X,Y,Z and a "
                  "matrix, row by row [the origin]")
      ->type_name("POSE");
}

CLI::Option* add_joint_option(CLI::App& app, std::vector<std::string>& values) {
  return app
      .add_option(
          "--joint", values,
          "Value of a joint that does not move and has no column in the path, in radians or "
          "metres, as in finger=0.04; may be repeated")
      ->type_name("NAME=X");
}

robot::FixedJoints fixed_joints(const std::vector<std::string>& values) {
  robot::FixedJoints out;
  for (const std::string& text : values) {
    const std::size_t sign = text.rfind('=');
    double value = 0;
    const char* end = text.data() + text.size();
    const char* begin = sign == std::string::npos ? end : text.data() + sign + 1;
    if (begin != end && *begin == '+') ++begin;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc() || stop != end || !std::isfinite(value) || sign == 0)
      throw Error(ErrorCode::InvalidArgument,
                  "--joint: write NAME=NUMBER, as in finger=0.04, not " + text);
    if (!out.emplace(text.substr(0, sign), value).second)
      throw Error(ErrorCode::InvalidArgument,
                  "--joint: '" + text.substr(0, sign) + "' is given twice");
  }
  return out;
}

}  // namespace kaboum::tools
