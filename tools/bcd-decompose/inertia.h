#pragma once

#include <kaboum/certify/inertia.h>
#include <kaboum/robot/robot_file.h>

#include <optional>
#include <string>
#include <vector>

#include "common/cli.h"

/// Masses of a robot's links, as --inertia asks for them.
namespace kaboum::tools {

/// What --inertia asks for: a density, or none where links keep their masses.
/// @throws Error{InvalidArgument} on anything but "mass" and a number above 0
std::optional<double> density_of(const std::string& option);

/// Bounds of all links; a link that the document has no place for is one that nothing is known of.
std::vector<certify::LinkInertia> find_inertia(const robot::RobotFile& robot,
                                               const certify::InertiaRequest& request);

/// True if all that was asked for is known.
bool all_known(const std::vector<certify::LinkInertia>& links);

/// One line on all of them, and one on each that keeps what its file says.
std::vector<std::string> in_words(const robot::Robot& robot,
                                  const std::vector<certify::LinkInertia>& links);

Json report_of(const robot::Robot& robot, const std::vector<certify::LinkInertia>& links);

}  // namespace kaboum::tools
