#pragma once

#include <string>
#include <vector>

#include "source.h"

namespace kaboum::io {

/// Looks through the objects of an FBX file (7.x, binary or text) for those that hold or move
/// surfaces and that assimp leaves out without a word: NURBS, patches, skins, levels of detail,
/// models with a mesh that are not connected to the scene. Internal to kaboum_io.
///
/// @return notes on what the scene does not show
/// @throws Error{InvalidInput} naming the object.
std::vector<std::string> check_fbx_objects(const Source& source);

}  // namespace kaboum::io
