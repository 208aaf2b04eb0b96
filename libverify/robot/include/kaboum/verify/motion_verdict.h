#pragma once

#include <kaboum/base/notes.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/path.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/moving_points.h>
#include <kaboum/verify/sweep.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The verdict on a motion: whether bodies hold a robot's links all along a path. Programs and
/// Python print, write and end with it.
namespace kaboum::verify {

/// Which shapes of a robot are to be held, and how their meshes are read.
struct MotionShapeOptions {
  robot::ShapeChoice choice = {};
  /// Judge the solid of each mesh as geom::prepare makes it, holes filled; one that it refuses is
  /// judged as it is.
  bool prepare = false;
  bool drop_sheets = false;                  ///< with `prepare`; what it refuses then is an error
  std::size_t exact_points = kPointDensity;  ///< of CAD files; 0: triangles alone
};

/// The shapes of a robot's links that are to be held.
struct MotionShapes {
  std::vector<MovingShape> shapes;   ///< "link/number" names them
  std::vector<std::uint32_t> links;  ///< of the shapes
  std::vector<MovingPoints> exact;   ///< of the exact faces of CAD files
  std::vector<std::string> files;    ///< of the meshes
  std::vector<std::string> notes;    ///< on shapes that are not judged
  Notes mesh_notes;
  std::map<std::string, std::size_t> dropped;  ///< triangles of sheets, of each file that had some
  robot::BareLinks bare;
  std::size_t judged = 0, asked = 0;  ///< links
  bool cad = false;                   ///< triangles of some stand for exact faces
};

/// @throws Error naming the file; Error{InvalidInput} where no link has a shape
MotionShapes read_motion_shapes(const robot::RobotFile& robot, const MotionShapeOptions& options);

/// Convex bodies of a swept volume: a container, a mesh file, a folder, or a URDF of one link whose
/// collision shapes are meshes, neither moved nor scaled.
struct SweptBodies {
  geom::ConvexSet set;
  std::string sha256;
  std::vector<std::string> notes;
};

/// @param format    by default by the name
/// @param packages  folders that package:// of a URDF is looked up in
/// @throws Error naming the file
SweptBodies read_swept_bodies(const std::string& path, std::optional<io::Format> format = {},
                              const std::vector<std::string>& packages = {});

/// Question about a motion. Referred to while it is decided.
struct MotionQuestion {
  const robot::Robot& robot;
  const MotionShapes& shapes;
  const robot::Path& path;
  const geom::ConvexSet& set;
  Claims claims = Claims::All;     ///< that decide; All or Surface
  std::optional<double> gap = {};  ///< SweepOptions::gap; default_gap unless given
  std::size_t max_cells = SweepOptions{}.max_cells;
  std::function<void(const std::string&)> progress = {};
};

struct MotionVerdict {
  Answer answer = Answer::Undefined;  ///< of the claims that decide, and of the exact points
  SweepClaims claims;
  std::optional<MovingPointClaim> exact;  ///< they refute, and prove nothing
  double gap = 0;                         ///< as it was used
};

/// Decides whether the bodies, radii included, hold the shapes at every instant of the path, and
/// whether points of their exact faces stick out at configurations of it.
/// @throws as verify_sweep
MotionVerdict decide(const MotionQuestion& question);

}  // namespace kaboum::verify
