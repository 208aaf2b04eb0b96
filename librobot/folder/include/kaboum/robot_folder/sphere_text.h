#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/robot_file.h>

#include <optional>
#include <string>

namespace kaboum::robot_folder {

/// Formats that hold the spheres of a robot's links.
enum class SphereFormat {
  Curobo,  ///< YAML, `collision_spheres`
  Xrdf,    ///< XRDF 1.0: `geometry`, `collision`, `self_collision`; nothing about joints
  Srdf,    ///< <link_sphere_approximation> elements; no groups, no pairs
  Urdf,    ///< the robot, with spheres as its <collision> elements
};

/// By the extension: .yaml and .yml, .xrdf, .srdf, .urdf.
std::optional<SphereFormat> sphere_format_of(const std::string& file);

/// The spheres of a robot's links as a file. Centres are float32 numbers; radii are float32 numbers
/// rounded up by what that moved the centre.
/// @param file  to be written: names of meshes for drawing are made relative to it
/// @pre every body is a point with a margin
/// @throws Error{InvalidInput} where a URDF is wanted of a robot that is none
std::string sphere_text(SphereFormat format, const robot::RobotFile& robot,
                        const certify::CertifiedBodies& bodies, const std::string& parameters,
                        const std::string& file);

}  // namespace kaboum::robot_folder
