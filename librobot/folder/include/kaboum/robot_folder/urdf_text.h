#pragma once

#include <string>

namespace tinyxml2 {
class XMLElement;
}

/// Ways in which programs find the meshes that a URDF names.
namespace kaboum::robot_folder {

/// The prefix of names of files, with the slash at its end that may have been left out; empty as it
/// is.
std::string with_slash(const std::string& prefix);

/// Has MuJoCo take names of meshes as they stand, relative to the URDF: a <mujoco> element, which
/// other programs ignore. One that is there keeps what else it says, but that MuJoCo should load
/// the shapes for drawing too (discardvisual="false"), where these are named by package:// or
/// another scheme: it would find none, and load nothing.
/// @return whether it leaves them out therefore
bool let_mujoco_find_meshes(tinyxml2::XMLElement& robot);

}  // namespace kaboum::robot_folder
