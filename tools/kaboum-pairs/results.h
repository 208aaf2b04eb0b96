#pragma once

#include <kaboum/pairs/decide.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// For reports and --json.
Json pairs_json(const robot::Robot& robot, const std::vector<pairs::DecidedPair>& pairs);
/// "a b: can touch, 0.0039 to 0.02 deep at 0,-1.2,0".
std::string line_of(const robot::Robot& robot, const pairs::DecidedPair& pair);
/// "0.0039 to 0.02", or "at least 0.0039" where no upper bound is known.
std::string words_of(const pairs::Bracket& bracket);
/// "55 pairs: 32 never touch, 4 always do, …"
std::string summary_of(const std::vector<pairs::DecidedPair>& pairs, double seconds);
/// SRDF with <disable_collisions> of the pairs that never touch and of those that are connected.
std::string to_srdf(const robot::Robot& robot, const std::vector<pairs::DecidedPair>& pairs);
/// A sentence on adjacent links that it does not have; empty: it has all.
std::string left_out_of_srdf(const robot::Robot& robot,
                             const std::vector<pairs::DecidedPair>& pairs);

}  // namespace kaboum::tools
