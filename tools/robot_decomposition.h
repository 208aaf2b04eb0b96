#pragma once

#include <kaboum/geom/convex_set.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli.h"
#include "robot_bodies.h"

/// Whole robots: the shapes of every link as convex bodies, and a URDF that refers to them.
namespace kaboum::tools {

struct RobotDecomposition {
  std::string robot;               ///< URDF file
  std::filesystem::path folder;    ///< where everything goes; made when missing
  bool visual = false;             ///< decompose the shapes for drawing, not those for collisions
  std::vector<std::string> links;  ///< only these; the others stay as they are. Empty: all
  std::vector<std::string> packages;  ///< folders that package:// URIs are looked up in
  std::string prefix;      ///< of the bodies' file names in the URDF, e.g. package://arm/
  std::string parameters;  ///< for the record
  std::string unit;
};

/// The bodies of one mesh, in its own frame and unit.
struct MeshBodies {
  geom::ConvexSet set;
  Json report;
  std::vector<std::string> other_files;  ///< read besides the mesh
};

/// Decomposes a mesh. `scale` holds the factors from the mesh's unit to the robot's, positive: a
/// length in the robot's unit that must not be exceeded is divided by the largest.
using MeshDecomposer =
    std::function<MeshBodies(const std::filesystem::path& mesh, const geom::Vec3& scale)>;

struct RobotResult {
  Json report;
  geom::ConvexSet at_rest;  ///< all links at zero joint values, for pictures: not certified
  std::vector<std::filesystem::path> inputs;  ///< all files read; some may be there twice
  BareLinks bare;  ///< links without a shape of the kind asked for: left as they are
  std::vector<std::string> notes;  ///< things a user should know of shapes; one sentence each
};

/// Writes to the folder, the URDF last:
/// - `bodies/MESH/MESH-0000.stl` …: the bodies of every distinct mesh and scale, once; no name of a
///   file, folder and extension apart, is there twice;
/// - `links/LINK.glb`: all bodies of a link in its frame, enlarged by the rounding of scale and
/// pose;
/// - the URDF under its own name: each link's <collision> elements are the bodies, with the pose
/// and
///   scale of the shape that they stand for, so that the inclusion holds without rounding; boxes,
///   cylinders and spheres stay. Relative names of other files are adapted to the folder.
/// What else is in bodies/ and links/ stays, and is named in the notes and the report (`stale`).
///
/// @throws Error naming the file; nothing but complete files is left behind.
RobotResult decompose_robot(const RobotDecomposition& options, const MeshDecomposer& decompose);

}  // namespace kaboum::tools
