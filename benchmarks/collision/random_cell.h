#pragma once

#include <kaboum/robot/robot_file.h>
#include <kaboum/world/world.h>

#include <random>
#include <vector>

#include "engine.h"

// A robot of a scene among objects that are put somewhere by chance.
namespace kaboum::collide {

/// Within the limits, and within 3 of 0 each.
std::vector<double> random_values(const robot::Robot& robot, std::mt19937_64& random);

/// Puts all objects in reach of the first robot's arm, off its base.
void scatter_objects(world::World& world, std::mt19937_64& random);

/// The exact meshes of the first robot, which is that of the file, and of the objects, which all
/// have the mesh.
Model triangles_of(const world::World& world, const robot::RobotFile& file,
                   const geom::Mesh& object);

/// @return the mesh there.
geom::Mesh placed(geom::Mesh mesh, const geom::Transform& pose);

}  // namespace kaboum::collide
