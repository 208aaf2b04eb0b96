#include "support/mesh_files.h"

#include <kaboum/io/mesh_io.h>

#include <algorithm>

namespace kaboum::test {

std::vector<std::string> mesh_files(const std::filesystem::path& directory) {
  std::vector<std::string> files;
  if (!std::filesystem::is_directory(directory)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    if (entry.is_regular_file() && io::format_from_name(entry.path().extension().string()))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace kaboum::test
