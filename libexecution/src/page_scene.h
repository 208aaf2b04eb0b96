#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/world/exact_meshes.h>
#include <kaboum/world/world.h>

#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace kaboum::execution {

/// Adds a scene to the data of a page: `unit`, `robots` and `shapes` (docs/pages.md). Bounding sets
/// are written without their margins.
/// @param exact  of the scene; may be empty
void add_scene(nlohmann::ordered_json& data, const world::World& world,
               const std::vector<world::ExactMesh>& exact);

/// A state as such data have it.
nlohmann::ordered_json state_json(const judge::CellState& state);
/// That of the scene's file.
nlohmann::ordered_json initial_state_json(const world::World& world);

}  // namespace kaboum::execution
