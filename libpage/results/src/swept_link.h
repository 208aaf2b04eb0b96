#pragma once

#include <kaboum/geom/triangle_search.h>
#include <kaboum/robot/path.h>

#include <cstdint>
#include <vector>

namespace kaboum::page {

/// Distances from what a link's shapes sweep along a path, to be looked at: the nearest of many
/// instants, then looked for more closely. Never below the distance, within rounding.
class SweptLink {
 public:
  /// @param shapes  in the link's frame, with triangles.
  /// @pre robot and path outlive it; the path has a waypoint.
  SweptLink(const robot::Robot& robot, const robot::Path& path, std::uint32_t link,
            const geom::Mesh& shapes);

  /// Safe to call from several threads. [length]
  [[nodiscard]] double distance(const geom::Vec3& p) const;

 private:
  [[nodiscard]] geom::Transform pose_at(double instant) const;
  [[nodiscard]] double distance_at(const geom::Transform& pose, const geom::Vec3& p) const;

  const robot::Robot& robot_;
  const robot::Path& path_;
  std::uint32_t link_;
  geom::DistanceQuery shapes_;
  geom::Vec3 center_;
  double radius_;                       ///< of a ball round the shapes
  std::size_t per_leg_;                 ///< instants between two waypoints
  std::vector<geom::Transform> poses_;  ///< at instants i / per_leg_, a leg of the path taking 1
};

}  // namespace kaboum::page
