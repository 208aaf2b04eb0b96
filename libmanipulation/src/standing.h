#pragma once

#include <kaboum/geom/polygon2.h>
#include <kaboum/world/world.h>

#include <string>
#include <vector>

namespace kaboum::manipulation {

/// How far from one plane points of a face may be, with the sets' ε. [m]
inline constexpr double kFlat = 1e-4;

/// What of a convex body is at its top, seen from above: in the object's frame.
class UpperFace {
 public:
  /// @param inside  the outline is taken so much smaller all round
  UpperFace(const geom::ConvexBody& body, double inside);

  [[nodiscard]] double height() const { return height_; }
  /// Whether a point is above it, seen from above.
  [[nodiscard]] bool holds(const geom::Vec3& p) const {
    return geom::holds(outline_, p.head<2>(), inside_);
  }
  /// A point of the box round it, by shares of its sides.
  [[nodiscard]] geom::Vec3 at(double x, double y) const;
  /// The diagonal of that box. [length]
  [[nodiscard]] double extent() const { return (high_ - low_).head<2>().norm(); }

 private:
  double inside_ = 0;
  double height_ = 0;
  geom::Vec3 low_, high_;
  geom::Polygon2 outline_;
};

/// True of an object whose z axis is the world's.
bool is_level(const Eigen::Matrix3d& turned);

/// What of an object's outer set is no higher than a point of it, but for `close`: no less than all
/// of it is in the convex hull of these. About that point, turned as the object stands.
std::vector<geom::Vec3> base_of(const world::Object& object, const Eigen::Matrix3d& stands,
                                const geom::Vec3& point, double close);
/// What of an object's outer set is no higher than a point of it, but for `kFlat`, and no more than
/// that: the outline made smaller by the set's ε is inside that of the solid's points no higher
/// than ε + `kFlat`. About that point, turned as the object stands.
geom::Polygon2 foot_of(const world::Object& object, const Eigen::Matrix3d& stands,
                       const geom::Vec3& point);
/// True of a foot wide enough to stand on an outer set, which may close slots of the solid.
bool bridges_slots(const geom::Polygon2& foot, const world::Object& object,
                   const world::Object& support);

/// @param needs  what needs it: "putting it down"
/// @throws Error{InvalidInput} when the object has no such feature.
const world::Feature& feature_named(const world::Object& object, const std::string& name,
                                    world::Feature::Kind kind, const char* needs);

}  // namespace kaboum::manipulation
