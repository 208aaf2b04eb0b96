#pragma once

#include <kaboum/geom/convex_set.h>

#include <limits>
#include <optional>
#include <vector>

#include "mesh_pair.h"
#include "tetrahedra.h"

namespace kaboum::verify {

/// What the bodies of a set leave of a box, by cutting it along their facets.
/// docs/algorithms/exact-inclusion.md, "Uncovered regions".
class ComplementOfUnion {
 public:
  /// @param meshes  whose coordinates are the set's times meshes.scale()
  ComplementOfUnion(const MeshPair& meshes, const geom::ConvexSet& set);

  /// Tetrahedra that hold every point of the box about which no body winds, or that is less than
  /// rounding_of_distances below a facet of each body that does (what was cut before may be off by
  /// that), but for the rounding of cut points, which is at most as much. False when no body covers
  /// anything of the box, or when there would be too many of them.
  bool parts(const Bounds& box, std::vector<Part>& out) const;

  /// Whether some body winds about all of the box. @pre as for parts, the box's corners rounded
  [[nodiscard]] bool one_holds(const Bounds& box) const;

 private:
  /// Points below all planes lie inside.
  struct Body {
    std::vector<Plane> planes;
  };
  static Body body_of(const geom::Mesh& hull, const MeshPair& meshes);
  /// Planes that cross a box; those of about one direction are one, below all of them in the box.
  struct Crossing {
    std::vector<Plane> planes;
    double depth = std::numeric_limits<double>::infinity();  ///< of the box's middle in the body
  };
  static std::optional<Crossing> crossing_planes(const Body& body, const Bounds& box);
  static bool subtract(const std::vector<Plane>& planes, const Part& part, std::vector<Part>& out);

  std::vector<Body> bodies_;
  BoxTree tree_;
};

}  // namespace kaboum::verify
