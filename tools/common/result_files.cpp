// Names of the files of one result or a series, and writing all or none of them.

#include "result_files.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

namespace kaboum::tools {
namespace {

constexpr std::string_view kCountInName = "{vertices}";

}  // namespace

void write_together(const std::vector<std::pair<std::string, std::function<void()>>>& files) {
  std::vector<std::string> written;
  try {
    for (const auto& [file, write] : files) {
      if (file.empty()) continue;
      write();
      written.push_back(file);
    }
  } catch (...) {
    for (const std::string& file : written) {
      std::error_code ignored;
      if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
    }
    throw;
  }
}

std::vector<std::string> level_files(const std::string& name,
                                     const std::vector<std::size_t>& counts) {
  const bool named = name.find(kCountInName) != std::string::npos;
  if (counts.size() > 1 && !named && !name.empty())
    throw Error(ErrorCode::InvalidArgument,
                "several numbers of --vertices need {vertices} in the output's name, as in "
                "part-{vertices}.ply, not " +
                    name);
  if (counts.empty() && named)
    throw Error(ErrorCode::InvalidArgument,
                "{vertices} in the output's name needs --vertices: " + name);
  if (counts.empty()) return {name};
  std::vector<std::string> files;
  for (const std::size_t count : counts) {
    std::string file = name;
    for (std::size_t at = 0; (at = file.find(kCountInName, at)) != std::string::npos;)
      file.replace(at, kCountInName.size(), std::to_string(count));
    files.push_back(file);
  }
  return files;
}

}  // namespace kaboum::tools
