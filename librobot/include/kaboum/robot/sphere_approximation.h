#pragma once

#include <kaboum/geom/mesh.h>

#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot {

/// A sphere of a link, in the link's frame.
struct LinkSphere {
  geom::Vec3 center;
  double radius;  ///< ≥ 0; 0 says that the link has no shape
  int line;
};

/// The spheres that an SRDF has in place of a link's shape.
struct SphereApproximation {
  std::string link;
  int line;
  std::vector<LinkSphere> spheres;
};

/// The <link_sphere_approximation> elements of an SRDF, as MoveIt and Tesseract have them, in the
/// order of the file. Other elements are not looked at.
/// @param name  of the file, for messages
/// @throws Error{InvalidInput} naming file and line: what is not well-formed, no SRDF, numbers
///   that are not finite, radii below 0, other elements where a sphere is expected, a link twice
std::vector<SphereApproximation> parse_sphere_approximations(std::string_view text,
                                                             const std::string& name);

}  // namespace kaboum::robot
