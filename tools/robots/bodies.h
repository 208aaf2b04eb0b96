#pragma once

#include <kaboum/certify/link_bodies.h>

#include <string>
#include <vector>

#include "common/files.h"

/// Robots as tools read them: formats of their meshes, names of files.
namespace kaboum::tools {

/// @throws Error naming the first mesh of the robot whose format is not known; where an importer is
///   asked for; as robot::link_meshes.
void require_formats(const robot::LinkMeshes& meshes, const InputFormat& format);

/// File names as strings.
std::vector<std::string> strings(const std::vector<std::filesystem::path>& files);

}  // namespace kaboum::tools
