#pragma once

#include <kaboum/world/scene.h>

#include <optional>

#include "bindings.h"

/// Scenes that Python holds.
namespace kaboum::python {

/// What a Scene holds, ready for a world; nullopt: the object is no Scene.
/// @throws as scene::SceneDraft::world
std::optional<world::SceneFile> scene_file_of(const py::object& value);

}  // namespace kaboum::python
