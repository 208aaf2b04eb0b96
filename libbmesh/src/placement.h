#pragma once

#include "quadric.h"

#include <optional>
#include <span>

namespace kaboum::bmesh {

/// Half-space normal·y ≥ offset; `normal` need not have unit length. [length]
struct HalfSpace {
  Vec3 normal;
  double offset;
};

/// Weight of the pull towards the origin in the minimisation below, relative to the quadric's
/// trace: it makes the problem strictly convex where the quadric is singular.
inline constexpr double kRegularisation = 1e-6;

/// The same where costs are measured distances: the pull displaces vertices, by less here.
inline constexpr double kRegularisationDistance = 1e-8;

/// Minimises a quadric over an intersection of half-spaces in three dimensions.
///
///   argmin_y  (yᵀAy + 2bᵀy) / tr(A) + regularisation · |y|²   s. t.   n_i·y ≥ d_i
///
/// Source: [gaschler2016] Eq. 4.8, Alg. 1. Deviation: the thesis enumerates all subsets of up to
/// three active planes. Here a basis of at most three planes is kept; the most violated plane
/// enters and the new basis is sought among the (at most seven) subsets of the old one with it: the
/// same minimiser, after two or three exchanges instead of hundreds of subsets.
///
/// @param linear  b: half the gradient at y = 0.
/// @return the minimiser; nullopt when the half-spaces do not meet (up to rounding).
std::optional<Vec3> minimise(const Quadric& quadratic, const Vec3& linear,
                             std::span<const HalfSpace> half_spaces,
                             double regularisation = kRegularisation);

/// Smallest value of a quadric plus the same pull towards `near`: a cheap lower bound (up to the
/// pull) of what `minimise` reaches under any half-spaces.
double unconstrained_minimum(const Quadric& q, const Vec3& near,
                             double regularisation = kRegularisation);

}  // namespace kaboum::bmesh
