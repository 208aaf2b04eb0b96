#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "half_space.h"
#include "point_tree.h"

namespace kaboum::bcd {

/// Planes through two points that touch a convex hull, which is on their lower side. Each pair is
/// asked for by all contractions round an edge: found once.
class TangentPlanes {
 public:
  /// @param hull  points that it is the hull of; kept by reference.
  /// @param size  about that of the hull. [length]
  TangentPlanes(const PointTree& hull, double size) : hull_(hull), size_(size) {}

  /// Of a facet's own edges, the plane is that of the facet.
  /// @param corners  of the vertices `triangle`.
  void add_facet(const geom::Triangle& triangle, const std::array<geom::Vec3, 3>& corners,
                 const HalfSpace& plane);

  /// The plane through the edge from u to w, seen from the side of the triangle that is to its
  /// left; null where none is certain. Valid as long as this object.
  const HalfSpace* through(std::uint32_t from, std::uint32_t to, const geom::Vec3& u,
                           const geom::Vec3& w);

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32U | to;
  }
  [[nodiscard]] std::optional<HalfSpace> find(const geom::Vec3& u, const geom::Vec3& w) const;

  const PointTree& hull_;
  double size_;
  std::unordered_map<std::uint64_t, std::optional<HalfSpace>> known_;  // by edge
};

}  // namespace kaboum::bcd
