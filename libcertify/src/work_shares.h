#pragma once

#include <kaboum/certify/link_bodies.h>

#include <optional>
#include <vector>

namespace kaboum::certify {

/// What each mesh has of the work for fewer bodies that a robot is allowed (RobotRequest): shares
/// by the sizes of files, rounded up to powers of two. Nothing has to be read for them, and a file
/// that changes a little leaves the others' as they are, and so what is kept of these. None where
/// there is no limit.
std::vector<std::optional<double>> work_of_meshes(const robot::LinkMeshes& meshes,
                                                  const SetRequest& request);

}  // namespace kaboum::certify
