#pragma once

#include <kaboum/verify/inclusion.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Parts of an interval between knots, where nothing else is asked for.
inline constexpr std::size_t kPointDensity = 17;

/// Points of the exact faces and edges of a CAD file, by a reading of its own.
struct ExactPoints {
  std::vector<geom::Vec3> points;
  std::vector<std::uint32_t> of_face;  ///< of each point; faces are counted from 0
  std::size_t faces = 0, edges = 0;    ///< one for each place of a face; edges of all of them
  /// Bound of what evaluating may have moved a point by, in each coordinate. [length]
  double rounding = 0;
};

/// Points that a solid is to hold.
struct PointQuestion {
  std::span<const geom::Vec3> points;
  std::span<const std::uint32_t> of_face;  ///< of each point: the exact face that it is on
  double rounding = 0;  ///< what each coordinate of a point may be wrong by [length]
};

/// The answer. Points prove nothing of what is between them: Verified says that none of them
/// refutes.
struct PointClaim {
  Answer answer = Answer::Undefined;
  std::string reason;                              ///< one clause; empty unless undefined
  std::size_t points = 0, outside = 0, faces = 0;  ///< faces: that have points outside
  /// Certain distance of the point outside that sticks out farthest. [length]
  double farthest = 0;
  geom::Vec3 at = geom::Vec3::Zero();
  std::uint32_t face = 0;
  double rounding = 0;  ///< as asked [length]
};

/// Decides of each point whether it lies outside the solid: its winding number, exact, is below 1,
/// it is on no triangle, and it is farther from all of them than the margin and what it may be
/// wrong by. Undefined if the solid's mesh is not closed, or there are no points.
///
/// @param margin  of a set whose bodies' sum the mesh is [length]
/// @throws Error{InvalidInput} on indices out of range or coordinates that are not finite.
PointClaim verify_points(const PointQuestion& question, const geom::Mesh& solid, double margin = 0);

}  // namespace kaboum::verify
