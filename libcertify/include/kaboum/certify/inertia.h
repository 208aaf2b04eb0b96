#pragma once

#include <kaboum/certify/preparation_options.h>
#include <kaboum/geom/moments.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/link_meshes.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for the masses of a robot's links.
struct InertiaRequest {
  robot::ShapeChoice shapes;      ///< that have the mass, spread evenly
  std::optional<double> density;  ///< [mass/length³]; none: a link has the mass that its file says
  PreparationOptions preparation;
  std::optional<io::Format> format;  ///< of the meshes; by default by extension
};

/// Mass and inertia of a link, in its frame.
struct LinkInertia {
  std::uint32_t link = 0;
  std::optional<geom::MassProperties> found;  ///< none: nothing is known of it
  bool overlaps = false;  ///< surfaces cross, or shapes may have points in common: wider bounds
  bool hollow = false;    ///< a place that a surface encloses counts as outside, and weighs nothing
  std::string flaw;       ///< why nothing is known, though it was asked for
  bool without_mass = false;  ///< no mass in its file that could be kept: nothing is asked for
};

/// Bounds of mass, centre and inertia of all links that have shapes of the kind: exact integrals
/// over the solids of their closed meshes, boxes, cylinders, spheres, capsules and ellipsoids. A
/// point in several of a link's shapes weighs once, which the bounds allow for.
/// docs/algorithms/inertia.md.
/// @throws Error as link_meshes; Error{InvalidArgument} on a density that is not above 0
std::vector<LinkInertia> inertia_of_links(const robot::RobotFile& robot,
                                          const InertiaRequest& request);

/// Inertials to be written, by link: numbers within the bounds.
std::map<std::string, robot::Inertial> inertials_of(const robot::Robot& robot,
                                                    const std::vector<LinkInertia>& links);

}  // namespace kaboum::certify
