// Files of a robot that are there as an earlier run has written them.

#include "written_files.h"

#include <fcntl.h>
#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/io/mesh_io.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "KABOUM-ROBOT 1";
/// Begins the names of files that say that a program is writing.
constexpr std::string_view kMark = ".kaboum-";

bool has_mark(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().starts_with(kMark)) return true;
  return false;
}

/// The names of what is in a folder, sorted.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    out.push_back(entry.path().filename().string());
  std::ranges::sort(out);
  return out;
}

/// Whether somebody has locked the folder; where file systems have no locks, nobody has.
bool is_locked(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

std::string line(const std::string& file, std::string_view bytes) {
  return sha256({bytes.data(), bytes.size()}).append(" ").append(file).append("\n");
}

std::string joined(const std::map<std::string, std::string>& state) {
  std::string out;
  for (const auto& [place, lines] : state) out += lines;
  return out;
}

}  // namespace

void PartsHash::add(std::string_view part) { hashes_ += sha256({part.data(), part.size()}); }

std::string PartsHash::hash() const { return sha256(hashes_); }

/// A line for each file.
/// @throws Error when one cannot be read
std::string WrittenFiles::state_of(const std::string& place) const {
  std::string out;
  const auto add = [&](const std::string& file) {
    const std::vector<char> bytes = io::read_file(folder_ / file);
    out += line(file, {bytes.data(), bytes.size()});
  };
  std::error_code error;
  if (!fs::is_directory(folder_ / place, error)) {
    add(place);
  } else {
    for (const std::string& name : names_in(folder_ / place))
      add(std::string(place).append("/").append(name));
  }
  return out;
}

bool WrittenFiles::are_there(const std::vector<std::string>& places) const {
  std::string flaw;  // all is written again
  const std::optional<std::string> known = cache_.find(kKind, key_, flaw);
  if (!known || has_mark(folder_)) return false;
  std::map<std::string, std::string> now;
  try {
    for (const std::string& place : places) now.emplace(place, state_of(place));
  } catch (const Error&) {  // there is one that cannot be read
    return false;
  }
  return joined(now) == *known;
}

void WrittenFiles::note_written(const std::string& place) {
  is_sure_ = is_sure_ && is_locked(folder_);
  if (is_sure_) noted_.emplace(place, state_of(place));
}

void WrittenFiles::note(const std::string& file, std::string_view bytes) {
  noted_.emplace(file, line(file, bytes));
}

void WrittenFiles::remember() const {
  if (is_sure_) cache_.store(kKind, key_, joined(noted_));
}

}  // namespace kaboum::robot_folder
