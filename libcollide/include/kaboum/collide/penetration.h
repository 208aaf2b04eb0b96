#pragma once

#include <kaboum/collide/bounding_set.h>

#include <optional>

namespace kaboum::collide {

/// Certified bracket of a penetration depth: the length of the shortest translation of one shape
/// after which the two have no inner point in common. 0: they are apart, or touch.
/// docs/algorithms/bounded-predicates.md, "Penetration depth", has the proof.
struct Penetration {
  double lower = 0, upper = 0;  ///< rounded outwards [length]
  /// Unit vector, rounded: moved by `upper` along it, the second shape is clear of the first.
  geom::Vec3 direction = geom::Vec3::Zero();
};

/// The penetration depth of two convex polytopes. The bracket always holds; it is narrow (about
/// 1e-9 of the sizes) but for bodies as flat as rounding errors.
Penetration penetration_between(const Posed& a, const Posed& b);

/// The penetration depth of two unions of bodies, radii and errors of places included, and the
/// bodies that are deepest in each other. `lower` is that of these bodies; `upper` a translation
/// that parts the whole sets, so that the bracket is wide where bodies hook into each other.
struct SetPenetration {
  Penetration depth;
  BodyPair bodies;
};

/// nullopt where no bodies meet. `upper` is a bound of the depth of the solids of outer sets, too.
std::optional<SetPenetration> penetration(const PosedSet& a, const PosedSet& b);

}  // namespace kaboum::collide
