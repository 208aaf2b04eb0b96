#pragma once

#include "quadric.h"

#include <algorithm>
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
inline double unconstrained_minimum(const Quadric& q, const Vec3& near,
                                    double regularisation = kRegularisation) {
  // (A + e·I) y = g, g half the gradient; A + e·I = L D Lᵀ.
  const Vec3 g = q.half_gradient(near);
  const double value = near.dot(g) + near.x() * q.bx + near.y() * q.by + near.z() * q.bz + q.c;
  const double trace = q.trace();
  if (!(trace > 0)) return value;
  const double e = regularisation * trace;
  const double i0 = 1 / (q.xx + e);
  const double l10 = q.xy * i0, l20 = q.xz * i0;
  const double i1 = 1 / std::max(q.yy + e - l10 * q.xy, 0.5 * e);
  const double yz = q.yz - l20 * q.xy;
  const double l21 = yz * i1;
  const double i2 = 1 / std::max(q.zz + e - l20 * q.xz - l21 * yz, 0.5 * e);
  const double z1 = g.y() - l10 * g.x();
  const double y2 = (g.z() - l20 * g.x() - l21 * z1) * i2;
  const double y1 = z1 * i1 - l21 * y2;
  const double y0 = g.x() * i0 - l10 * y1 - l20 * y2;
  return value - (g.x() * y0 + g.y() * y1 + g.z() * y2) - e * (y0 * y0 + y1 * y1 + y2 * y2);
}

}  // namespace kaboum::bmesh
