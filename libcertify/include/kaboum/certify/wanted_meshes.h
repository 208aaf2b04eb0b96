#pragma once

#include <kaboum/base/length.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/link_regions.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Epsilons of some links' meshes instead of what is asked for of all, by the links'
/// names: a length in the robot's unit, or a percentage of each mesh's diagonal.
using LinkEpsilons = std::map<std::string, Length>;

/// The meshes of the shapes that are meant, each once for every scale, epsilon and regions.
struct WantedMeshes : robot::LinkMeshes {
  /// Epsilon of each mesh, where a link has one of its own, in the robot's unit.
  std::vector<std::optional<Length>> epsilons;
  /// Regions of each mesh in its frame and unit, round those of its link.
  std::vector<std::vector<geom::RequestedRegion>> regions;
};

/// @throws as robot::link_meshes and robot::region_in_shape; Error{InvalidArgument} naming a link
///   of `epsilons` or `regions` that the robot does not have.
WantedMeshes wanted_meshes(const robot::RobotFile& robot, const robot::ShapeChoice& choice,
                           const LinkEpsilons& epsilons = {},
                           const robot::LinkRegions& regions = {});

/// A percentage as it is; a length in the robot's unit in that of a mesh whose coordinates are
/// multiplied by `scale`.
Length in_unit_of_mesh(Length length, const geom::Vec3& scale);

}  // namespace kaboum::certify
