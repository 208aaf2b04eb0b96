#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/robot_file.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::robot_folder {

/// Formats that hold the spheres of a robot's links.
enum class SphereFormat {
  Curobo,  ///< YAML, `collision_spheres`
  Xrdf,    ///< XRDF 1.0: `geometry`, `collision`, `self_collision`; nothing about joints
  Srdf,    ///< <link_sphere_approximation> elements; no groups
  Urdf,    ///< the robot, with spheres as its <collision> elements
};

/// By the extension: .yaml and .yml, .xrdf, .srdf, .urdf.
std::optional<SphereFormat> sphere_format_of(const std::string& file);

/// A pair of links that need not be checked against each other.
struct UncheckedLinks {
  std::string a, b, reason;  ///< reason: as SRDF has it; may be empty
};

/// The spheres of a robot's links as a file. Centres are float32 numbers; radii are float32 numbers
/// rounded up by what that moved the centre. Buffers, which planners add to radii, are stated to be
/// 0.
/// @param file       to be written: names of meshes for drawing are made relative to it
/// @param unchecked  pairs of links, for `self_collision_ignore` (cuRobo), `ignore` (XRDF) and
///   <disable_collisions> (SRDF): those of which both links have spheres, each once. A URDF has no
///   place for them
/// @pre every body is a point with a margin
/// @throws Error{InvalidInput} where a URDF is wanted of a robot that is none
std::string sphere_text(SphereFormat format, const robot::RobotFile& robot,
                        const certify::CertifiedBodies& bodies, const std::string& parameters,
                        const std::string& file, const std::vector<UncheckedLinks>& unchecked = {});

}  // namespace kaboum::robot_folder
