#pragma once

#include <kaboum/robot_folder/simple_shapes.h>

#include <vector>

namespace kaboum::robot_folder {

/// Spheres, capsules and boxes of a robot as a scene for viewers: glTF 2.0 in a binary container.
/// A node for each link, where it is with all joints at 0, or at the limit next to 0; below it a
/// node for each shape. All balls, cylinders and boxes are instances of one mesh each, scaled; of a
/// colour for each link. Numbers are rounded to float32: it is to look at, nothing is claimed of
/// it. The robot's z axis is up.
std::vector<char> glb_of_shapes(const robot::Robot& robot, const SimpleShapes& shapes);

}  // namespace kaboum::robot_folder
