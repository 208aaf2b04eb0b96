#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/model_text.h>
#include <kaboum/robot/primitive.h>
#include <kaboum/robot/robot_file.h>

#include <optional>
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

/// A shape as robots have it.
robot::Geometry geometry_of(const SimpleShape& shape);

/// Formats of robots that have spheres, capsules and boxes as collision shapes.
enum class ShapeFormat { Urdf, Mjcf, Sdf };

/// By the extension: .urdf; .xml and .mjcf; .sdf.
std::optional<ShapeFormat> shape_format_of(const std::string& file);

/// The robot with these shapes as the collision shapes of all links whose shapes they hold. Where
/// the robot is in the format, its text is edited: all else stays; else it is written anew, as MJCF
/// or SDF. A capsule in a URDF is a <capsule> where the file is one of 1.1 or 1.2, before a
/// <cylinder> and two <sphere> elements, which every reader knows.
/// @param choice  the shapes that they stand for
/// @param file    to be written: names of meshes for drawing are made relative to it
/// @throws Error{InvalidInput} where a URDF is wanted of a robot that is none, and as
///   robot::mjcf_with_shapes
robot::ModelText text_of_shapes(ShapeFormat format, const robot::RobotFile& robot,
                                const robot::ShapeChoice& choice,
                                const certify::CertifiedBodies& bodies, const SimpleShapes& shapes,
                                const std::string& parameters, const std::string& file);

}  // namespace kaboum::robot_folder
