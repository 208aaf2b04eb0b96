#pragma once

#include <kaboum/certify/link_verdict.h>

#include <string>
#include <vector>

#include "options.h"

/// Pages of bcd-decompose: bodies over what they were made of. docs/pages.md.
namespace kaboum::tools {

/// Of a mesh, which is read again.
/// @throws Error as reading and preparing it.
std::string page_of_set(const DecomposeOptions& options, const certify::SetCertificate& certificate,
                        const geom::ConvexSet& set);

/// Of a robot, at zero joint values.
/// @throws Error as reading its meshes.
std::string page_of_robot(const DecomposeOptions& options, const robot::RobotFile& robot,
                          const certify::CertifiedRobot& made,
                          const std::vector<certify::LinkVerdict>& verdicts);

/// All links at zero joint values, for pictures: not certified.
geom::ConvexSet at_rest(const robot::Robot& robot,
                        const std::vector<certify::CertifiedLink>& links);

}  // namespace kaboum::tools
