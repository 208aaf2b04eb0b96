#pragma once

#include <kaboum/base/notes.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/moving_points.h>
#include <kaboum/verify/sweep.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/verdict.h"
#include "sweep.h"

/// The files that `bound-verify sweep` judges.
namespace kaboum::tools {

/// The shapes of a robot's links that are to be held.
struct SweepShapes {
  std::vector<verify::MovingShape> shapes;
  std::vector<std::uint32_t> links;         ///< of the shapes
  std::vector<verify::MovingPoints> exact;  ///< of the exact faces of CAD files
  std::vector<std::string> files;           ///< of the meshes
  std::vector<std::string> notes;
  Notes mesh_notes;
  DroppedSheets dropped;
  robot::BareLinks bare;
  std::size_t judged = 0, asked = 0;  ///< links
  bool cad = false;                   ///< triangles of some stand for exact faces
};

/// @throws Error naming the file; when no link has a shape.
SweepShapes read_shapes(const robot::RobotFile& file, const VerifySweepOptions& options);

/// What to try where the meshes as they are were not found within the set; empty if nothing.
std::string preparing_hint(const SweepShapes& shapes);

/// The set that is to hold them.
struct SweptInput {
  geom::ConvexSet set;
  std::string sha256;
  std::vector<std::string> notes;
};

/// A container, a mesh file, a folder, or a URDF as sweep-approx writes it.
/// @throws Error naming the file.
SweptInput read_swept(const std::string& path, const VerifySweepOptions& options);

}  // namespace kaboum::tools
