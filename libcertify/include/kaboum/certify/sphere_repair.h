#pragma once

#include <kaboum/base/length.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/sphere_file.h>

#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for repair_spheres.
struct RepairRequest {
  Length epsilon;  ///< no point of a link's spheres is to be farther from its solid
  robot::ShapeChoice shapes;
  bcd::Effort effort = bcd::Effort::Normal;
};

/// What became of a link's spheres.
struct RepairedLink {
  std::string link;
  std::size_t kept = 0, grown = 0, shrunk = 0, moved = 0, added = 0;
  double epsilon = 0;  ///< certified: none reaches farther from the link's solid [length]
};

/// Spheres that were repaired, read back from the text and decided exactly.
struct RepairedSpheres {
  std::string text;                 ///< of the file, in the format of the one given
  std::vector<RepairedLink> links;  ///< that have a shape
  std::size_t spheres = 0;
  std::vector<std::string> notes;  ///< of preparation: what a user should know
};

/// Spheres of somebody's changed as little as was found to suffice (bcd::repair_balls), so that
/// each link's hold its triangles and the solid that is meant by them, and reach no farther than
/// epsilon from that solid. The text of the file is read back. verify::decide_spheres and
/// verify::verify_excess decide what is claimed.
///
/// Shapes without triangles are held by way of polytopes round them; what these are farther is
/// taken off epsilon. Spheres of links without shapes stay as they are.
///
/// @param file, text  of the spheres, as robot::parse_spheres
/// @throws as verify::decide_spheres and bcd::repair_balls; Error{InvalidInput} naming the link
///   whose shapes have no solid; Error{LimitReached} where what was found does not pass
RepairedSpheres repair_spheres(const robot::RobotFile& robot, const std::string& file,
                               const std::string& text, const RepairRequest& request,
                               const RobotHooks& hooks = {});

}  // namespace kaboum::certify
