#pragma once

#include <kaboum/certify/link_bodies.h>

#include <cstdint>
#include <vector>

namespace kaboum::certify {

/// Certificate of the set of a link.
struct LinkCertificate {
  std::uint32_t link = 0;
  std::size_t shapes = 0;
  std::size_t kept = 0;  ///< of these, that have no bodies: 0 of links that have a set
  double distance = 0;   ///< of the bodies beyond their shapes; the set's own: its epsilon [length]
};

/// The set of a link, in its frame: serialised, read back, and decided exactly by libverify to hold
/// the link's bodies, each of which holds what it stands for (CertifiedBodies). It has no margin;
/// its provenance has the claims; its bytes are a GLB container.
using CertifiedLink = Certified<geom::ConvexSet, LinkCertificate>;

/// What is claimed of it: convex bodies that hold the link's shapes.
Certificate certificate_of(const CertifiedLink& link);

struct CertifiedRobot {
  CertifiedBodies bodies;
  /// Those that were asked for and have shapes, all of them held.
  std::vector<CertifiedLink> links;
};

/// Certified sets for all links of a robot: certify_bodies, then a container for each link. Where
/// scale and pose are rounded, the container's polytopes hold the balls that rounding may have
/// moved points in; where libverify does not find it so, larger ones are tried.
/// @throws as certify_bodies; Error{Internal} when no polytopes pass the exact check.
CertifiedRobot certify_robot(const robot::RobotFile& robot, const RobotRequest& request,
                             const SetCache* cache = nullptr, const RobotHooks& hooks = {});

}  // namespace kaboum::certify
