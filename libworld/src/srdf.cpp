// Allowed pairs of links as SRDF, which MoveIt reads.

#include <kaboum/pairs/srdf.h>
#include <kaboum/world/allowed_pairs.h>

namespace kaboum::world {
namespace {

/// As MoveIt's assistant calls them.
const char* reason_in_srdf(AllowedPair::Reason reason) {
  switch (reason) {
    case AllowedPair::Reason::Adjacent:
      return "Adjacent";
    case AllowedPair::Reason::Never:
      return "Never";
    case AllowedPair::Reason::Always:
      return "Default";
    default:
      return "User";
  }
}

}  // namespace

std::string to_srdf(const RobotModel& robot, const std::vector<AllowedPair>& allowed) {
  std::vector<pairs::UncheckedPair> disabled;
  disabled.reserve(allowed.size());
  for (const AllowedPair& pair : allowed)
    disabled.push_back({pair.a, pair.b, reason_in_srdf(pair.reason)});
  return pairs::srdf_text(robot.kinematics, disabled);
}

}  // namespace kaboum::world
