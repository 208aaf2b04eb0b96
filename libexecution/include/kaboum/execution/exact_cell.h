#pragma once

#include <kaboum/judge/cell.h>
#include <kaboum/world/world.h>

#include <filesystem>
#include <string>
#include <vector>

/// Plans carried out in simulation, and judged by exact meshes. docs/planning/geometry.md.
namespace kaboum::execution {

/// Things that `exact_cell` leaves out or could not take as it is; one sentence each.
using Notes = std::vector<std::string>;

/// The exact meshes of a scene, to judge by. Robots and objects are numbered as in the world.
///
/// @param world  of the scene, for bases, limits, grippers and allowed contacts.
/// @param packages  folders that package:// URIs are looked up in.
/// @throws Error as world::exact_meshes.
judge::Cell exact_cell(const world::World& world, const std::filesystem::path& scene,
                       const std::vector<std::string>& packages, Notes& notes);

}  // namespace kaboum::execution
