#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot.h>
#include <kaboum/verify/distance.h>

#include <string>
#include <vector>

/// The distance that bodies of a robot's link reach beyond the link's shapes.
namespace kaboum::verify {

/// Shapes of a link as distances are measured to them: closed chains, in the link's frame. Meshes
/// are prepared as bcd-decompose does, holes filled; of what preparing refuses or leaves out, the
/// triangles count. Poses are rounded.
struct MeasuredLink {
  /// `inside` has polytopes within cylinders, spheres, capsules and ellipsoids, `round` such as
  /// hold them.
  geom::Mesh inside, round;
};

/// @param files  of the robot
/// @throws Error{InvalidInput} where a mesh cannot be read
MeasuredLink measured_link(const std::vector<robot::Geometry>& shapes, robot::MeshFiles& files);

/// Decides whether no point of a link's bodies is farther than `epsilon` from its shapes.
/// @param inside, round  bodies within those that are meant, and round them; may be the same
/// @pre epsilon > 0; all bodies are convex
DistanceClaim verify_link_reach(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                                const MeasuredLink& link, double epsilon);

/// The answer in words: "no point of them is farther than 0.02 from its shapes".
std::string sentence_of_reach(const DistanceClaim& claim, double epsilon);

}  // namespace kaboum::verify
