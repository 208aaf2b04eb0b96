#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace kaboum::bcd {

/// Planes of a convex polytope's facets, in a tree by their normals: how far a point is beyond.
class FacetTree {
 public:
  struct Facet {
    geom::Vec3 n;  ///< unit
    double d;
  };
  /// @param size  about that of the polytope, and `center` in it. [length]
  FacetTree(std::vector<Facet> facets, const geom::Vec3& center, double size);

  /// The largest n·p − d if that is more than `least`, which it is until a facet is found; where it
  /// exceeds `enough`, something between them.
  [[nodiscard]] double beyond(const geom::Vec3& p, double least = 0,
                              double enough = std::numeric_limits<double>::infinity()) const;
  /// That, and the facet's place in the tree; the same for the same facets.
  [[nodiscard]] std::pair<double, std::uint32_t> farthest(
      const geom::Vec3& p, double least = 0,
      double enough = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    geom::Vec3 low, high;        ///< of the normals
    double least;                ///< of d, from the centre
    std::uint32_t first, count;  ///< a leaf's facets; an inner node: its right child, and 0
  };
  std::uint32_t add(std::uint32_t first, std::uint32_t last);
  [[nodiscard]] double bound(const Node& node, const geom::Vec3& from_center) const;

  std::vector<Facet> facets_;
  std::vector<Node> nodes_;  ///< a left child follows its parent
  geom::Vec3 center_;
  double slack_;
};

}  // namespace kaboum::bcd
