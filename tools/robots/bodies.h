#pragma once

#include <kaboum/certify/link_bodies.h>

#include <string>
#include <vector>

/// Robots as tools read them: formats of their meshes, names of files.
namespace kaboum::tools {

/// @throws Error naming the first mesh of the robot whose format is not known; as
///   robot::link_meshes.
void require_formats(const robot::LinkMeshes& meshes, const std::string& format);

/// File names as strings.
std::vector<std::string> strings(const std::vector<std::filesystem::path>& files);

}  // namespace kaboum::tools
