#pragma once

#include <kaboum/verify/points.h>
#include <kaboum/verify/sweep.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Points of the exact faces of a shape that moves, in the last frame of its chain.
struct MovingPoints {
  std::string name;
  ExactPoints exact;
  KinematicChain chain;
};

/// Points multiplied by a mesh's scale.
ExactPoints scaled(ExactPoints exact, const geom::Vec3& scale);

/// The answer about them, during a path.
struct MovingPointClaim {
  PointClaim points;  ///< of all shapes and configurations together; `face` is one of `shape`
  std::size_t configurations = 0;
  std::size_t shape = 0, segment = 0;  ///< where `points.at` is; segment i leads to waypoint i + 1
  double s = 0;                        ///< where in the segment, 0 to 1
};

/// Decides of each point at the waypoints and at configurations between them whether it lies
/// outside a set of convex bodies, margin included: certainly, roundings of poses taken off. Where
/// that would be more than some 500,000 looks, every n-th point is looked at, others at each
/// configuration.
/// @return nullopt if there are no points
/// @throws as verify_points
std::optional<MovingPointClaim> verify_moving_points(std::span<const MovingPoints> shapes,
                                                     const std::vector<std::vector<double>>& path,
                                                     const geom::ConvexSet& set);

}  // namespace kaboum::verify
