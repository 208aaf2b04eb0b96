#pragma once

#include <kaboum/base/notes.h>
#include <kaboum/certify/link_bodies.h>

#include <string>
#include <vector>

/// What tools that make the bodies of robots have in common.
namespace kaboum::tools {

/// @throws Error naming the first mesh of the robot whose format is not known; as
///   robot::link_meshes.
void require_formats(const robot::LinkMeshes& meshes, const std::string& format);

/// Notes of meshes that are made, for later; progress as it comes.
certify::RobotHooks hooks_of(Notes& notes, std::function<void(const std::string&)> progress);

/// File names as strings.
std::vector<std::string> strings(const std::vector<std::filesystem::path>& files);

}  // namespace kaboum::tools
