// The options of kaboum-move.

#include "options.h"

#include <kaboum/base/similar_name.h>
#include <kaboum/motion/path_options.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/request_options.h"

namespace kaboum::tools {
namespace {

/// Where the robot's file states nothing. [rad/s or m/s; per s]
constexpr double kVelocity = 1, kAcceleration = 5;

void describe_execution(CLI::App& app, MoveOptions& o) {
  auto* trajectory =
      app.add_option("--trajectory", o.trajectory,
                     "Write samples over time: from rest to rest along each segment, by quintic "
                     "polynomials, within the limits below; CSV")
          ->type_name("FILE");
  app.add_flag("--time-optimal", o.time_optimal,
               "As fast as the limits allow along each segment (trapezoids of velocity; "
               "accelerations jump), instead of quintic polynomials")
      ->needs(trajectory);
  app.add_option("--rate", o.rate, "Samples per second")
      ->check(number_from(1e-3, 1e6))
      ->needs(trajectory)
      ->capture_default_str()
      ->type_name("HZ");
  app.add_option("--max-velocity", o.velocities,
                 "Of all joints, or one as in elbow=0.5; radians or metres per second; may be "
                 "repeated. Never above what the URDF states [that; 1 where it states none]")
      ->needs(trajectory)
      ->type_name("X|NAME=X");
  app.add_option("--max-acceleration", o.accelerations,
                 "Of all joints, or one; per second squared; may be repeated [5]")
      ->needs(trajectory)
      ->type_name("X|NAME=X");
}

/// "2" for all, "elbow=2" for one.
struct JointValue {
  std::optional<std::size_t> variable;
  double value = 0;
};

JointValue parse_joint_value(const std::string& text, const char* option,
                             const robot::Robot& robot) {
  const std::size_t sign = text.rfind('=');
  const char *begin = text.data() + (sign == std::string::npos ? 0 : sign + 1),
             *end = text.data() + text.size();
  JointValue out;
  const auto [stop, error] = std::from_chars(begin, end, out.value);
  if (error != std::errc() || stop != end || !(out.value > 0) || !std::isfinite(out.value))
    throw Error(ErrorCode::InvalidArgument, std::string(option) +
                                                ": write NUMBER or NAME=NUMBER, above 0, as in "
                                                "elbow=0.5, not '" +
                                                text + "'");
  if (sign == std::string::npos) return out;
  const std::string name = text.substr(0, sign);
  std::vector<std::string> names;
  for (const robot::Variable& v : robot.variables) names.push_back(v.name);
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw Error(ErrorCode::InvalidArgument, std::string(option) + ": the robot has no joint '" +
                                                name + "'" + did_you_mean(name, names));
  out.variable = static_cast<std::size_t>(at - names.begin());
  return out;
}

using Limits = std::vector<std::optional<double>>;

/// What the robot allows, or `usual`; lower as the texts have it, of which the later counts.
std::vector<double> per_joint(const std::vector<std::string>& texts, const char* option,
                              double usual, const Limits& limits, const robot::Robot& robot) {
  std::vector<double> out;
  for (const auto& limit : limits) out.push_back(limit.value_or(usual));
  for (const std::string& text : texts) {
    const auto [variable, value] = parse_joint_value(text, option, robot);
    if (variable && value > limits[*variable].value_or(value))
      throw Error(ErrorCode::InvalidArgument,
                  std::string(option) + ": '" + text + "' is above what the robot's file allows");
    for (std::size_t i = 0; i < out.size(); ++i)
      if (!variable || i == *variable) out[i] = std::min(value, limits[i].value_or(value));
  }
  return out;
}

}  // namespace

void describe(CLI::App& app, MoveOptions& o) {
  app.add_option("SCENE", o.scene, "Scene file (docs/scene.md)")->required();
  app.add_option("--robot", o.robot, "Which robot moves [the only one]")->type_name("NAME");
  auto* from =
      app.add_option("--from", o.from, "Joint values to start from, separated by commas [home]")
          ->type_name("Q1,Q2,…");
  app.add_option("--start", o.start, "Start from the last waypoint of a path, CSV or JSON")
      ->type_name("FILE")
      ->excludes(from);
  app.add_option("--to", o.to, "Joint values to go to; may be repeated: one of them is reached")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("Q1,Q2,…");
  app.add_option("--goals", o.goals, "Go to one of the lines of a file of joint values")
      ->type_name("FILE");
  app.add_option("-o,--output", o.output, "The path's waypoints, CSV; - is stdout")
      ->capture_default_str()
      ->type_name("FILE");
  app.add_flag("--degrees", o.degrees,
               "Angles are in degrees, those read and those in -o and --trajectory [radians]");
  add_request_options(app, motion::path_options(), o.search, o.stated);
  describe_execution(app, o);
  add_common_options(app, o.common);
  app.footer(
      "Objects, other robots and what is carried are as the scene has them. Paths are in radians "
      "(--degrees: degrees) and metres. A path that is written is certified; that none was found "
      "says nothing "
      "(docs/algorithms/motion-planning.md).\n"
      "Exit codes: 0 done; 1 the start, or every goal, is not free; 2 usage; 3 bad input; 4 output "
      "failed; 6 internal error; 7 no path found (--max-work, --max-nodes, --timeout).");
}

motion::SpeedLimits speed_limits(const MoveOptions& o, const robot::Robot& robot) {
  Limits velocity;
  for (const robot::Variable& v : robot.variables) velocity.push_back(v.velocity);
  return {per_joint(o.velocities, "--max-velocity", kVelocity, velocity, robot),
          per_joint(o.accelerations, "--max-acceleration", kAcceleration, Limits(velocity.size()),
                    robot)};
}

}  // namespace kaboum::tools
