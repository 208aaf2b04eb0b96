#pragma once

#include <kaboum/certify/link_enclosures.h>
#include <kaboum/robot_folder/certified_folder.h>

namespace kaboum::robot_folder {

/// The folder of a robot whose links have enclosing meshes: `meshes/MESH.stl` or .obj, URDF and
/// other formats (RobotFolder). Meshes of which there is none stay as they are.
/// @param writer  after RobotWriter::plan with the meshes of the robot's request; of part "meshes"
/// @param cache   as write_certified
/// @throws Error{OutputFailed}; nothing but complete files is left behind.
void write_enclosed(RobotWriter& writer, const certify::LinkEnclosures& made,
                    const certify::CacheFolder* cache, const FileNote& note);

/// Writes a robot with enclosing meshes into a folder: names are planned, then as write_enclosed.
/// @param options  its shapes are those of the request
/// @param format   that was asked for: STL or OBJ
/// @throws as RobotWriter, RobotWriter::plan and write_enclosed
WrittenRobot write_robot(const std::string& folder, const robot::RobotFile& robot,
                         const certify::LinkEnclosures& made, FolderOptions options,
                         io::Format format, const certify::CacheFolder* cache = nullptr,
                         const FileNote& note = {});

}  // namespace kaboum::robot_folder
