#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace kaboum::robot {

/// Mesh files that a reference may stand for, or why there are none.
struct FoundMesh {
  std::vector<std::filesystem::path> files;
  std::string why;   ///< one clause, with what helps; where there are files, empty
  std::string what;  ///< the same in few words, without what helps
};

/// Where the folders of packages are, each looked for once.
class PackageFolders;

/// The mesh files that a robot refers to. A reference is a path, absolute or relative to the
/// robot's file, also as file://, `package://NAME/rest`, or `model://NAME/rest` (Gazebo's, looked
/// up in the same way, and in the folders of its variables).
///
/// Packages are looked for, in this order, in the folders given, those of $ROS_PACKAGE_PATH, the
/// folders share/NAME of $AMENT_PREFIX_PATH, and the robot's folder and all above it. A folder is
/// the package when its package.xml has <name>NAME</name>, or when it is itself called NAME,
/// which comes after the others of its place. Looked
/// at are the places themselves and the folders in them; in those given and of $ROS_PACKAGE_PATH
/// also the folders further below, to a depth of 5, as ROS does. This takes a while, so each
/// package is looked for once in the life of a value, which is for one thread at a time.
class MeshFiles {
 public:
  /// @param robot  the robot's file
  /// @param packages  folders that packages are looked for in, before all others
  MeshFiles(const std::filesystem::path& robot, const std::vector<std::string>& packages);
  ~MeshFiles();
  MeshFiles(MeshFiles&& other) noexcept;
  MeshFiles& operator=(MeshFiles&& other) noexcept;
  MeshFiles(const MeshFiles&) = delete;
  MeshFiles& operator=(const MeshFiles&) = delete;

  /// All files that a reference may stand for, in the order above.
  [[nodiscard]] FoundMesh look_for(const std::string& reference);

  /// The first of them.
  /// @throws Error{InvalidInput} saying where it was looked for.
  [[nodiscard]] std::filesystem::path first(const std::string& reference);

  /// The only one: a package's that is found with different contents is nobody's, since another
  /// program may take the other one.
  /// @throws as `first`; Error{InvalidInput} when files of different contents are found.
  [[nodiscard]] std::filesystem::path only(const std::string& reference);

 private:
  std::vector<std::filesystem::path> all(const std::string& reference);

  std::filesystem::path robot_;
  std::unique_ptr<PackageFolders> folders_;
};

/// The file of the model that an SDF <include> names: a file, or that of a folder which its
/// model.config names for the newest version up to 1.12, or model.sdf. Looked up as meshes are.
/// @param from  the file that has the <include>
/// @throws Error{InvalidInput} saying where it was looked for.
std::filesystem::path find_model(const std::string& uri, const std::filesystem::path& from,
                                 const std::vector<std::string>& packages);

/// A folder of a package, as MeshFiles looks for it; empty: there is none.
/// @param robot  the file that asks for it
std::filesystem::path find_package(const std::string& name, const std::filesystem::path& robot,
                                   const std::vector<std::string>& packages);

}  // namespace kaboum::robot
