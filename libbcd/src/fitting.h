#pragma once

#include <optional>
#include <span>
#include <vector>

#include "regional_body.h"

namespace kaboum::bcd {

using geom::Vec3;

/// A box along axes of its own.
struct AxesBox {
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, orthonormal up to rounding
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();        ///< extent along the axes, from the centre

  [[nodiscard]] std::vector<Vec3> corners() const;
  /// How far a point is outside, by the farthest pair of faces; negative inside. [length]
  [[nodiscard]] double beyond(const Vec3& p) const;
};

/// All points no farther than the radius from a segment, or from a point.
struct Capsule {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double radius = 0;

  [[nodiscard]] double beyond(const Vec3& p) const;
};

/// How far the face of a box along axis k (its high one, or its low one) may be moved outwards so
/// that the box meets no cap: at most `most`; negative where the box meets one already. [length]
double room(const ParallelBody& body, const AxesBox& box, int k, bool high, double most);
double room(const RegionalBody& body, const AxesBox& box, int k, bool high, double most);

/// Moves faces of a box outwards, in turns, as far as the body allows.
/// @param share  of the room that each turn takes; 1: faces in order
void grow(const RegionalBody& body, AxesBox& box, std::span<const int> order, double share);

/// Whether a box with a point in the body meets no cap.
inline bool fits(const RegionalBody& body, const AxesBox& box) {
  return room(body, box, 0, true, 0) >= 0;
}

/// The distance of a segment with a point in the body to the nearest cap, or less; 0 where it meets
/// one, or where it is less than `least`. [length]
double clearance(const ParallelBody& body, const Vec3& from, const Vec3& to, double least = 0);
/// The same, and no more than the regions allow. [length]
double clearance(const RegionalBody& body, const Vec3& from, const Vec3& to, double least = 0);

/// The box along the axes round points, enlarged by `spare` on all sides.
AxesBox box_round(std::span<const Vec3> points, const Eigen::Matrix3d& axes, double spare);

/// A round cylinder without ends.
struct Cylinder {
  Vec3 direction = Vec3::UnitZ();  ///< of length 1
  Vec3 center = Vec3::Zero();      ///< of the axis, square to the direction as seen from the origin
  double radius = 0;

  [[nodiscard]] double distance_from_axis(const Vec3& p) const {
    return (p - direction.dot(p) * direction - center).norm();
  }
};

/// A cylinder along a direction round points that is little larger than the smallest one.
/// @pre there is a point
Cylinder cylinder_round(std::span<const Vec3> points, const Vec3& direction);

/// The shortest capsule of a radius about a cylinder's axis that holds the points with `spare` to
/// spare; nullopt where the cylinder's radius is larger.
/// @param cylinder  round the points
std::optional<Capsule> capsule_round(std::span<const Vec3> points, const Cylinder& cylinder,
                                     double radius, double spare);

}  // namespace kaboum::bcd
