#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kaboum::test {

/// The mesh files below a folder, by their extensions, sorted; none where there is no such folder.
std::vector<std::string> mesh_files(const std::filesystem::path& directory);

}  // namespace kaboum::test
