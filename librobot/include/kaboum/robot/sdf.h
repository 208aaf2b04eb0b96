#pragma once

#include <kaboum/robot/mjcf.h>

#include <string>
#include <string_view>

/// Robots as Gazebo and Drake describe them: SDFormat. <http://sdformat.org/spec>
namespace kaboum::robot {

/// A robot and what it weighs.
struct SdfRobot {
  Robot robot;
  Dynamics dynamics;
};

/// Robot of an SDF document with one model, of versions 1.4 to 1.12, and of what is nested in it:
/// links and joints of nested models are called as from outside, "arm::hand::palm". Joints that
/// mimic others follow them.
///
/// Link 0 is the world, below which every link is that no joint moves: where they stand in the
/// model. A joint whose frame is not that of its child has a link without shapes of its own. Ball,
/// universal, screw and gearbox joints are fixed where they are in the file, and
/// Robot::unmodelled says so. Planes are left out with a note.
/// @param name  appears in messages.
/// @throws Error{InvalidInput} naming the line where known: not well-formed; several models,
///   included ones; frames that do not exist or lead in a circle; height maps, polylines,
///   cones, images and parts of meshes.
SdfRobot parse_sdf(std::string_view text, const std::string& name);

/// The document with other collision elements, each with the pose and scale of the shape that it
/// stands for. All else stays; names of files are given by ShapeEdit::moved. Before SDF 1.8, which
/// has no capsules, a cylinder and two spheres stand for one.
/// @param text  that parse_sdf reads
/// @throws as parse_sdf
std::string sdf_with_shapes(std::string_view text, const std::string& name, const ShapeEdit& edit);

}  // namespace kaboum::robot
