#pragma once

#include <kaboum/base/option.h>
#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/preparation_options.h>

#include <set>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Options of a set of convex bodies as a user states them; a request follows from them.
struct SetOptions {
  SetRequest request;  ///< all but `preparation`, `wrap` and `hold_exact_faces`
  PreparationOptions preparation;
};

/// Name of the option that states SetRequest::regions, which front ends read: none of the table.
inline constexpr const char* kRegionsOption = "epsilon-map";

/// The options of a set, in the order in which records state them.
const std::vector<Option<SetOptions>>& set_options();

/// The request that options come to.
SetRequest request_of(const SetOptions& options);

/// Options that come to a request; its source, and what no option states, apart.
SetOptions options_of(const SetRequest& request);

/// Epsilon of a robot's links where nothing is asked for. [m]
inline constexpr double kRobotEpsilon = 0.01;

/// Makes the options those of a robot's links: lengths in metres, and by default one epsilon for
/// all links, kRobotEpsilon, unless a limit is given.
void be_of_robot(SetOptions& options);

/// Why the options do not go together, with names as OptionDescription::text has them; empty where
/// they do.
/// @param stated  names of those that a user stated, kRegionsOption too
std::string contradiction(const SetOptions& options, const std::set<std::string>& stated);

/// Options of the sets of a robot's links as a user states them.
struct RobotSetOptions {
  SetOptions set;
  bool visual = false;  ///< shapes for drawing, not those for collisions
};

/// The options of a robot's sets: those of a set, and geometry.
const std::vector<Option<RobotSetOptions>>& robot_set_options();

}  // namespace kaboum::certify
