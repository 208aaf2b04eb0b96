#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::robot {

/// The files that a URDF's mesh reference may stand for, at least one: a path, absolute or relative
/// to the robot's file, also as file://, `package://NAME/rest`, or `model://NAME/rest` (Gazebo's,
/// looked up in the same way, and in the folders of its variables).
///
/// Packages are looked for, in this order, in the folders given, those of $ROS_PACKAGE_PATH, the
/// folders share/NAME of $AMENT_PREFIX_PATH, and the robot's folder and all above it. A folder is
/// the package when its package.xml has <name>NAME</name>, or when it is itself called NAME. Looked
/// at are the places themselves and the folders in them; in those given and of $ROS_PACKAGE_PATH
/// also the folders further below, to a depth of 5, as ROS does.
/// @throws Error{InvalidInput} saying where it was looked for.
std::vector<std::filesystem::path> find_mesh(const std::string& reference,
                                             const std::filesystem::path& robot,
                                             const std::vector<std::string>& packages);

/// The first of them.
/// @throws as find_mesh
std::filesystem::path resolve_mesh(const std::string& reference, const std::filesystem::path& robot,
                                   const std::vector<std::string>& packages);

/// The only one: a package's that is found with different contents is nobody's, since another
/// program may take the other one.
/// @throws as find_mesh; Error{InvalidInput} when files of different contents are found.
std::filesystem::path find_only_mesh(const std::string& reference,
                                     const std::filesystem::path& robot,
                                     const std::vector<std::string>& packages);

}  // namespace kaboum::robot
