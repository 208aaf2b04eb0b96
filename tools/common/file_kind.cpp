// Kinds of files by their names.

#include "file_kind.h"

#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/sphere_file.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "files.h"

namespace kaboum::tools {

FileKind kind_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  constexpr std::array kRobots{".urdf", ".xacro", ".mjcf", ".xml", ".sdf"};
  if (robot::is_sphere_file(path)) return FileKind::Spheres;
  if (std::ranges::find(kRobots, extension) != kRobots.end()) return FileKind::Robot;
  if (is_folder(path) || io::format_from_name(extension)) return FileKind::Mesh;
  return FileKind::Other;
}

const char* in_words(FileKind kind) {
  switch (kind) {
    case FileKind::Spheres:
      return "a file of spheres";
    case FileKind::Robot:
      return "a robot";
    case FileKind::Mesh:
      return "a mesh or a set of bodies";
    case FileKind::Other:
      break;
  }
  return "a file of another kind";
}

}  // namespace kaboum::tools
