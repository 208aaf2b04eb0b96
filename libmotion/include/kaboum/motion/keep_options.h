#pragma once

#include <kaboum/base/option.h>
#include <kaboum/motion/path_constraint.h>

#include <span>
#include <string>
#include <vector>

namespace kaboum::motion {

/// Constraints that a motion is to keep, by names, as users state them.
struct KeepRequest {
  /// "upright", "orientation", "line", "level", each perhaps with "=TOLERANCE"; or the name of
  /// constraints of the scene.
  std::vector<std::string> keep = {};
  std::string tool = {};  ///< or link, that the first four are of; empty: the only tool
};

/// The options of such a request: keep, tool.
const std::vector<Option<KeepRequest>>& keep_options();

/// A frame of a robot that goals and constraints are about: a tool, or a link.
/// @param name  of either, the tool first; empty: the only tool or, of a robot without tools, the
///   only last link
/// @throws Error{InvalidArgument} where there is no such one, or several for no name
world::ToolFrame moving_frame(const world::RobotModel& robot, const std::string& name);

/// The constraints that are asked for, and those of what the robot carries (carried_constraints).
/// @param start  of the motion: what is kept is what there is at first
/// @param goals  configurations; "line" leads to where the tool is there
/// @throws Error{InvalidArgument} for names that the scene lacks, tolerances that are not above 0,
///   goals at which the tool is in different places where a line leads to them; as path_constraints
///   and moving_frame
std::vector<PathConstraint> constraints_of(const world::World& world,
                                           const world::WorldState& state, std::size_t robot,
                                           const std::vector<double>& start,
                                           std::span<const std::vector<double>> goals,
                                           const KeepRequest& request);

/// The constraints that were kept, in one line: "upright within 0.05 rad (62 % of it seen)".
/// @param deviations  ConstraintAnswer::parts
std::string words_of(std::span<const PathConstraint> constraints,
                     std::span<const double> deviations);

}  // namespace kaboum::motion
