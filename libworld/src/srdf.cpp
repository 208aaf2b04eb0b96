// Allowed pairs of links as SRDF, which MoveIt reads.

#include <kaboum/base/xml_text.h>
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

std::string to_srdf(const RobotModel& robot, const std::vector<AllowedPair>& pairs) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<robot name=\"" + escape_xml(robot.kinematics.name) + "\">\n";
  for (const AllowedPair& pair : pairs)
    out += "  <disable_collisions link1=\"" + escape_xml(robot.kinematics.links[pair.a].name) +
           "\" link2=\"" + escape_xml(robot.kinematics.links[pair.b].name) + "\" reason=\"" +
           reason_in_srdf(pair.reason) + "\"/>\n";
  return out + "</robot>\n";
}

}  // namespace kaboum::world
