#pragma once

#include <kaboum/certify/robot.h>
#include <kaboum/robot_folder/robot_writer.h>

namespace kaboum::robot_folder {

/// The folder of a robot whose links have certified convex bodies: `bodies/MESH/...` as STL or OBJ,
/// `links/LINK.glb`, URDF and other formats (RobotFolder).
/// @param writer  after RobotWriter::plan with the meshes of the robot's request; of part "bodies"
/// @param cache   what was written is remembered there, so that it is left alone the next time;
///   null: all is written
/// @throws Error{OutputFailed}; nothing but complete files is left behind.
void write_certified(RobotWriter& writer, const certify::CertifiedRobot& made,
                     const certify::CacheFolder* cache, const FileNote& note);

/// Files of a robot that was written.
struct WrittenRobot {
  std::vector<std::string> documents;  ///< that hold the robot; the URDF is the first
  std::vector<std::string> links;      ///< containers, relative to the folder
  std::vector<std::string> stale;      ///< RobotFolder::stale
};

/// Writes a certified robot into a folder: names are planned, then as write_certified.
/// @param options    its shapes are taken from the certificate
/// @param documents  others that hold something of the robot: extension, text
/// @throws as RobotWriter, RobotWriter::plan and write_certified
WrittenRobot write_robot(const std::string& folder, const robot::RobotFile& robot,
                         const certify::CertifiedRobot& made, FolderOptions options,
                         const std::vector<std::pair<std::string, std::string>>& documents = {},
                         const certify::CacheFolder* cache = nullptr, const FileNote& note = {});

}  // namespace kaboum::robot_folder
