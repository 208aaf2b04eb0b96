#pragma once

#include <kaboum/pairs/decide.h>

#include <string>
#include <vector>

#include "common/cli.h"

namespace kaboum::tools {

/// For reports and --json.
Json pairs_json(const robot::Robot& robot, const std::vector<pairs::DecidedPair>& pairs);
/// What pairs were decided in.
enum class Span {
  Limits,         ///< all of the joints' limits
  Configuration,  ///< one configuration
};

/// "a b: can touch, 0.0039 to 0.02 deep at 0,-1.2,0", or "a b: in contact, 0.0039 to 0.02 deep".
std::string line_of(const robot::Robot& robot, const pairs::DecidedPair& pair, Span span);
/// "0.0039 to 0.02", or "at least 0.0039" where no upper bound is known.
std::string words_of(const pairs::Bracket& bracket);
/// "55 pairs: 32 never touch, 4 always do, …", or "55 pairs: 51 apart, 4 in contact, …"
std::string summary_of(const std::vector<pairs::DecidedPair>& pairs, Span span, double seconds);
/// Whether a configuration is found to have a contact that is more than a joint's.
bool is_contact(const pairs::DecidedPair& pair);
/// Whether it is not known of a configuration whether it has such a contact.
bool is_unknown(const pairs::DecidedPair& pair);
/// A PNG of the robot in a configuration: links that touch are orange.
std::vector<char> picture_of(const robot::Robot& robot,
                             const std::vector<pairs::LinkSurface>& surfaces,
                             const std::vector<double>& q,
                             const std::vector<pairs::DecidedPair>& pairs);
/// SRDF with <disable_collisions> of the pairs that never touch and of those that are connected.
std::string to_srdf(const robot::Robot& robot, const std::vector<pairs::DecidedPair>& pairs);
/// A sentence on adjacent links that it does not have; empty: it has all.
std::string left_out_of_srdf(const robot::Robot& robot,
                             const std::vector<pairs::DecidedPair>& pairs);

}  // namespace kaboum::tools
