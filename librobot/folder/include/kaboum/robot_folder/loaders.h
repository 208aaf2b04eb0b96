#pragma once

#include <kaboum/robot_folder/robot_writer.h>

#include <string>
#include <vector>

namespace kaboum::robot_folder {

/// A program that loads robots, and what it needs of their folders (docs/robots.md has the table).
struct Loader {
  const char* name;
  bool mjcf = false, sdf = false;  ///< formats that it reads
  bool package = false;            ///< meshes are named package://FOLDER/...
  const char* bodies = "stl";      ///< format of bodies' files
  bool declare_convex = false;
  double thickness = 0;  ///< least, of bodies [m]
};

/// MoveIt, MuJoCo, Gazebo, Bullet and Drake.
const std::vector<Loader>& loaders();

/// @throws Error{InvalidArgument} naming those that there are
const Loader& loader_of(const std::string& name);

/// "package://NAME" of a folder.
std::string package_prefix(const std::string& folder);

/// Adds a loader's needs where the options say nothing else: formats and prefix of meshes only
/// where none are stated.
void apply(const Loader& loader, const std::string& folder, FolderOptions& options);

}  // namespace kaboum::robot_folder
