#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/sweep.h>

#include <optional>
#include <utility>

namespace kaboum::verify {

/// Polytopes within the bodies of a set, and polytopes round them: what is true of a union that is
/// too small, or too large, bounds what is true of the bodies. docs/algorithms/rounded-bodies.md.
struct BodyBounds {
  geom::ConvexSet inside, outside;  ///< radius 0, and exactly convex; names are the bodies'
  double gap = 0;  ///< no point of an outer polytope is farther from its body, nor one of
                   ///< a body from its inner polytope [length]
};

/// Levels of subdivision of the ball, coarse to fine.
inline constexpr int kFirstBoundsLevel = 2, kLastBoundsLevel = 4;

/// The bounds of a level, decided exactly: every vertex of an inner polytope is in its body, and no
/// ball about a vertex of a body's core passes a plane of the outer one. Bodies of radius 0 are
/// their own bounds.
///
/// @return nullopt where a body is not convex, the polytopes would have too many vertices, or
///   rounding spoils them
std::optional<BodyBounds> bounds_of(const geom::ConvexSet& set, int level);

/// Whether a point is in a body, exactly: within its radius of its core. @pre is_convex(body)
bool contains(const geom::ConvexBody& body, const geom::Vec3& p);

/// The distance of a point to the nearest body, rounded; 0 inside one. [length]
double distance_to_bodies(const geom::ConvexSet& set, const geom::Vec3& p);

/// The claim of which one version about polytopes is sufficient, the other one necessary.
Claim between(Claim sufficient, Claim necessary);
DistanceClaim between(DistanceClaim sufficient, DistanceClaim necessary);

Inclusion between(Inclusion sufficient, Inclusion necessary);
SweepClaims between(SweepClaims sufficient, SweepClaims necessary);

/// Whether a finer level may still decide it.
inline bool is_open(const Claim& claim) { return claim.answer == Answer::Undecided; }
inline bool is_open(const DistanceClaim& claim) { return claim.answer == Answer::Undecided; }
inline bool is_open(const Inclusion& inclusion) {
  return is_open(inclusion.solid) || is_open(inclusion.surface);
}
inline bool is_open(const SweepClaims& claims) {
  return is_open(claims.solid) || is_open(claims.surface);
}

/// Whether nothing is left to ask.
inline bool is_verified(const Claim& claim) { return claim.answer == Answer::Verified; }
inline bool is_verified(const DistanceClaim& claim) { return claim.answer == Answer::Verified; }
template <class Claims>  // of a solid and a surface
bool is_verified(const Claims& claims) {
  const auto done = [](const Claim& claim) {
    return claim.answer == Answer::Verified || claim.answer == Answer::Undefined;
  };
  return done(claims.solid) && done(claims.surface);
}

/// Decides a claim about a set by its bounds, finer and finer: `sufficient(bounds)` is of the union
/// for which it is harder to hold, `necessary(bounds)` of the one for which it is easier.
/// @param open  the answer where there are no bounds
template <class Result, class Sufficient, class Necessary>
Result decide_between(const geom::ConvexSet& set, Result open, const Sufficient& sufficient,
                      const Necessary& necessary) {
  for (int level = kFirstBoundsLevel; level <= kLastBoundsLevel; ++level) {
    const std::optional<BodyBounds> bounds = bounds_of(set, level);
    if (!bounds) break;
    Result first = sufficient(*bounds);
    if (is_verified(first)) return first;
    open = between(std::move(first), necessary(*bounds));
    if (!is_open(open)) break;
  }
  return open;
}

}  // namespace kaboum::verify
