#pragma once

#include <kaboum/scene/derived_features.h>
#include <kaboum/world/world.h>

#include <string>

namespace kaboum::tools {

/// A page that shows grasps that were derived round the objects of a scene: of each grasp the hand
/// at some members, and where the tool is at many. docs/pages.md.
/// @param world    of the scene, with what was added
/// @param request  that they were derived for
/// @pre One of these objects is in the world.
std::string page_of_grasps(const std::string& scene, const world::World& world,
                           const scene::AddedFeatures& added, const scene::GraspRequest& request);

/// A page that shows the points and surfaces of objects that were derived, or kept in their place,
/// on these objects where they are at first.
/// @param world  of the scene, with what was added
/// @pre One of these objects is in the world.
std::string page_of_places(const std::string& scene, const world::World& world,
                           const scene::AddedFeatures& added);

}  // namespace kaboum::tools
