#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

// Packages that xacro files name by $(find NAME). Internal to kaboum_robot_io.
namespace kaboum::robot {

/// Packages that a xacro file, and what it includes, name.
struct XacroPackages {
  std::vector<std::pair<std::string, std::filesystem::path>> found;  ///< name, folder
  std::map<std::string, std::string> missing;  ///< name: "robot.xacro:3", where it is named first
};

/// Those of $(find NAME) and find('NAME') in the file, in files that it includes, as far as their
/// names can be told, and in all xacro files of packages that were found; looked up as meshes'
/// packages are. Nothing where a file cannot be read.
XacroPackages packages_of_xacro(const std::filesystem::path& file,
                                const std::vector<std::string>& places);

/// Folders in which xacro finds packages, removed at the end of the scope: an ament prefix, with a
/// Python module that reads it where none is installed.
class PackageView {
 public:
  /// @throws Error{OutputFailed} where no folder can be made
  explicit PackageView(const XacroPackages& packages);
  PackageView(const PackageView&) = delete;
  PackageView& operator=(const PackageView&) = delete;
  ~PackageView();

  /// This process's environment, with these packages before all others.
  [[nodiscard]] const std::vector<std::string>& environment() const { return environment_; }

 private:
  std::filesystem::path folder_;  ///< empty: none is needed
  std::vector<std::string> environment_;
};

}  // namespace kaboum::robot
