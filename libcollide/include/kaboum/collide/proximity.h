#pragma once

#include <kaboum/collide/polytope.h>

#include <cstdint>

namespace kaboum::collide {

/// Proximity of two convex polytopes: if they come within a distance, and how far they are apart.
/// The answers are those of exact arithmetic on the doubles given. Directions and points found in
/// rounded arithmetic are taken only with their errors bounded, and dyadic numbers decide what is
/// too close for that. docs/algorithms/bounded-predicates.md has the bounds and their proofs.

/// Memory between queries of one pair; it changes how long an answer takes, never the
/// answer. A zero vector: nothing.
using Axis = geom::Vec3;

/// Counts of how queries were decided.
struct Decided {
  std::uint64_t at_once = 0;  ///< by the axis remembered
  std::uint64_t rounded = 0;  ///< by another direction, or by a common point
  std::uint64_t exactly = 0;  ///< by exact arithmetic
};

/// True if the smallest distance of the polytopes is at most `reach`; touching ones have the
/// distance 0. With reach = a + b: whether they meet when one is enlarged by a ball of radius a,
/// the other one by a ball of radius b.
/// @param reach    ≥ 0 and finite. [length]
/// @param axis     where to look first; becomes a direction that separates, or zero. May be null.
/// @param decided  counts; may be null.
/// @throws Error{InvalidArgument} for a reach that is negative or not finite.
bool are_within(const Posed& a, const Posed& b, double reach, Axis* axis = nullptr,
                Decided* decided = nullptr);

/// Certified bracket of a distance, and the points that it is between.
struct Gap {
  double lower = 0, upper = 0;  ///< of the smallest distance; rounded outwards [length]
  /// Rounded; points of the polytopes (within 2^-48 of the magnitudes) that are `upper` apart.
  geom::Vec3 on_a = geom::Vec3::Zero(), on_b = geom::Vec3::Zero();
};

/// The smallest distance of the polytopes. The bracket is usually as narrow as rounding permits,
/// and always holds; lower is 0 for those that meet.
Gap gap_between(const Posed& a, const Posed& b, Axis* axis = nullptr);

}  // namespace kaboum::collide
