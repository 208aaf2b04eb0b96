#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/robot_file.h>

#include <string>
#include <vector>

namespace kaboum::robot_folder {

/// A sphere, a capsule or a box as files of robots state it.
struct SimpleShape {
  enum class Kind { Sphere, Capsule, Box } kind = Kind::Sphere;
  std::uint32_t link = 0;
  geom::Vec3 center = geom::Vec3::Zero();
  geom::Vec3 rpy = geom::Vec3::Zero();   ///< of a capsule's axis z, of a box [rad]
  geom::Vec3 size = geom::Vec3::Zero();  ///< radius and length between the ends; edges [length]
};

/// Shapes of a robot's links.
struct SimpleShapes {
  std::vector<SimpleShape> shapes;
  double beyond = 0;  ///< no point of one is farther than this from its body [length]
};

/// Shapes that hold bodies: points are held by spheres, two points by capsules, others by the box
/// of least volume along two of their differences. Sizes are larger by what poses are rounded by
/// (docs/algorithms/capsules-and-boxes.md, "Robots").
SimpleShapes simple_shapes(const std::vector<robot::LinkBody>& bodies);

/// The robot's URDF with these shapes as the <collision> elements of all links whose shapes they
/// hold. A capsule is a <cylinder> and two <sphere> elements, which every reader knows.
/// @param file  to be written: names of meshes for drawing are made relative to it
/// @throws Error{InvalidInput} where the robot is no URDF
std::string urdf_of_shapes(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                           const SimpleShapes& shapes, const std::string& parameters,
                           const std::string& file);

}  // namespace kaboum::robot_folder
