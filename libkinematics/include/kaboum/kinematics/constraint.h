#pragma once

#include <kaboum/kinematics/arm.h>

#include <cstdint>
#include <variant>
#include <vector>

namespace kaboum::kinematics {

/// Features of tools, links and objects, in their frames. Directions are of unit length.
struct Point {
  Vec3 position = Vec3::Zero();
};
struct Line {
  Vec3 position = Vec3::Zero(), direction = Vec3::UnitZ();
};
struct Plane {
  Vec3 position = Vec3::Zero(), normal = Vec3::UnitZ();
};
/// A bounded part of a plane: a convex polygon, or a disc.
struct Surface {
  Vec3 position = Vec3::Zero(), normal = Vec3::UnitZ();  ///< in its plane; of a disc the centre
  std::vector<Vec3> outline = {};  ///< corners, counterclockwise against the normal; none: a disc
  double radius = 0;               ///< of the disc [length]
};
using Feature = std::variant<Point, Line, Plane, Surface>;

/// The point of a surface that is nearest to another one.
Vec3 nearest_point(const Surface& surface, const Vec3& p);
/// A point of a surface. Over 0 ≤ u, v < 1 they are evenly spread.
Vec3 point_at(const Surface& surface, double u, double v);
/// A surface moved along its normal. [length]
Surface shifted(Surface surface, double by);

/// The frame that a feature is fixed to.
struct FrameId {
  enum class Kind : std::uint8_t { World, Tool, Object, Link };
  Kind kind = Kind::World;
  std::size_t index = 0;  ///< of the robot or object
  std::size_t link = 0;   ///< of a Link: index in PlacedArm::links of the robot
  bool operator==(const FrameId&) const = default;
};

struct PlacedFeature {
  FrameId frame;
  Feature feature;
};

/// Relation of two features to each other. Source: [gaschler2016] Table 5.1; Coincident(Line,
/// Plane), Angle, the Perpendicular relations of lines, and surfaces are added. Features of one
/// relation may come in either order. The direction of a surface is its plane's normal.
enum class Relation {
  Coincident,     ///< point and point, line, plane, surface; line and line, plane; plane and plane
  Parallel,       ///< lines, planes, line and plane; either direction
  Perpendicular,  ///< lines, planes, line and plane
  /// point and point, line, plane: `value`, above or equal 0 [length]; of a surface, the point is
  /// on the surface moved by so much along its normal
  Distance,
  Angle,  ///< between the directions of lines or normals, 0 … π; or from a plane to a line
          ///< towards the plane's normal, −π/2 … π/2: `value` [rad]
};

/// "coincident", "parallel", "perpendicular", "distance", "angle".
const char* name_of(Relation relation);

struct Constraint {
  Relation relation = Relation::Coincident;
  PlacedFeature first, second;
  double value = 0;
};

/// A constraint's cost, which vanishes just where the constraint is met, and its derivatives.
struct Cost {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
  using Derivative = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor, 4, 6>;
  Rows value;  ///< as many as degrees of freedom taken; lengths are in parts of `length`
  /// By the twists of the frames of the first and second feature: velocity of the frame's origin,
  /// angular velocity.
  Derivative first, second;
};

/// @param first, second  poses of the features' frames.
/// @param length  what a deviation by a length of this much weighs as one by a radian does.
/// @pre the constraint is supported (require_valid).
Cost cost(const Constraint& constraint, const Transform& first, const Transform& second,
          double length);

/// The kinds of deviation that a constraint may have.
struct Measures {
  bool length = false, angle = false;
};
Measures measures_of(const Constraint& constraint);

/// @throws Error{InvalidArgument} when there is no such relation of such features, a direction is
///   not of unit length, or the value makes no sense.
void require_valid(const Constraint& constraint);

}  // namespace kaboum::kinematics
