#include <kaboum/base/xml_text.h>
#include <kaboum/pairs/srdf.h>

namespace kaboum::pairs {

std::string srdf_text(const robot::Robot& robot, const std::vector<UncheckedPair>& pairs) {
  std::string out = "<?xml version=\"1.0\"?>\n<robot name=\"" + escape_xml(robot.name) + "\">\n";
  for (const auto& [a, b, reason] : pairs)
    out += "  <disable_collisions link1=\"" + escape_xml(robot.links[a].name) + "\" link2=\"" +
           escape_xml(robot.links[b].name) + "\" reason=\"" + reason + "\"/>\n";
  return out + "</robot>\n";
}

}  // namespace kaboum::pairs
