#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/robot_file.h>

#include <string>

namespace kaboum::tools {

/// The spheres of a robot's links as cuRobo's YAML, `collision_spheres`. Centres are float32
/// numbers; radii are float32 numbers rounded up by what that moved the centre.
/// @pre every body is a point with a margin
std::string sphere_yaml(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                        const std::string& parameters);

}  // namespace kaboum::tools
