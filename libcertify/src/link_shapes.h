#pragma once

#include <kaboum/base/error.h>
#include <kaboum/certify/link_bodies.h>

// Shapes of links and their meshes, for sets of either direction. Internal to kaboum_certify.
namespace kaboum::certify {

/// The set of one mesh of a robot, in the mesh's own frame and unit.
/// @param epsilon  instead of the request's, in the robot's unit
/// @param regions  in the mesh's frame and unit
CertifiedLinkMesh certify_link_mesh(const robot::LinkMesh& mesh,
                                    const std::optional<Length>& epsilon,
                                    const std::vector<geom::RequestedRegion>& regions,
                                    const RobotRequest& request, const SetCache* cache,
                                    const RobotHooks& hooks);

/// Whether an error may be a mesh's flaw, which other meshes, or another epsilon, need not have.
bool is_of_mesh(const Error& error);

/// Whether scaling and placing a mesh's float32 vertices rounds nothing.
bool is_placed_exactly(const robot::Geometry& g);

/// Bound of how far a placed point is from where it should be, where shape and link lie far from
/// one another's origin. @param size  largest norm of the point before it is placed. [length]
double placing_error(const robot::Geometry& g, double size);

}  // namespace kaboum::certify
