#pragma once

#include "source.h"

namespace kaboum::io {

/// Looks through the objects of an FBX file (7.x, binary or text) for those that hold or move
/// surfaces and that assimp leaves out without a word: NURBS, patches, skins, levels of detail.
/// Internal to kaboum_io.
///
/// @throws Error{InvalidInput} naming the object.
void check_fbx_objects(const Source& source);

}  // namespace kaboum::io
