#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "cut_tree.h"

namespace kaboum::bcd {

/// A union of the tree's nodes with one hull round all of them.
struct Body {
  std::vector<Vec3> hull;   ///< vertices
  std::vector<int> leaves;  ///< nodes of the tree; none is below another one
  Concavity concavity;
  Box3 box;
};

Body body_of(const CutTree& tree, int leaf);
/// One body round all of them.
Body union_of(const CutTree& tree, const SolidField& solid, const std::vector<int>& leaves);
Body union_of(const Body& a, const Body& b, const SolidField& solid);
/// Largest distance of any of the bodies, by samples; 0 for none. [length]
double worst_of(const std::vector<Body>& bodies);
/// Whether the bodies' boxes are near each other.
bool touch(const Body& a, const Body& b, const SolidField& solid);

/// What the hull round two bodies would be like.
struct UnionEstimate {
  double worst;  ///< distance [length]
  double added;  ///< side of a cube of the volume added [length]
  bool whole;    ///< else `worst` is a lower bound, and nothing more is known
};
/// Lower bound of the distance of a union's hull from the solid [length]: the bodies' own, and that
/// of some points between them. Beyond `limit` any value above it.
double distance_from_below(const Body& a, const Body& b, const SolidField& solid, double limit);
/// Distance and volume of a union's hull, which is built; beyond `limit` a lower bound.
UnionEstimate estimate_hull(const Body& a, const Body& b, const SolidField& solid, double limit);
/// The same, without the hull where distance_from_below is beyond `limit`.
UnionEstimate estimate_union(const Body& a, const Body& b, const SolidField& solid, double limit);

/// A point of the body's surface whose distance, weighted, is beyond `limit`, if one is found.
std::optional<SolidField::Witness> far_point(const Body& body, const SolidField& solid,
                                             double limit);

/// The leaves of the tree that a body consists of.
std::vector<int> leaves_of(const CutTree& tree, const Body& body);
/// The body as few nodes of the tree that are within a distance, but at least `least` of them where
/// it has as many leaves.
std::vector<int> nodes_of(const CutTree& tree, const Body& body, std::size_t least,
                          double distance = std::numeric_limits<double>::infinity());
/// Two bodies as few nodes of the tree.
std::vector<int> nodes_of(const CutTree& tree, const Body& a, const Body& b);

}  // namespace kaboum::bcd
