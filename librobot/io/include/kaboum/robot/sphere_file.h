#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/robot.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::robot {

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
  std::optional<Robot> robot;      ///< whose shapes they are, where the file has a robot
  std::string robot_name = {};     ///< what it calls its robot; empty: nothing is said
};

/// Reads spheres of cuRobo's YAML (`collision_spheres`, alone or under `robot_cfg: kinematics:`,
/// with its `collision_sphere_buffer` added to the radii; of links that `collision_link_names`
/// names, where it is there: others have none); of XRDF 1.0 and 2.0 (`geometry`, the one
/// that `collision` names, with its `buffer_distance`); of an SRDF's <link_sphere_approximation>;
/// or those of a URDF's <collision> elements, as foam and VAMP write them.
/// @throws Error{InvalidInput} naming file and line: what is not well-formed or given twice;
///   another number of spheres than sphere_count_comment states; radii that are not above 0,
///   numbers that are not finite, shapes that are no spheres, buffers of links without spheres.
///   Error{NotBuilt} without yaml-cpp
SphereFile read_spheres(const std::string& file);

/// The same of a text; a URDF is no xacro.
/// @param file  its name: the format by the extension; for messages
SphereFile parse_spheres(const std::string& file, const std::string& text);

/// The text of a file with other spheres; all else stays, in YAML letter by letter. Numbers have
/// all digits.
/// @param wanted  of each link all spheres that it is to have: first those read, in their order,
///   changed or not, then others; links that are not among them stay as they are
/// @throws as parse_spheres; Error{InvalidInput} where a buffer is larger than a radius, or YAML is
///   written in a way that is not edited (aliases)
std::string edited_spheres(const std::string& file, const std::string& text,
                           const std::vector<LinkSpheres>& wanted);

/// A line of YAML that states the number of all spheres of its file, so that one that is cut
/// between two spheres is told from one that has fewer. Readers of YAML pass over it; read_spheres
/// refuses another number, and edited_spheres changes it.
std::string sphere_count_comment(std::size_t count);

/// True if a file holds spheres of links, and nothing else could be meant by it: cuRobo's YAML,
/// XRDF and SRDF by the extension.
bool is_sphere_file(const std::string& file);

}  // namespace kaboum::robot
