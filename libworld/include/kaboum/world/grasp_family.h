#pragma once

#include <kaboum/world/world.h>

#include <vector>

/// Grasps: the tools that may use them, and the poses of those that leave something free, a tool
/// anywhere round an axis, along an edge, or on two parallel faces. docs/scene.md.
namespace kaboum::world {

/// True if a tool may hold an object by a grasp: one called "TOOL/NAME" is for that tool only.
bool fits(const ToolFrame& tool, const Grasp& grasp);

/// Whether a grasp leaves anything free.
bool is_family(const Grasp& grasp);

/// Members of a family that are drawn at most.
inline constexpr std::size_t kMostMembers = 128;

/// The pose of a drawn member: from the object's frame to the tool's. Of slides and turns, the
/// first one is nearest to the stated pose.
/// @param index  below kMostMembers; of what is no family any
Transform drawn_member(const Grasp& grasp, std::size_t index);

/// Poses that meet constraints of a tool and an object, evenly spread as far as that goes: as many
/// as kMostMembers, or fewer where the search for one more fails.
/// @param center, size  of the object: how far from its middle a tool is looked for [length]
std::vector<Transform> draw_members(const std::vector<ToleratedConstraint>& constraints,
                                    const Vec3& center, double size);

/// The pose of one member, by its slides and turn: from the object's frame to the tool's.
/// @param values  of the slides [length], then of the turn, if there is one [rad]
/// @pre as many as are free.
Transform member_of(const Grasp& grasp, const std::vector<double>& values);

/// Values of members, evenly spread (Roberts's sequence, which is of low discrepancy): the first is
/// the one nearest to the stated pose. The first n of more members are the first n.
std::vector<double> draw_member(const Grasp& grasp, std::size_t index);

/// The pose of the member at which a tool is, if it is at one: the turn and slides that come
/// nearest, brought within the bounds; of constraints, the pose itself where it meets them. What is
/// not the same pose is at no member.
/// @param pose  from the object's frame to the tool's
Transform nearest_member(const Grasp& grasp, const Transform& pose);

/// No member has the tool's origin farther away from a point of the object; infinite where
/// constraints do not bound it. [length]
double farthest_from(const Grasp& grasp, const Vec3& point);

}  // namespace kaboum::world
