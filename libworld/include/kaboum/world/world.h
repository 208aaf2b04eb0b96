#pragma once

#include <kaboum/collide/bounding_set.h>
#include <kaboum/kinematics/constraint.h>
#include <kaboum/robot/robot.h>
#include <kaboum/world/primitive.h>

#include <array>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Subject of a planner's geometric questions: robots, objects and regions by their bounding sets,
/// never by meshes. docs/scene.md.
namespace kaboum::world {

using collide::BoundingSet;
using geom::Transform;
using geom::Vec3;

/// A frame fixed to a link, as of a tool.
struct ToolFrame {
  std::string name;
  std::uint32_t link = 0;
  Transform pose;  ///< from the frame to the link's
};

/// The links that may touch what a tool holds: fingers, with the link that the tool is fixed to; or
/// pads, and nothing else.
struct Gripper {
  std::string name;
  std::size_t tool = 0;              ///< index of a tool frame
  std::vector<std::uint32_t> links;  ///< fingers; none where there are pads
  /// Links that alone may touch what is held, while it is held; ascending.
  std::vector<std::uint32_t> pads = {};
  /// Variables of the robot that close and open it; none: suction, or fingers that do not move.
  /// While nothing is held by the pads they are as at the robot's home.
  std::vector<std::uint32_t> joints = {};
  double force = 0;  ///< with which each joint closes, at most; 0: not stated [N or N m]
};

/// The bounding sets of a link, in its frame.
struct LinkShape {
  std::uint32_t link = 0;
  BoundingSet outer;
  std::optional<BoundingSet> inner;
};

/// A point, line, plane or surface of an object or a link by name, in its frame.
struct Feature {
  enum class Kind { Point, Line, Plane, Surface };
  std::string name;
  Kind kind = Kind::Point;
  Vec3 point = Vec3::Zero();      ///< of it; of a disc the centre
  Vec3 direction = Vec3::Zero();  ///< of unit length: along the line, or the normal
  /// Corners of a surface, counterclockwise against the normal; none: a disc.
  std::vector<Vec3> outline = {};
  double radius = 0;  ///< of a disc [length]
};

/// A feature that is fixed to a link, in the link's frame.
struct LinkFeature {
  std::uint32_t link = 0;
  Feature feature;
};

/// A feature and what it is fixed to.
struct FixedFeature {
  enum class To : std::uint8_t { World, Object, Link };
  To to = To::World;
  std::size_t index = 0;   ///< of the object or robot
  std::uint32_t link = 0;  ///< of a Link
  Feature feature;         ///< in the frame of what it is fixed to
};

/// A relation of two features that is to hold within a tolerance.
struct ToleratedConstraint {
  kinematics::Relation relation = kinematics::Relation::Coincident;
  FixedFeature first, second;
  double value = 0;            ///< of a distance [length] or an angle [rad]
  double within = 1e-3;        ///< how far lengths may be off [length]
  double within_angle = 0.02;  ///< how far directions may be off [rad]
};

/// Constraints that hold at once, by a name.
struct ConstraintSet {
  std::string name;
  std::vector<ToleratedConstraint> constraints;
  /// Such as are met where that goes, the most important first. Nothing is claimed of them.
  std::vector<ToleratedConstraint> preferred = {};
};

/// Two links of a robot whose contact is not looked for.
struct AllowedPair {
  enum class Reason {
    Adjacent,  ///< a joint connects them, or fixed joints on the way
    Never,     ///< proved: in no configuration within the limits
    Always,    ///< connected by fixed joints only
    Stated,    ///< by the scene
  };
  std::uint32_t a = 0, b = 0;  ///< links, a < b
  Reason reason = Reason::Stated;
};
const char* name_of(AllowedPair::Reason reason);

struct RobotModel {
  std::string name;
  robot::Robot kinematics;  ///< limits are those of the scene where it states some
  Transform base;           ///< from the robot's root to the world
  std::vector<double> home;
  std::vector<LinkShape> shapes;
  std::vector<ToolFrame> tools;
  std::vector<Gripper> grippers;
  std::vector<LinkFeature> features;  ///< names of one kind differ
  std::vector<AllowedPair> allowed;
  std::string fingerprint;  ///< hash of what proofs about the robot alone depend on
};

/// A slide of a tool along a direction of what it holds, between two bounds.
struct FreeSlide {
  Vec3 direction = Vec3::UnitX();  ///< of unit length, in the object's frame
  double from = 0, to = 0;         ///< from the grasp's stated pose; from ≤ to [length]
};

/// A turn of a tool about an axis of what it holds, between two bounds.
struct FreeTurn {
  Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();  ///< axis of unit length, in the object's frame
  /// From the grasp's stated pose; from ≤ to, at most a whole turn. [rad]
  double from = -std::numbers::pi, to = std::numbers::pi;
};

/// Hold of a tool on an object. With slides or a turn it is a family of holds: the tool is turned
/// about the axis, then slid, by any values within the bounds. With constraints it is all holds
/// that meet them (grasp_family.h).
struct Grasp {
  std::string name;
  Transform pose;                      ///< from the object's frame to the tool's
  std::vector<FreeSlide> slides = {};  ///< at most two, not parallel
  std::optional<FreeTurn> turn = {};
  unsigned rank = 0;  ///< planners try grasps of a lower one first
  /// Between features of the tool, which are the first ones, in its frame, and of the object.
  std::vector<ToleratedConstraint> constraints = {};
  std::vector<Transform> members = {};  ///< some holds that meet them; the pose is the first one
  /// Values of the gripper's joints while it holds the object, by their names. [rad or length]
  std::vector<std::pair<std::string, double>> opening = {};
  /// How far each of them may be off, ≥ 0: fingers stop where they touch. [rad or length]
  double within = 1e-3;
  std::vector<std::string> pads = {};  ///< links of the gripper that touch it; none: all its pads
};

struct Object {
  std::string name;
  Transform pose;  ///< where it is at first: from its frame to the world
  BoundingSet outer;
  std::optional<BoundingSet> inner;
  std::vector<Feature> features;
  std::vector<Grasp> grasps;
  std::optional<Primitive> primitive = {};  ///< of which the sets are; none: they are of a mesh
  /// While a robot carries it, it leans by no more than this from how it stands at first; none: it
  /// may lean as it likes. > 0 [rad]
  std::optional<double> upright = {};
  /// Of a point cloud (cloud.h): what the point of each body is called; else empty.
  std::vector<std::uint32_t> point_numbers = {};
};

/// A part of space that things may be asked to be in.
struct Region {
  std::string name;
  Transform pose;
  BoundingSet inner;
};

/// The value of a gripper's joint while it holds something. [rad or length]
struct FingerValue {
  std::uint32_t variable = 0;  ///< of the robot
  double value = 0;
  double within = 0;  ///< how far it may be off, ≥ 0
};

/// An object that moves with a link.
struct Attachment {
  std::size_t robot = 0;
  std::uint32_t link = 0;
  Transform pose;                         ///< from the object's frame to the link's
  std::vector<std::uint32_t> touching;    ///< links that may touch it besides, ascending
  bool link_touches = true;               ///< the link itself may touch it; false: `touching` alone
  std::string grasp = {};                 ///< of the object, by whose opening it is held; "": none
  std::vector<FingerValue> fingers = {};  ///< of the gripper that holds it
};

/// Something that can collide: a shape of a robot, or an object (then `robot` is kObject).
struct Item {
  static constexpr std::size_t kObject = static_cast<std::size_t>(-1);
  std::size_t robot = kObject;
  std::size_t index = 0;  ///< of RobotModel::shapes, or of World::objects

