#pragma once

#include <kaboum/robot/transform.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot {

enum class JointType { Fixed, Revolute, Prismatic };

/// A shape fixed to a link.
struct Geometry {
  enum class Shape { Mesh, Box, Cylinder, Sphere, Capsule, Ellipsoid };
  Shape shape = Shape::Box;
  Transform origin;  ///< from the shape's frame to the link's
  /// Mesh: scale of its coordinates. Box: lengths of the edges. Cylinder: radius, length along z.
  /// Sphere: radius. Capsule: radius, length along z of the segment that it is round. Ellipsoid:
  /// half its axes. [length, or a factor]
  Vec3 size = Vec3::Ones();
  std::string mesh;  ///< file or URI, as the robot's file states it
  int line = 0;      ///< of the robot's file; 0: not known
};

/// True if a shape that is no mesh has a size of 0: no volume, but perhaps an area or a length.
bool is_flat(const Geometry& geometry);
/// True if it is a point: nothing is left that could be held.
bool is_point(const Geometry& geometry);
/// Its kind and what is special of its size: "cylinder of length 0".
std::string describe(const Geometry& geometry);

/// A shape of a link that no Geometry says.
struct UnreadShape {
  bool visual = false;  ///< for drawing only
  std::string what;     ///< "a plane"
  /// Why shapes of its kind are refused where they are meant, with the place in the file; empty:
  /// they are not.
  std::string refusal = {};
};

struct Link {
  std::string name;  ///< which no other link has
  std::vector<Geometry> collision, visual;
  /// What the link has besides: nothing can be claimed to hold it, or to keep clear of it.
  std::vector<UnreadShape> unread = {};
};

/// Connects a link to its parent: pose of the link = pose of the parent · origin · motion, where
/// the motion turns about (moves along) `axis` by multiplier · q[variable] + offset.
struct Joint {
  std::string name;
  JointType type = JointType::Fixed;
  std::uint32_t parent = 0;  ///< index of a link
  Transform origin;
  Vec3 axis = Vec3::UnitZ();   ///< of unit length, in the joint's frame
  std::uint32_t variable = 0;  ///< not for fixed joints; shared by joints that mimic one another
  double multiplier = 1, offset = 0;
  /// Its own limits, where it mimics another joint and its file has some. The variable's limits are
  /// the other joint's, and may drive this one beyond. [rad or length]
  std::optional<double> lower = {}, upper = {};
  /// It moves in ways that no type says (Robot::unmodelled), and is fixed here.
  bool unmodelled = false;
};

/// A degree of freedom, and its limits [rad or length].
struct Variable {
  std::string name;  ///< of the joint
  std::optional<double> lower, upper;
  std::optional<double> velocity = {};  ///< that all joints it moves allow, > 0 [rad/s, length/s]
};

/// A tree of links. Link 0 is the root; joints[i] moves links[i + 1], whose parent comes before it.
struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Variable> variables;
  /// What moves in ways that no joint here says, and stands still here: "robot.xml:12: joint 'x' is
  /// a ball joint". Shapes of links do not depend on it; whatever is said of motions does.
  std::vector<std::string> unmodelled = {};
  std::vector<std::string> notes = {};  ///< what was left out, with its place

  [[nodiscard]] std::optional<std::uint32_t> find_link(std::string_view link_name) const;
};

/// Checks what Robot promises: indices, names of links, numbers, unit axes, rotations, limits.
/// @throws Error{InvalidInput} naming the joint or link.
void require_valid(const Robot& robot);

/// Robot of a URDF document, 1.0, 1.1 or 1.2: revolute, continuous, prismatic, fixed and mimicking
/// joints. Variables are numbered depth first from the root, the joints of one link in the order of
/// their names. Rotations come from rpy, or from quat_xyzw since 1.1, within 40 · 2^-53. Capsules
/// are of 1.1. Shapes of size 0 are kept (is_flat): robots in wide use have some. Inertia,
/// materials and transmissions are not looked at. Source: <http://wiki.ros.org/urdf/XML>; where
/// that is silent, as urdfdom: 3.0, and 6.0 of what is new.
/// @param name  appears in messages.
/// @throws Error{InvalidInput} naming the line where known: XML that is not well-formed or has
///   xacro in it; several or no roots, loops, links with two parents.
///   Also names used twice, mimicry of absent joints, numbers that are not finite, shapes of
///   negative size or unknown kind, and two origins, axes or shapes where one is meant.
Robot parse_urdf(std::string_view text, const std::string& name);

/// Robot of the Robotics Library: <rlkin> (Denavit–Hartenberg, distal) or <rlmdl>; degrees in the
/// file. Shapes are not part of these files: links have none.
/// @throws Error{InvalidInput} naming the line: not well-formed, other joints than revolute,
///   prismatic and fixed, frames that are not connected to the world.
Robot parse_rl(std::string_view text, const std::string& name);

/// Points whose hull contains the box, cylinder, sphere, capsule or ellipsoid: the box's corners, a
/// prism with 32 sides round the cylinder (0.5 % of the radius), a polytope with 162 corners round
/// the sphere (2 %), two of them round the capsule, one stretched round the ellipsoid.
/// What is flat is given 0.5 % of its largest size as thickness. In the link's frame, up to
/// rounding of 100 · 2^-53 of their distance.
/// @pre shape is not Mesh; it is no point.
std::vector<Vec3> bounding_points(const Geometry& geometry);

/// Bound of what the hull reaches beyond the shape. [length]
double bounding_excess(const Geometry& geometry);

}  // namespace kaboum::robot
