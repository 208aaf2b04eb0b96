#pragma once

#include <kaboum/geom/mesh.h>

/// Balls and solids by brute force in rational numbers (GMP). Shares nothing with the libraries but
/// the Mesh struct.
namespace kaboum::test {

/// Sign of a point's distance from the nearest triangle of a mesh, less `length`.
int compare_distance(const geom::Mesh& mesh, const geom::Vec3& p, double length);

/// Whether a point is in the closed ball.
bool is_in_ball(const geom::Vec3& center, double radius, const geom::Vec3& p);

/// Whether the closed ball lies in the solid.
/// @pre a closed chain, each of whose triangles has its solid on one side
bool is_ball_in_solid(const geom::Mesh& mesh, const geom::Vec3& center, double radius);

}  // namespace kaboum::test
