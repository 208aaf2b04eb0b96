#pragma once

#include <kaboum/certify/sweep.h>
#include <kaboum/verify/inclusion.h>

#include <functional>
#include <string>

// What is decided of swept sets. Internal to kaboum_certify.
namespace kaboum::certify {

/// Decides that a set holds, all along the path and within its margin, the bodies of the robot's
/// meshes, in the meshes' own frames, and its boxes, cylinders and spheres: with kinematics of
/// libverify's own.
verify::Claim decide_motion(const robot::RobotFile& robot, const CertifiedBodies& bodies,
                            const robot::Path& path, const geom::ConvexSet& set,
                            std::size_t max_cells,
                            const std::function<void(const std::string&)>& progress);

}  // namespace kaboum::certify
