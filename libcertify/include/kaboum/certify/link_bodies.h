#pragma once

#include <kaboum/base/notes.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/certify/wanted_meshes.h>
#include <kaboum/robot/link_body.h>
#include <kaboum/robot/link_meshes.h>

#include <functional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for the sets of a robot's links.
struct RobotRequest {
  /// Request for each mesh; lengths in the robot's unit. Direction: outer. Its `improve_work` is
  /// that of all meshes together: by default kRobotWork with Effort::Normal.
  SetRequest set;
  robot::ShapeChoice shapes;
  std::optional<io::Format> format;  ///< of the meshes; by default by extension
  std::string tool;  ///< that the containers name; by default bcd-decompose, with its version

  LinkEpsilons epsilons = {};  ///< instead of the sets'
  /// Regions of links with an epsilon each, besides the sets': what of the bodies lies in one is
  /// within it, where that is less.
  robot::LinkRegions regions = {};
  /// A mesh that cannot be held as asked for does not refuse the robot: it gets one body round a
  /// wrap of it, farther than epsilon, or none; CertifiedLinkMesh::flaw says why. Where no mesh has
  /// bodies, and no other shape, the first flaw is thrown.
  bool partial = false;

  /// Takes what a map says of links and regions.
  /// @throws Error{InvalidArgument} where both say something of whole links
  void take(robot::LinkBounds bounds);

  /// As bcd-decompose spells it: the containers' record.
  [[nodiscard]] std::string parameters() const;
  /// The same of one link.
  [[nodiscard]] std::string parameters(const std::string& link) const;
};

/// Within epsilon, fewer bodies are looked for until all meshes of a robot together have taken so
/// much work; each of them has a share, and what makes it within epsilon is never cut short. [s]
inline constexpr double kRobotWork = 30;

/// A mesh of a robot, in its own frame and unit.
struct CertifiedLinkMesh {
  robot::LinkMesh mesh;
  std::optional<Length> epsilon;  ///< asked for, in its unit
  CertifiedFile made;
  std::string flaw = {};  ///< why it is not held as asked for (RobotRequest::partial); else empty
  bool held = true;       ///< else `made` holds nothing
};

/// Callbacks of long work; all may be empty. Called from the calling thread.
struct RobotHooks {
  std::function<void(const std::string& stage)> progress;  ///< often; may throw to cancel
  std::function<void(const std::string& file, const std::string& text)> note;
  std::function<void(const CertifiedLinkMesh& mesh)> made;  ///< when a mesh has its set
};

/// Hooks that collect the notes on meshes, and show progress as it comes.
RobotHooks hooks_of(Notes& notes, std::function<void(const std::string&)> progress);

/// Meaning of bodies of a robot's links.
struct BodiesCertificate {
  robot::ShapeChoice choice;  ///< the shapes that they stand for
  std::vector<CertifiedLinkMesh> meshes;
  std::vector<robot::LinkShape> shapes;  ///< `mesh` is an index in `meshes`
  double distance = 0;            ///< bound of how far a body reaches beyond its shape [length]
  std::vector<double> distances;  ///< the same of each shape; 0 of those that are not held
  std::vector<std::filesystem::path>
      files;  ///< meshes and what they refer to; some are there twice
};

/// Convex bodies of a robot's links: those of the shapes, in their order. They are not written.
using CertifiedBodies = Certified<std::vector<robot::LinkBody>, BodiesCertificate>;

/// Convex bodies that hold the shapes of a robot's links: of meshes certified sets, from the cache
/// where possible, placed in the link; boxes, cylinders and spheres as bounding polytopes; nothing
/// for points.
/// @param cache  null: none.
/// @throws Error naming the link or the file; when no link has a shape; TooCoarse.
CertifiedBodies certify_bodies(const robot::RobotFile& robot, const RobotRequest& request,
                               const SetCache* cache = nullptr, const RobotHooks& hooks = {});

/// The mean over the links that have bodies of how far those of each reach at most. [length]
double mean_distance(const CertifiedBodies& bodies);

/// Bound of how far the bodies of one shape reach beyond it. [length]
double distance_of(const robot::RobotFile& robot, const BodiesCertificate& bodies,
                   const robot::LinkShape& shape);

}  // namespace kaboum::certify
