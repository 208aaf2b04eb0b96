#pragma once

#include <kaboum/geom/convex_set.h>

#include <string>
#include <vector>

namespace kaboum::tools {

/// The spheres that a file gives a link, in its frame.
struct LinkSpheres {
  std::string link;
  int line = 0;           ///< of the file; 0: not known
  geom::ConvexSet balls;  ///< each with a point as its core
};

/// Spheres of a robot's links, in the order of the file.
struct SphereFile {
  std::vector<LinkSpheres> links;
  std::string format;              ///< in words
  std::vector<std::string> notes;  ///< what a user should know
};

/// Reads spheres of cuRobo's YAML (`collision_spheres`, alone or under `robot_cfg: kinematics:`,
/// with its `collision_sphere_buffer` added to the radii); of XRDF 1.0 and 2.0 (`geometry`, the one
/// that `collision` names, with its `buffer_distance`); of an SRDF's <link_sphere_approximation>;
/// or those of a URDF's <collision> elements, as foam and VAMP write them.
/// @throws Error{InvalidInput} naming file and line: what is not well-formed, radii that are not
///   above 0, numbers that are not finite, shapes that are no spheres; Error{NotBuilt} without
///   yaml-cpp
SphereFile read_spheres(const std::string& file);

}  // namespace kaboum::tools
