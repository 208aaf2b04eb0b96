#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cell_sample.h"
#include "mesh_pair.h"
#include "nearest.h"
#include "uncovered_region.h"

namespace kaboum::verify {

/// What all steps of a search of uncovered regions share.
struct RegionSearch {
  RegionSearch(const MeshPair& s, const std::vector<std::uint32_t>& offending, const Limit& l)
      : meshes(s),
        boundary(tree_of(s, offending)),
        limit(l),
        slack(rounding_of_distances(s.largest_coordinate())) {}

  /// Whether the point is in Z; nullopt when it may lie on a surface.
  [[nodiscard]] std::optional<bool> in_region(const Vec3& p) const {
    const std::optional<int> inner = winding_at(meshes, kInside, p);
    if (inner && *inner < 1) return false;
    const std::optional<int> outer = winding_at(meshes, kOutside, p);
    if (outer && *outer >= 1) return false;
    if (!inner || !outer) return std::nullopt;
    return true;
  }

  [[nodiscard]] Vec3 closest(const Vec3& p, std::uint32_t f) const {
    return closest_point(p, limit.triangles.corner(f, 0), limit.triangles.corner(f, 1),
                         limit.triangles.corner(f, 2));
  }

  /// Whether the points, and so their hull, are within the limit of one triangle.
  [[nodiscard]] bool near(const std::vector<Vec3>& points, std::uint32_t f) const;

  const MeshPair& meshes;
  BoxTree boundary;  ///< of Z
  const Limit& limit;
  double slack;  ///< what distances err by
};

}  // namespace kaboum::verify
