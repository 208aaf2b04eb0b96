// The options of a trajectory: their table, and the limits of speed that they state.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/motion/blended_path.h>
#include <kaboum/motion/trajectory_options.h>

#include <algorithm>

namespace kaboum::motion {
namespace {

/// Where the robot's file states nothing. [rad/s or m/s; per s]
constexpr double kVelocity = 1, kAcceleration = 5;
constexpr double kJerks = 20;  ///< times the acceleration: it is built up in 1/20 s

using Bounds = std::vector<std::optional<double>>;

/// What the robot allows, or `usual`; lower where it is asked for.
std::vector<double> of_each_joint(const std::map<std::string, double>& asked, const char* option,
                                  const std::vector<double>& usual, const Bounds& allowed,
                                  const robot::Robot& robot) {
  std::vector<std::string> names;
  for (const robot::Variable& v : robot.variables) names.push_back(v.name);
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidArgument, std::string("«") + option + "»: " + what);
  };
  for (const auto& [name, value] : asked) {
    if (!(value > 0)) refuse("a limit must be above 0");
    if (name.empty()) continue;
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
      refuse("the robot has no joint '" + name + "'" + did_you_mean(name, names));
    const auto& most = allowed[static_cast<std::size_t>(at - names.begin())];
    if (most && value > *most)
      refuse("that of '" + name + "' is above what the robot's file allows");
  }
  std::vector<double> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto own = asked.find(names[i]), all = asked.find("");
    const auto& found = own != asked.end() ? own : all;
    const double most = allowed[i].value_or(found == asked.end() ? usual[i] : found->second);
    out.push_back(found == asked.end() ? most : std::min(found->second, most));
  }
  return out;
}

}  // namespace

const std::vector<Option<TrajectoryOptions>>& trajectory_options() {
  using R = TrajectoryOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          {.name = "time-optimal",
           .text = "As fast as the limits allow along each segment (trapezoids of velocity; "
                   "accelerations jump), instead of quintic polynomials"},
          [](auto& r) -> auto& { return r.time_optimal; }),
      option<R>(
          {.name = "rate", .text = "Samples per second", .values = "HZ", .low = 1e-3, .high = 1e6},
          [](auto& r) -> auto& { return r.rate; }),
      option<R>(
          {.name = "blend",
           .text =
               "Goes through corners without a stop, on a curve that takes at most this share of "
               "each of the two segments, and a half of one between two such corners; less, or a "
               "stop, where that is not certified free. 0: it stops at each corner",
           .values = "SHARE",
           .low = 0,
           .high = kMostBlend},
          [](auto& r) -> auto& { return r.blend; }),
      option<R>(
          {.name = "max-velocity",
           .text = "Of all joints, or of one; radians or metres per second. That of one joint "
                   "goes before that of all; never above what the robot's file states",
           .low = 0,
           .between = true,
           .for_all = true,
           .otherwise = "what the robot's file states; 1 where it states none"},
          [](auto& r) -> auto& { return r.velocities; }),
      option<R>(
          {.name = "max-acceleration",
           .text = "Of all joints, or of one; per second squared",
           .low = 0,
           .between = true,
           .for_all = true,
           .otherwise = "5"},
          [](auto& r) -> auto& { return r.accelerations; }),
      option<R>(
          {.name = "max-jerk",
           .text = "Of all joints, or of one, with {blend}; per second cubed",
           .low = 0,
           .between = true,
           .for_all = true,
           .otherwise = "20 times the acceleration"},
          [](auto& r) -> auto& { return r.jerks; })};
  return options;
}

SpeedLimits speed_limits(const TrajectoryOptions& o, const robot::Robot& robot) {
  if (!(o.blend >= 0 && o.blend <= kMostBlend))
    throw Error(ErrorCode::InvalidArgument, "«blend» must be from 0 to 0.95");
  if (o.blend > 0 && o.time_optimal)
    throw Error(ErrorCode::InvalidArgument,
                "«time-optimal» is of motions that stop at each corner; leave it out with «blend»");
  if (o.blend == 0 && !o.jerks.empty())
    throw Error(ErrorCode::InvalidArgument, "«max-jerk» is kept with «blend» only");
  Bounds velocities;
  for (const robot::Variable& v : robot.variables) velocities.push_back(v.velocity);
  const std::size_t count = velocities.size();
  SpeedLimits out{
      of_each_joint(o.velocities, "max-velocity", std::vector(count, kVelocity), velocities, robot),
      of_each_joint(o.accelerations, "max-acceleration", std::vector(count, kAcceleration),
                    Bounds(count), robot)};
  if (o.blend == 0) return out;
  std::vector<double> usual = out.acceleration;
  for (double& x : usual) x *= kJerks;
  out.jerk = of_each_joint(o.jerks, "max-jerk", usual, Bounds(count), robot);
  return out;
}

}  // namespace kaboum::motion
