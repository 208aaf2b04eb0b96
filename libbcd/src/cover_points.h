#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/winding.h>

#include <optional>
#include <vector>

namespace kaboum::bcd {

/// A point of a surface.
struct SurfacePoint {
  geom::Vec3 at;
  geom::Vec3 inwards;  ///< the direction square to its triangle, of length 1
};

/// Points of a solid, by which bodies that cover it are searched for.
struct CoverPoints {
  std::vector<SurfacePoint> surface;  ///< evenly by area
  std::vector<geom::Vec3> inside;     ///< of a grid
  /// What is to be held at first: those of the surface, vertices, and some of the inside.
  std::vector<geom::Vec3> first;
};

/// The same for the same mesh and numbers.
///
/// @param epsilon  there are more points of the surface the smaller it is
/// @param least, most  how many these are
CoverPoints sample_cover_points(const geom::Mesh& mesh, const geom::WindingNumber& winding,
                                std::optional<double> epsilon, std::size_t least, std::size_t most);

}  // namespace kaboum::bcd
