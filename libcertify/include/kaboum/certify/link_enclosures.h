#pragma once

#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/wanted_meshes.h>

#include <functional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for the enclosing meshes of a robot's links.
struct LinkEnclosuresRequest {
  EnclosureRequest mesh;  ///< of each; lengths in the robot's unit
  robot::ShapeChoice shapes;
  std::optional<io::Format> format;  ///< of the meshes; by default by extension
  LinkEpsilons epsilons;
  /// A mesh that cannot be enclosed does not refuse the robot: EnclosedLinkMesh::flaw says why, and
  /// it stays as it is. Where none can, the first flaw is thrown.
  bool partial = false;
};

/// A mesh of a robot and what encloses it, in its own frame and unit.
struct EnclosedLinkMesh {
  robot::LinkMesh mesh;
  std::optional<Length> epsilon;  ///< asked for, in its unit
  EnclosedFile made;
  double seconds = 0;     ///< that it took, by the clock, together with others [s]
  std::string flaw = {};  ///< why `made` holds nothing (LinkEnclosuresRequest::partial); else empty
};

/// Enclosing meshes of a robot's links.
struct LinkEnclosures {
  std::vector<EnclosedLinkMesh> meshes;
  std::vector<robot::LinkShape> shapes;  ///< `mesh` is an index in `meshes`
  std::vector<std::filesystem::path>
      files;  ///< meshes and what they refer to; some are there twice

  /// The shapes of each link that has some, in the order of `verdicts`.
  [[nodiscard]] std::vector<std::vector<robot::LinkShape>> shapes_by_link() const;
};

/// Enclosing meshes of all meshes of a robot's links, several at once; other shapes need none.
/// @param progress  gets what is done, one call at a time, from any thread; what it throws ends the
///   work; may be empty.
/// @throws Error naming the link or the file, as enclose_file; Error{InvalidInput} when no link has
///   a mesh.
LinkEnclosures enclose_links(const robot::RobotFile& robot, const LinkEnclosuresRequest& request,
                             const CacheFolder* cache = nullptr,
                             const std::function<void(const std::string& stage)>& progress = {});

}  // namespace kaboum::certify
