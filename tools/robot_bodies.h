#pragma once

#include <kaboum/geom/error.h>
#include <kaboum/sweep/sweep.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli.h"

/// What the tools that work on robots share: reading them, and the convex bodies of their links.
namespace kaboum::tools {

/// A robot as read from its file.
struct RobotFile {
  robot::Robot robot;
  std::filesystem::path path;
  std::string sha256;
};

/// Reads URDF, or the Robotics Library's rlkin and rlmdl (told apart by the root element). Links of
/// the latter get the mesh in the robot's folder that has their name; `bodyN` also that of `linkN`.
/// @throws Error{InvalidInput}.
RobotFile read_robot(const std::string& path);

/// @throws Error{InvalidArgument} naming the first of `links` that the robot does not have.
void require_links(const RobotFile& robot, const std::vector<std::string>& links);

/// Links that have no shape of the kind asked for.
struct BareLinks {
  std::vector<std::string> empty;  ///< that have none at all
  std::vector<std::string> other;  ///< that have shapes of the other kind
  [[nodiscard]] std::vector<std::string> all() const;
};
/// @param visual  the kind: shapes for drawing, else those for collisions
/// @param links   only these; empty: all
BareLinks bare_links(const robot::Robot& robot, bool visual,
                     const std::vector<std::string>& links = {});

/// One line for each kind of bare links; `consequence` ends it.
std::vector<std::string> notes_on(const BareLinks& bare, bool visual,
                                  const std::string& consequence);

/// "8 of 9 links judged; 'l1' has shapes of the other kind only".
std::string links_judged(std::size_t judged, std::size_t asked, const BareLinks& bare);

/// One line for each box, cylinder and sphere without volume, with its place in the robot's file.
std::vector<std::string> notes_on_flat_shapes(const RobotFile& robot, bool visual,
                                              const std::vector<std::string>& links = {});

/// 'a', 'b' and 2 more.
std::string names_of(const std::vector<std::string>& names);

struct BodyOptions {
  std::vector<std::string> links;     ///< only these; empty: all that have a shape
  bool visual = false;                ///< shapes for drawing instead of those for collisions
  std::vector<std::string> packages;  ///< folders that package:// URIs are looked up in
  std::string epsilon = "1%";         ///< of the decomposition; lengths in the robot's unit
  std::size_t max_vertices = 64;
  std::string effort = "normal";
  std::string cache;  ///< folder; empty: as bcd-decompose
  bool no_cache = false;
  bool drop_sheets = false;  ///< back-to-back faces without volume are left out
  int threads = 0;           ///< of the decomposition; 0: one per core
  bool quiet = false;
};

struct LinkBodies {
  std::vector<robot::LinkBody> bodies;
  double epsilon = 0;              ///< largest certified distance of a body from its shape [length]
  std::vector<std::string> files;  ///< meshes read
  BareLinks bare;                  ///< of the links asked for
  std::vector<std::string> notes;  ///< things a user should know; one sentence each
};

/// Convex bodies of a robot's links: of meshes by the program bcd-decompose beside this one, which
/// keeps them in its cache; boxes, cylinders and spheres as bounding polytopes.
/// @throws Error naming the link and the file, which must exist.
LinkBodies bodies_of(const RobotFile& robot, const BodyOptions& options);

/// Appends the bodies of one shape in the frame of its link, points within the bodies' margins:
/// those of `set` for a mesh, else a bounding polytope; none for a point.
/// @param set   of the mesh in its own frame and unit; unused for other shapes.
/// @param link  name that the bodies' names begin with; `index` is the link's.
void place_shape(const robot::Geometry& shape, const geom::ConvexSet* set, const std::string& link,
                 std::uint32_t index, std::vector<robot::LinkBody>& bodies);

/// "5%" as it is; a length in the robot's unit in that of a mesh whose coordinates are multiplied
/// by `scale`.
std::string epsilon_of_mesh(const std::string& epsilon, double scale);

}  // namespace kaboum::tools
