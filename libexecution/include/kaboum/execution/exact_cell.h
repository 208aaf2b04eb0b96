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

/// A mesh in the frame of the link or object that it is of.
struct ExactMesh {
  world::Item item;
  geom::Mesh mesh;
};

/// The exact meshes of a scene: those that its sets were made from (`made_from`), of robots the
/// shapes of their URDFs. Boxes are exact; cylinders and spheres are the polytopes that enclose
/// them (robot::bounding_points). Shapes of the robots first, then objects, as in the world.
///
/// @param packages  folders that package:// URIs are looked up in.
/// @throws Error{InvalidInput} where a file cannot be read, or an object's set does not say which
///   mesh it was made from.
std::vector<ExactMesh> exact_meshes(const world::World& world, const std::filesystem::path& scene,
                                    const std::vector<std::string>& packages);

/// These meshes, to judge by. Robots and objects are numbered as in the world.
///
/// @param world  of the scene, for bases, limits, grippers and allowed contacts.
/// @param packages  folders that package:// URIs are looked up in.
/// @throws Error as exact_meshes.
judge::Cell exact_cell(const world::World& world, const std::filesystem::path& scene,
                       const std::vector<std::string>& packages, Notes& notes);

}  // namespace kaboum::execution
