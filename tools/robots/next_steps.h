#pragma once

#include <kaboum/page/preview.h>
#include <kaboum/robot_folder/robot_writer.h>

#include <optional>
#include <string>
#include <vector>

#include "check.h"

namespace kaboum::tools {

/// What pages say that a reader may do next with a robot that was written: the command that checks
/// it, and those of programs that load it.
/// @param srdf  of convex bodies: pairs of links were written; of other meshes nullopt
std::vector<page::Step> next_steps(const robot_folder::RobotWriter& writer,
                                   const RobotOptions& options, const RobotCheck& check,
                                   std::optional<bool> srdf);

}  // namespace kaboum::tools
