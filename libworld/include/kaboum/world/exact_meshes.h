#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/world/world.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::world {

/// A mesh in the frame of the link or object that it is of.
struct ExactMesh {
  Item item;
  geom::Mesh mesh;
};

/// The exact meshes of a scene: those that its sets were made from (`made_from`), of robots the
/// shapes of their URDFs. Boxes are exact; cylinders and spheres are the polytopes that enclose
/// them (robot::bounding_points). Shapes of the robots first, then objects, as in the world.
///
/// @param packages  folders that package:// URIs are looked up in.
/// @throws Error{InvalidInput} where a file cannot be read, or an object's set does not say which
///   mesh it was made from.
std::vector<ExactMesh> exact_meshes(const World& world, const std::filesystem::path& scene,
                                    const std::vector<std::string>& packages);

}  // namespace kaboum::world
