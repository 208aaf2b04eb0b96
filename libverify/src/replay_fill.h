#pragma once

#include <kaboum/bmesh/log.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kaboum::verify {

/// Why what a log fills holes with is not what docs/algorithms/preparation.md states; empty if it
/// is: each hole is a loop of edges of one component where the triangles do not cancel, without a
/// vertex twice, and is filled with the triangle or else with the fan that runs through it
/// backwards (so that both cancel), in its order, from the mean of its vertices. The mean may be a
/// vertex of the mesh; where it is on the loop, the fan's two triangles without an area are left
/// out.
///
/// That has to be checked, since solid and claims are those of the filled mesh: a fan with another
/// tip, one whose rim is no hole, or a closed part that hangs on a fan could take from the solid
/// what the input has in it, and still close every edge.
///
/// @param triangles  those of the input that are left, oriented; @param points theirs.
/// @pre the log's filling triangles name points or filling vertices, and none of them twice.
std::string find_wrong_fill(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                            const std::vector<geom::Vec3>& points, const bmesh::Log& log);

}  // namespace kaboum::verify
