#pragma once

#include <kaboum/certify/set_cache.h>
#include <kaboum/robot/link_body.h>

#include <string>
#include <vector>

#include "robot_file.h"

/// Convex bodies of the links of a robot.
namespace kaboum::tools {

struct BodyOptions {
  std::vector<std::string> links;     ///< only these; empty: all that have a shape
  bool visual = false;                ///< shapes for drawing instead of those for collisions
  std::vector<std::string> packages;  ///< folders that package:// URIs are looked up in
  /// Of the decomposition; lengths in the robot's unit.
  kaboum::Length epsilon{1, true};
  std::size_t max_vertices = 64;
  bcd::Effort effort = bcd::Effort::Normal;
  const certify::SetCache* cache = nullptr;  ///< null: none
  bool drop_sheets = false;                  ///< back-to-back faces without volume are left out
  std::function<void(const std::string&)> progress;  ///< of the decompositions; may be empty
};

struct LinkBodies {
  std::vector<robot::LinkBody> bodies;
  double epsilon = 0;              ///< largest certified distance of a body from its shape [length]
  std::vector<std::string> files;  ///< meshes read, and what they refer to; some may be there twice
  BareLinks bare;                  ///< of the links asked for
  std::vector<std::string> notes;  ///< things a user should know; one sentence each
};

/// Convex bodies of a robot's links: of meshes certified sets, from the cache where possible;
/// boxes, cylinders and spheres as bounding polytopes.
/// @throws Error naming the link and the file, which must exist.
LinkBodies bodies_of(const RobotFile& robot, const BodyOptions& options);

/// Appends the bodies of one shape in the frame of its link, points within the bodies' margins:
/// those of `set` for a mesh, else a bounding polytope; none for a point.
/// @param set   of the mesh in its own frame and unit; unused for other shapes.
/// @param link  name that the bodies' names begin with; `index` is the link's.
void place_shape(const robot::Geometry& shape, const geom::ConvexSet* set, const std::string& link,
                 std::uint32_t index, std::vector<robot::LinkBody>& bodies);

/// A percentage as it is; a length in the robot's unit in that of a mesh whose coordinates are
/// multiplied by `scale`.
kaboum::Length epsilon_of_mesh(kaboum::Length epsilon, double scale);

}  // namespace kaboum::tools
