#pragma once

#include <kaboum/world/world.h>

#include <array>
#include <string>
#include <string_view>

namespace kaboum::world {

/// The feature of a name: one that the scene names ("OBJECT/FEATURE", "ROBOT/FEATURE"), or a part
/// of a frame ("world.z", "OBJECT.origin", "ROBOT/TOOL.x", "ROBOT/LINK.xy", "ROBOT.z" of its root):
/// the point "origin", the lines "x", "y", "z" through it, and the planes "xy", "yz", "zx", whose
/// normals are z, x and y. A feature that the scene names goes before a part of a frame, and a tool
/// before a link.
/// @throws Error{InvalidArgument} when there is no such feature, with similar names, or two kinds
///   have the name.
FixedFeature find_feature(const World& world, const std::string& name);

/// The part of a frame of that name ("origin", "x", "xy", …), in the frame. nullopt: there is none.
std::optional<Feature> find_frame_part(std::string_view part);

/// "angle 'cup.z' 'world.z'"
std::string describe(const ToleratedConstraint& constraint);

/// Whether a constraint is met within its tolerances. Of two lines, or planes, that coincide, the
/// second one's point is near the first one, or the first one's near the second one.
/// @param first, second  poses of the frames that the features are fixed to, in any one frame
bool is_met(const ToleratedConstraint& constraint, const Transform& first, const Transform& second);

/// Distance of a point from a feature. [length]
double distance_from(const Feature& feature, const Vec3& point);

/// How far a surface reaches from its point; 0 of other features. [length]
double radius_of(const Feature& surface);

/// A feature of one frame in another one, in which the first has this pose.
Feature moved(const Feature& feature, const Transform& pose);

/// Where a feature is in the world, and the link that moves it: in the world, or in the frame of
/// the link of a robot. Objects that are carried are fixed to the link.
/// @param state  of this world: what is carried, and where objects that are not are
FixedFeature at_state(const World& world, const WorldState& state, const FixedFeature& feature);

/// Names of constraints that every robot has, and no set of a scene may have: of a motion from its
/// start on (motion::KeepRequest).
inline constexpr std::array<std::string_view, 4> kUsualConstraints{"upright", "orientation", "line",
                                                                   "level"};
bool is_usual_constraint(std::string_view name);

/// The feature as kinematics has it.
kinematics::Feature kinematics_feature(const Feature& feature);

/// A constraint as kinematics has it, of two frames: 0 that of its first feature, 1 of its second.
kinematics::Constraint kinematics_constraint(const ToleratedConstraint& constraint);

}  // namespace kaboum::world
