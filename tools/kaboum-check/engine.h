#pragma once

#include <kaboum/world/motion_check.h>
#include <kaboum/world/scene.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "options.h"

/// kaboum-check --engine: contacts as a collision library of others sees them. Nothing of it is
/// certified, and all that is said of it says so.
namespace kaboum::tools {

/// @throws Error{InvalidArgument} for options that mean nothing with, or without, such a library.
void require_engine_meaning(const CheckOptions& options);

/// Who decided, for a report.
Json engine_json(const CheckOptions& options);

/// Configurations of a robot, or the state of the scene. @return an exit code: 1 where the library,
/// or with --compare either one, sees a contact.
int check_states_by_engine(const CheckOptions& options, const world::SceneFile& scene,
                           std::optional<std::size_t> robot, const robot::Path& values,
                           const std::function<void(const std::string&)>& say, Json& report);

/// A motion, at samples.
int check_paths_by_engine(const CheckOptions& options, const world::SceneFile& scene,
                          const std::vector<world::RobotPath>& paths,
                          const std::function<void(const std::string&)>& say, Json& report);

}  // namespace kaboum::tools
