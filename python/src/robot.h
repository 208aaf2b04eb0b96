#pragma once

#include <kaboum/certify/mesh_options.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/robot_folder/certified_folder.h>

#include <memory>

#include "arguments.h"

/// Robots that Python holds.
namespace kaboum::python {

struct RobotValue {
  std::shared_ptr<const robot::RobotFile> file;
};

/// A CertifiedRobot, and the robot that it is of.
struct CertifiedValue {
  certify::CertifiedRobot made;
  std::shared_ptr<const robot::RobotFile> file;
  std::vector<std::string> notes;
  std::shared_ptr<const certify::RobotRequest> request = nullptr;
  std::vector<double> seconds = {};  ///< of each mesh, by the clock [s]
};

/// A Robot, or the name of its file.
/// @param motions  what is asked of it
/// @throws as robot::read_robot
RobotValue robot_of(const py::object& value, const char* argument,
                    robot::Motions motions = robot::Motions::All);

/// Options of a set that a robot's links can have: its file states their scales and frames.
std::vector<Option<certify::SetOptions>> link_options();

/// Names, or None for all.
std::vector<std::string> names_given(const py::object& names);
/// A dict of links' names and lengths.
certify::LinkEpsilons epsilons_of(const py::object& given);
/// What a robot's folder is to hold.
/// @param formats  one, several or none; a loader sets what these do not
robot_folder::FolderOptions folder_options_of(const std::string& folder, const py::object& formats,
                                              const std::optional<std::string>& loader,
                                              const std::optional<std::string>& mesh_prefix);
py::dict dict_of(const robot_folder::WrittenRobot& written, const std::vector<std::string>& notes);
/// Options of a mesh that a robot's meshes can have: they are enclosed.
std::vector<Option<certify::MeshOptions>> link_mesh_options();

}  // namespace kaboum::python
