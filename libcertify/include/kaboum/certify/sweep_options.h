#pragma once

#include <kaboum/base/option.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/certify/sweep.h>

#include <map>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Options of a swept set as a user states them: two requests and a motion follow from them.
struct SweptSetOptions {
  SweptSetOptions();

  Length epsilon{0.005};  ///< of the margin
  sweep::StepRule rule = sweep::StepRule::Balanced;
  std::optional<Length> max_reach;
  double simplify = 0;
  bool implicit_margin = false, no_merge = false;

  /// Options of the links' bodies: epsilon (by default that of the margin), vertices, effort,
  /// sheets.
  SetOptions bodies;
  bool visual = false;  ///< shapes for drawing, not those for collisions
  std::vector<std::string> links, packages;
  bool skip_missing = false;  ///< robot::ShapeChoice::skip_missing

  // The motion.
  std::vector<std::string> joints;  ///< "finger=0.04": those that the path has no column for
  bool degrees = false, ignore_limits = false;
  std::string base_pose;  ///< as robot::parse_pose takes it; empty: the origin

  std::string unit = "m";
  /// Lengths by option as they were stated: records keep their digits.
  std::map<std::string, std::string> as_stated;
};

/// The options of a swept set, in the order in which records state them.
const std::vector<Option<SweptSetOptions>>& swept_set_options();

/// The request for the bodies of the robot's links.
RobotRequest bodies_request_of(const SweptSetOptions& options);

/// The request for the swept set, with the record of all options. The motion is not decided.
SweepRequest sweep_request_of(const SweptSetOptions& options);

/// Puts a robot where its base is to stand, which the options then state as twelve numbers.
void place(robot::Robot& robot, const robot::Transform& base, SweptSetOptions& options);

}  // namespace kaboum::certify
