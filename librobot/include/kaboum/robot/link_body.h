#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::robot {

/// A convex body fixed to a link.
struct LinkBody {
  std::string name;
  std::uint32_t link = 0;
  std::vector<geom::Vec3>
      points;         ///< its hull is the body, in the link's frame (100 · 2^-53 exact)
  double margin = 0;  ///< the body is the hull and a ball of this radius (Minkowski sum) [length]
};

}  // namespace kaboum::robot
