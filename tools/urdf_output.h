#pragma once

#include <filesystem>
#include <string>

namespace tinyxml2 {
class XMLElement;
}

/// What the URDFs that the tools write have in common: how programs find their meshes.
namespace kaboum::tools {

/// The prefix of names of files, with the slash at its end that may have been left out; empty as it
/// is.
std::string with_slash(const std::string& prefix);

/// Which programs find the meshes of a URDF whose names begin with `prefix`; one sentence.
/// @param folder  of the meshes, relative to the URDF.
std::string how_meshes_are_found(const std::filesystem::path& urdf, const std::string& folder,
                                 const std::string& prefix);

/// Has MuJoCo take names of meshes as they stand, relative to the URDF: a <mujoco> element, which
/// other programs ignore. One that is there keeps what else it says.
void let_mujoco_find_meshes(tinyxml2::XMLElement& robot);

}  // namespace kaboum::tools
