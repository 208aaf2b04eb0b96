#pragma once

#include <filesystem>
#include <system_error>

namespace kaboum::robot {

/// Whether there is a file that is no folder; no matter why not.
inline bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

}  // namespace kaboum::robot
