#pragma once

#include <kaboum/certify/link_bodies.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::certify {

/// Certificate of the inner set of a link.
struct InnerLinkCertificate {
  std::uint32_t link = 0;
  std::size_t shapes = 0;  ///< that have bodies
  /// No point of the union of the link's shapes that the set leaves out is deeper in it; also the
  /// set's epsilon. Where scale, pose or several shapes leave gaps between bodies it is no better
  /// than half of the shapes' diagonals. [length]
  double depth = 0;
};

/// The inner set of a link, in its frame: serialised, read back, and decided by libverify. It
/// decides exactly that the set consists of convex polytopes each of which lies in the body that it
/// was made from, rounding of scale and pose taken off. Those bodies lie in the link's shapes
/// (certify_set, inner; inscribed polytopes of boxes, cylinders and spheres). It has no margin; its
/// bytes are a GLB container.
using CertifiedInnerLink = Certified<geom::ConvexSet, InnerLinkCertificate>;

/// What is claimed of it: convex bodies that lie in the link's shapes.
Certificate certificate_of(const CertifiedInnerLink& link);

struct InnerLinks {
  std::vector<CertifiedInnerLink> links;  ///< those that were asked for and have bodies, in order
  std::vector<CertifiedLinkMesh> meshes;
  std::vector<robot::LinkShape> shapes;  ///< of `links`; `mesh` is an index in `meshes`
  /// Links that were asked for and have shapes but no inner set, and why.
  std::vector<std::pair<std::uint32_t, std::string>> without;
};

/// Inner sets of a robot's links: what lies in their solids for certain
/// (docs/algorithms/convex-decomposition.md, "Inner sets of links"). A link one of whose meshes has
/// none (it has no volume, float32 is too coarse) is among those `without`.
/// @param request  its direction plays no part.
/// @throws as certify_bodies, but for meshes that have no inner set; Error{Internal} where what was
///   found does not pass the exact check.
InnerLinks certify_inner_links(const robot::RobotFile& robot, const RobotRequest& request,
                               const SetCache* cache = nullptr, const RobotHooks& hooks = {});

}  // namespace kaboum::certify
