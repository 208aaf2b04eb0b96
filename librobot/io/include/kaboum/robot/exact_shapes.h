#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot.h>

#include <vector>

namespace kaboum::robot {

/// Triangles of a mesh's file where a shape of a link has them, turned where its scale mirrors
/// them.
geom::Mesh placed_mesh(const geom::Mesh& file, const Geometry& shape);

/// Shapes of a link as one mesh in its frame: the triangles of mesh files as they are, turned where
/// the scale mirrors them; boxes; of cylinders and spheres the polytopes that enclose them
/// (bounding_points). Nothing of points.
/// @param files  of the robot
/// @throws Error{InvalidInput} where a file cannot be read.
geom::Mesh exact_shapes(const std::vector<Geometry>& shapes, MeshFiles& files);

}  // namespace kaboum::robot
