#pragma once

#include <kaboum/engines/collider.h>
#include <kaboum/world/checker.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace kaboum::engines {

/// Shapes that a library is given of each thing.
enum class Shapes {
  Sets,    ///< the bodies of its outer set, as convex bodies
  Meshes,  ///< the triangles that the set was made of
};

/// Who decides contacts, and on what.
struct EngineRequest {
  Library library = Library::Own;
  Shapes shapes = Shapes::Sets;
  /// Motions are looked at at samples: no point goes farther in between. > 0 [length]
  double step = 0.01;
  std::vector<std::string> packages =
      {};  ///< folders that package:// URIs of meshes are looked up in
};

/// What decides, and that nothing is certified: "by FCL 0.7.0 with libccd on bounding sets, not
/// certified". Empty for Own.
std::string words_of(const EngineRequest& request);

/// A substitute that asks the library; null for Own.
///
/// @param world  with all that is to collide; not referred to later
/// @param scene  the file of the world, from which meshes are found. @throws Error{InvalidArgument}
///   where meshes are asked for and it is empty.
/// @throws Error as make_collider, and as world::exact_meshes.
std::shared_ptr<world::Substitute> make_substitute(const world::World& world,
                                                   const std::filesystem::path& scene,
                                                   const EngineRequest& request);

/// The same of meshes that are there.
std::shared_ptr<world::Substitute> make_substitute(
    const world::World& world, const EngineRequest& request,
    const std::vector<std::pair<world::Item, geom::Mesh>>& meshes);

}  // namespace kaboum::engines
