#pragma once

#include <kaboum/motion/path_constraint.h>

#include <optional>
#include <string>
#include <vector>

/// The model of a straight push (docs/planning/geometry.md, "Pushing").
namespace kaboum::manipulation {

/// How far a point of what is pushed may be off its line, at any instant. [m]
inline constexpr double kOffLine = 5e-4;
/// How far what is pushed may lean or turn, at any instant. [rad]
inline constexpr double kOffTurn = 2e-3;

/// An object as it stands level on another one, and how far it may be pushed there.
class PushedObject {
 public:
  /// @param at, below  where the object and its support are
  /// @param clearance  things stand up to this, and both ε, above what they stand on [length]
  PushedObject(const world::Object& object, const world::Transform& at,
               const world::Object& support, const world::Transform& below, double clearance);

  /// A sentence where it does not stand so; empty: it does.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }
  /// How far it may be pushed along a level direction of unit length, standing all the way. Never
  /// too far; 0 where it does not stand at all. [length]
  [[nodiscard]] double farthest(const geom::Vec3& direction) const;
  /// The point of which the way is straight: its centre of mass, or `bottom`. In the world.
  [[nodiscard]] const geom::Vec3& center() const { return center_; }

 private:
  [[nodiscard]] bool stands(std::size_t face, const geom::Vec3& shift) const;

  const world::Object& support_;
  world::Transform to_support_;
  std::string refusal_;
  geom::Vec3 center_;
  double slack_ = 0;                ///< what it may be off on its way [length]
  bool balanced_ = false;           ///< its centre of mass is known
  std::vector<geom::Vec3> base_;    ///< in the world
  std::vector<std::size_t> faces_;  ///< bodies of the support that it may stand on
};

/// Which way an object is pushed at a plane of it: level, of unit length. nullopt: the plane is not
/// upright, or the object's center is not ahead of it.
std::optional<geom::Vec3> push_direction(const world::Transform& at, const world::Feature& side,
                                         const geom::Vec3& center);

/// A plane of a link on a plane of an object, facing it.
struct PushContact {
  std::uint32_t link = 0;
  world::Transform link_pose;  ///< in the world, at the first touch
  geom::Vec3 direction;        ///< of the push
};

/// @param turn  of the link about the direction; 0: its tool looks down as far as that goes
/// @param clearance  between both planes, with both ε [length]
/// @return nullopt: contact is not wide enough on both sides of the line through `center`.
std::optional<PushContact> push_contact(const world::RobotModel& robot,
                                        const world::LinkFeature& front,
                                        const world::Object& object, const world::Transform& at,
                                        const world::Feature& side, const geom::Vec3& direction,
                                        const geom::Vec3& center, double turn, double clearance);

/// What an object keeps that a link pushes along a line: at every instant.
/// @param held    how it moves with the link
/// @param center  of the object, in the world, where the line begins
std::vector<motion::PathConstraint> push_constraints(const world::Attachment& held,
                                                     const world::Transform& object,
                                                     const geom::Vec3& center,
                                                     const geom::Vec3& direction, double length);

/// Features that say where pushing is: planes called `push…`.
bool is_for_pushing(const world::Feature& feature);

}  // namespace kaboum::manipulation
