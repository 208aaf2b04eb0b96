#pragma once

#include <kaboum/execution/simulation.h>

#include <map>
#include <string>
#include <vector>

namespace kaboum::execution {

/// Who moves, by which links it holds what, and where it goes.
struct MotionPart {
  std::size_t robot = 0;
  std::map<std::size_t, std::uint32_t> holds;  ///< objects, by what link
  robot::Path path;
};

/// The motions of a payload; empty: it is of another kind.
/// @param where  in the plan it is: "node 3, grasp(o1)".
/// @throws Error{InvalidInput} for robots, objects and links that the scene does not have, paths
///   that do not fit their robot, and members of another kind; it begins with `where`.
std::vector<MotionPart> parts_of(const std::string& payload, const world::World& world,
                                 const std::string& where);

/// @throws Error{InvalidArgument} for rates and limits that are not above 0.
void require_above_zero(const SimulationOptions& options);

/// The part in time, from rest to rest along each segment.
/// @pre its path is not empty.
motion::Trajectory trajectory_of(const MotionPart& part, const world::World& world,
                                 const SimulationOptions& options);

}  // namespace kaboum::execution
