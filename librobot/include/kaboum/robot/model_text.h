#pragma once

#include <kaboum/robot/dynamics.h>

#include <string>
#include <vector>

/// Robots in the formats of simulators.
namespace kaboum::robot {

/// A robot as it is to be written: links' shapes have the sizes and poses that they get, and
/// Geometry::mesh is the name of the file as the text is to give it.
struct Model {
  Robot robot;
  Dynamics dynamics;
};

/// The text of a file.
struct ModelText {
  std::string text;
  std::vector<std::string> notes;  ///< what the format cannot say; one sentence each
};

/// The robot as MJCF, MuJoCo's format. <https://mujoco.readthedocs.io/en/2.2.2/XMLreference.html>
///
/// Every link is a body of its own, with its joint's frame and axis, its inertial where the robot
/// has one, and its collision shapes as geoms. Shapes for drawing are left out, since MuJoCo draws
/// geoms and reads neither COLLADA nor names of packages. The root stands still, as in URDF. A
/// joint that mimics another one is tied to it by an equality. Links that a joint moves against the
/// root's rigid part do not collide with it, as none collide that a joint joins elsewhere
/// (`filterparent`).
/// @throws as require_valid
ModelText to_mjcf(const Model& model);

/// The robot as SDF 1.9, Gazebo's format. <http://sdformat.org/spec?ver=1.9>
///
/// Every link stays, with its inertial where the robot has one; frames are those of the joints. A
/// root link that is called `world` and has no shape is the world; any other root is free. Names
/// that SDF keeps for itself, or has had for something else, are changed: `notes` says so.
/// @throws as require_valid
ModelText to_sdf(const Model& model);

}  // namespace kaboum::robot
