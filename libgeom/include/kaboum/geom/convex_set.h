#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::geom {

/// A convex polytope: its facets triangulated, normals outwards, every vertex on or below every
/// facet's plane.
struct ConvexBody {
  std::string name;
  Mesh hull;
};

/// Where a convex set comes from and what is certified of it.
struct Provenance {
  std::string source;         ///< name of the input
  std::string source_sha256;  ///< hash of the input's bytes
  std::string tool;           ///< program and version
  std::string parameters;     ///< the options used
  std::string unit = "m";
  std::string frame;
  std::string direction;        ///< "outer", "inner", or empty: not stated
  double epsilon = -1;          ///< certified bound of the distance to the solid; negative: none
  bool covers_solid = false;    ///< outer: verified that the set contains the input's solid
  bool covers_surface = false;  ///< outer: verified that the set contains every input triangle

  bool operator==(const Provenance&) const = default;
};

/// A union of convex polytopes, each enlarged by a ball of radius `margin` (Minkowski sum): the
/// implicit offset of the thesis, Eq. 4.22. The empty list stands for the empty set, whatever the
/// margin.
struct ConvexSet {
  std::vector<ConvexBody> bodies;
  double margin = 0;  ///< ≥ 0 [length]
  Provenance provenance;
};

/// Whether every vertex lies on or below the plane of every triangle, decided exactly, and the
/// triangles form a closed chain of positive volume. Cost #V · #T filtered predicates.
bool is_convex(const Mesh& hull);

/// The first body that is not exactly convex (is_convex); nullopt when all are.
std::optional<std::size_t> find_not_convex(const ConvexSet& set);

}  // namespace kaboum::geom
