#pragma once

#include <kaboum/world/world.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::world {

/// Points that a sensor saw. Each stands for a ball: what is there is no farther from a point than
/// the radius.
struct Cloud {
  std::string name = "cloud";
  std::vector<Vec3> points = {};
  /// What each point is called in messages; empty: 1, 2, 3, …
  std::vector<std::uint32_t> numbers = {};
  double radius = 0;    ///< > 0 [length]
  Transform pose = {};  ///< from the points' frame to the world
  /// Links, as "ROBOT/LINK", whose contacts with it are none.
  std::vector<std::string> allow = {};
};

/// Adds a cloud to a world: an object that rests, whose outer set is exactly the balls (ε = 0).
/// Things are free of it only if they are apart from every ball.
/// @throws Error{InvalidArgument} for a name that the world has already, no points, numbers that
/// are
///   not finite, a radius that is not above 0, numbers for other than the points, a link that
///   there is not.
void add_cloud(World& world, Cloud cloud);

}  // namespace kaboum::world
