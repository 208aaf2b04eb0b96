#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::geom {

/// A convex body: all points within `radius` of its core (the Minkowski sum of core and ball).
struct ConvexBody {
  std::string name;
  /// A convex polytope: its facets triangulated, normals outwards, every vertex on or below every
  /// facet's plane. Or, without triangles: a segment by its two ends, or a point.
  Mesh core;
  double radius = 0;  ///< ≥ 0; > 0 where the core is a segment or a point [length]
};

/// Origin of a convex set, and what is certified of it.
struct Provenance {
  std::string source;         ///< name of the input
  std::string source_sha256;  ///< hash of the input's bytes
  std::string tool;           ///< program and version
  std::string parameters;     ///< the options used
  std::string unit = "m";
  std::string frame;
  std::string direction;               ///< "outer", "inner", or empty: not stated
  std::optional<double> epsilon = {};  ///< certified bound of the distance to the solid, if any
  bool covers_solid = false;           ///< outer: verified that the set contains the input's solid
  bool covers_surface = false;  ///< outer: verified that the set contains every input triangle

  bool operator==(const Provenance&) const = default;
};

/// A union of convex bodies. The empty list stands for the empty set.
struct ConvexSet {
  std::vector<ConvexBody> bodies;
  Provenance provenance;
};

/// True if every vertex lies on or below the plane of every triangle, decided exactly, and the
/// triangles form a closed chain of positive volume. Cost #V · #T filtered predicates.
bool is_convex(const Mesh& hull);

/// True if the radius is finite and not negative, and the core is an exactly convex polytope. With
/// a positive radius the core may be a segment between two different points or a point. All of it
/// is finite.
bool is_convex(const ConvexBody& body);

/// The first body that is not exactly convex (is_convex); nullopt when all are.
std::optional<std::size_t> find_not_convex(const ConvexSet& set);

/// The margin of a set of enlarged polytopes, the implicit offset of the thesis, Eq. 4.22: the
/// radius of all bodies. 0 for the empty set; nullopt where radii differ, or a core is no polytope.
std::optional<double> margin_of(const ConvexSet& set);

/// Gives all bodies one radius. [length]
void set_margin(ConvexSet& set, double radius);

/// A box that holds the body, rounded up.
Box3 bounding_box(const ConvexBody& body);

}  // namespace kaboum::geom
