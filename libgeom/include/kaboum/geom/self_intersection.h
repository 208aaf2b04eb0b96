#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace kaboum::geom {

/// A triangle's corners: what they are called, and where they are.
struct NamedTriangle {
  Triangle name;
  std::array<Vec3, 3> at;
};

/// True if two triangles that have an area meet in anything but the corner or the edge that both
/// have by name; exact. Corners of different names at the same place meet improperly.
bool meet_improperly(const NamedTriangle& a, const NamedTriangle& b);

/// The way a triangle meets the others of its mesh.
enum class Meeting : std::uint8_t {
  Proper,    ///< in corners and edges that both have by name
  Improper,  ///< otherwise
  Flat,      ///< not looked at: it has no area
};

/// Of each triangle of a mesh, decided exactly. Corners are the same if their indices are.
/// @pre indices in range, coordinates finite
std::vector<Meeting> meetings(const Mesh& mesh);

struct SelfIntersections {
  std::size_t triangles = 0;  ///< that meet another one improperly
  std::size_t flat = 0;       ///< triangles without area
  [[nodiscard]] bool none() const { return triangles == 0 && flat == 0; }
};

/// Triangles of a mesh that meet improperly, decided exactly for each pair whose boxes overlap.
/// Corners are the same if their indices are. Those without area are counted, and not looked at.
/// @pre indices in range, coordinates finite
SelfIntersections self_intersections(const Mesh& mesh);

}  // namespace kaboum::geom
