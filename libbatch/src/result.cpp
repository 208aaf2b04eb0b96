// Results: whether they are there, which they are, how they get to their places.

#include "result.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <vector>

namespace kaboum::batch {
namespace {

/// Sorted. @throws fs::filesystem_error where it cannot be looked into
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
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
  try {
    for (const fs::path& file : files_in(result)) sum += size_of(file);
  } catch (const fs::filesystem_error&) {
    return 0;
  }
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
  } catch (const fs::filesystem_error&) {
    return {};
  }
}

std::vector<FileState> marks_of(const fs::path& result) {
  std::error_code error;
  if (!fs::is_directory(result, error))
    return fs::exists(result, error) ? std::vector{file_state(result)} : std::vector<FileState>();
  std::vector<FileState> marks;
  for (fs::directory_iterator at(result, error); !error && at != fs::directory_iterator();
       at.increment(error))
    if (at->path().extension() == ".urdf") marks.push_back(file_state(at->path()));
  std::ranges::sort(marks, {}, &FileState::path);
  return marks;
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::rename(from, to, error);
  if (error) throw Error(ErrorCode::OutputFailed, to.string() + ": " + error.message());
}

}  // namespace kaboum::batch
