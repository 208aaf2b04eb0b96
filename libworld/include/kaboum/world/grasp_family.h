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

/// The pose of one member: from the object's frame to the tool's.
/// @param values  of the slides [length], then of the turn, if there is one [rad]
/// @pre as many as are free.
Transform member_of(const Grasp& grasp, const std::vector<double>& values);

/// Values of members, evenly spread (Roberts's sequence, which is of low discrepancy): the first is
/// the one nearest to the stated pose. The first n of more members are the first n.
std::vector<double> draw_member(const Grasp& grasp, std::size_t index);

/// The pose of the member at which a tool is, if it is at one: the turn and slides that come
/// nearest, brought within the bounds. What is not the same pose is at no member.
/// @param pose  from the object's frame to the tool's
Transform nearest_member(const Grasp& grasp, const Transform& pose);

/// No member has the tool's origin farther away from a point of the object. [length]
double farthest_from(const Grasp& grasp, const Vec3& point);

}  // namespace kaboum::world
