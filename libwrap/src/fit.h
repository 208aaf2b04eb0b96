#pragma once

#include <kaboum/geom/triangle_search.h>

#include <optional>
#include <vector>

#include "quadric.h"
#include "surface.h"

namespace kaboum::wrap {

/// Where the surface is wished, and where it may go.
struct Room {
  const geom::DistanceQuery& carved;  ///< what a ball of the diameter `seal` cannot reach
  double seal;
  double clearance;  ///< the surface may be nowhere nearer to the input [length]
  double offset;     ///< the surface should be nowhere farther from the input [length]

  /// The distance that is aimed at, in the middle of the room.
  [[nodiscard]] double aim() const { return 0.5 * (clearance + offset); }
  /// The room on either side.
  [[nodiscard]] double slack() const { return 0.5 * (offset - clearance); }
  /// Farther away the surface stays as it is: it closes a gap.
  [[nodiscard]] double far() const { return offset + 0.25 * seal; }
  /// How far corners may go from what was carved.
  [[nodiscard]] double depth() const { return offset + 0.25 * seal; }
  /// The surface should be nowhere farther from the input than what a ball leaves.
  [[nodiscard]] double farthest() const { return offset + 0.5 * seal; }
  [[nodiscard]] bool allows(const Vec3& p) const {
    return carved.within(p, depth()) != geom::TriangleSearch::kNone;
  }
};

struct Plane {
  Vec3 normal = Vec3::Zero(), point = Vec3::Zero();
  double area = 0;  ///< of the triangle that it stands for
};

/// Brings a surface nearer to the input, step by step. Proposals are rounded; the surface decides.
class Fit {
 public:
  Fit(Surface& surface, const Obstacle& obstacle, const Room& room)
      : surface_(surface), obstacle_(obstacle), room_(room), hint_(surface.vertex_count(), 0) {}

  /// Each vertex goes to where the tangent planes of the input's offset near it meet: onto the
  /// edges of planes.
  void settle();
  /// Splits edges whose middle is too far from the input, and brings the new vertices near.
  /// @return how many
  std::size_t refine();

  /// The offset's tangent plane near the middle of a triangle, or the triangle's own where the
  /// input is far.
  [[nodiscard]] Plane plane_of(std::uint32_t triangle) const;

 private:
  /// The input's nearest point to the middle of a triangle; asked for once while it stays there.
  [[nodiscard]] const Foot& foot_of(std::uint32_t triangle, const Vec3& middle) const;
  /// @return whether the vertex is near now
  bool approach(std::uint32_t v);
  void settle(std::uint32_t v, const std::vector<Plane>& planes);
  /// Whether `to` is within the offset of the input, or no farther from it than `from`.
  [[nodiscard]] bool no_farther(const Vec3& from, const Vec3& to, std::uint32_t hint) const;

  Surface& surface_;
  const Obstacle& obstacle_;
  const Room& room_;
  std::vector<std::uint32_t> hint_;  ///< per vertex: a triangle of the input that was near
  struct NearestFoot {
    Vec3 middle;
    Foot foot;
  };
  mutable std::vector<std::optional<NearestFoot>> known_;  ///< per triangle, where it was last
};

}  // namespace kaboum::wrap
