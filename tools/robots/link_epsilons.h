#pragma once

#include <kaboum/certify/wanted_meshes.h>
#include <kaboum/robot/robot.h>

#include <string>

namespace kaboum::tools {

/// The text of a file of --epsilons: YAML (or JSON), names of links, or patterns with * and ?, each
/// with a length or percentage.
/// @param file  its name, for messages.
/// @return nothing for links that no line is for; the first line that fits counts, but a line with
///   the link's name goes before all patterns.
/// @throws Error{InvalidInput} naming file and line: not one mapping, no length, nothing that fits
/// a
///   line; Error{NotBuilt} without yaml-cpp.
certify::LinkEpsilons parse_epsilons(const std::string& text, const std::string& file,
                                     const robot::Robot& robot);

}  // namespace kaboum::tools
