// Results: whether they are there, which they are, how they get to their places.

#include "result.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <vector>

namespace kaboum::batch {
namespace {

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, error))
    if (entry.is_regular_file(error)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> robots_in(const fs::path& folder) {
  std::vector<fs::path> robots;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".urdf") robots.push_back(entry.path());
  return robots;
}

std::string digest_of_file(const fs::path& file) { return io::sha256(io::read_file(file)); }

}  // namespace

std::uintmax_t size_of(const fs::path& result) {
  std::error_code error;
  if (!fs::is_directory(result, error)) {
    const std::uintmax_t size = fs::file_size(result, error);
    return error ? 0 : size;
  }
  std::uintmax_t sum = 0;
  for (const fs::path& file : files_in(result)) sum += size_of(file);
  return sum;
}

std::string digest_of(const fs::path& result) {
  std::error_code error;
  try {
    if (fs::is_regular_file(result, error)) return digest_of_file(result);
    if (!fs::is_directory(result, error)) return {};
    std::string names;
    for (const fs::path& file : files_in(result))
      names += digest_of_file(file) + " " + file.lexically_relative(result).generic_string() + "\n";
    return io::sha256(names);
  } catch (const Error&) {
    return {};
  }
}

bool is_there(const Job& job, const fs::path& result) {
  std::error_code error;
  return job.makes_folder() ? !robots_in(result).empty() : fs::exists(result, error);
}

void remove_result(const Job& job, const fs::path& result) {
  std::error_code error;
  if (!job.makes_folder())
    fs::remove(result, error);
  else
    for (const fs::path& robot : robots_in(result)) fs::remove(robot, error);
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::rename(from, to, error);
  if (error) throw Error(ErrorCode::OutputFailed, to.string() + ": " + error.message());
}

}  // namespace kaboum::batch