  friend bool operator==(const Item&, const Item&) = default;
  friend bool operator<(const Item& x, const Item& y) {
    return x.robot != y.robot ? x.robot < y.robot : x.index < y.index;
  }
};

/// Distances that things are to be kept from each other (margin_between). [length]
struct Margins {
  double all = 0;                                      ///< of any two things
  std::map<Item, double> of = {};                      ///< of a thing from all others
  std::map<std::size_t, double> of_robots = {};        ///< of what a robot carries, likewise
  std::map<std::array<Item, 2>, double> between = {};  ///< of a pair, the lesser item first

  [[nodiscard]] double largest() const;
};

/// The part of the world that stays the same during planning.
struct World {
  std::string unit = "m";
  std::vector<RobotModel> robots;
  std::vector<Object> objects;
  std::vector<Region> regions;
  std::vector<ConstraintSet> constraints = {};
  std::vector<std::array<Item, 2>> allowed;            ///< contacts that are none
  std::vector<std::optional<Attachment>> attachments;  ///< at first; one for every object
  Margins margins = {};

  /// "ROBOT/LINK" or "OBJECT".
  [[nodiscard]] std::string name_of(const Item& item) const;
  /// The number of the point that a body of a cloud stands for; nullopt: the item is none.
  [[nodiscard]] std::optional<std::uint32_t> point_of(const Item& item, std::size_t body) const;
  [[nodiscard]] std::optional<std::size_t> find_robot(const std::string& name) const;
  [[nodiscard]] std::optional<std::size_t> find_object(const std::string& name) const;
  /// @throws Error{InvalidArgument} when there is none, with a similar name.
  [[nodiscard]] const ConstraintSet& constraint_set(const std::string& name) const;
  [[nodiscard]] const BoundingSet& outer(const Item& item) const;
  [[nodiscard]] const std::optional<BoundingSet>& inner(const Item& item) const;
};

/// The part of the world that changes. Poses of objects that are attached are not looked at.
struct WorldState {
  std::vector<std::vector<double>> q;                  ///< for each robot a value per variable
  std::vector<Transform> poses;                        ///< of the objects, to the world
  std::vector<std::optional<Attachment>> attachments;  ///< one for every object
  /// For every object whether it has left the world: nothing is checked of it. Empty: none has.
  std::vector<bool> absent = {};
  /// Likewise for every robot; what it carries is to be absent as well. Empty: none has.
  std::vector<bool> absent_robots = {};
};

/// Robots at home, objects where the scene has them; grippers as they hold what is attached.
WorldState initial_state(const World& world);

}  // namespace kaboum::world
