#pragma once

#include <kaboum/world/scene.h>

#include <string>
#include <vector>

#include "options.h"

/// kaboum-check --cloud: points of a sensor among the obstacles of a scene.
namespace kaboum::tools {

/// @throws Error{InvalidArgument} for options of clouds that mean nothing as they are.
void require_cloud_meaning(const CheckOptions& options);

/// Adds the clouds that are asked for to a world, each by its file's name without folder and
/// ending.
/// @param notes  gets what a user should know; one sentence each
/// @throws Error{InvalidInput} that names the file: damaged, with points that are none, with a
///   viewpoint that is not applied; Error{InvalidArgument} for links that there are not
void add_clouds(const CheckOptions& options, world::World& world, std::vector<std::string>& notes,
                Json& report);

}  // namespace kaboum::tools
