#pragma once

#include <filesystem>
#include <string>

/// What tools say of the URDFs that they write.
namespace kaboum::tools {

/// Which programs find the meshes of a URDF whose names begin with `prefix`; one sentence.
/// @param folder  of the meshes, relative to the URDF.
std::string how_meshes_are_found(const std::filesystem::path& urdf, const std::string& folder,
                                 const std::string& prefix);

}  // namespace kaboum::tools
