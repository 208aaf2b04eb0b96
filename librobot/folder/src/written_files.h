#pragma once

#include <kaboum/certify/cache_folder.h>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// What an earlier run has written for the same robot and options, so that files that are there, as
/// they were written, need not be written again: safe writing of thousands of small files takes
/// longer than all else when nothing changed.
namespace kaboum::robot_folder {

/// SHA-256 of parts, told apart by where they end.
class PartsHash {
 public:
  void add(std::string_view part);
  [[nodiscard]] std::string hash() const;

 private:
  std::string hashes_;  // of the parts
};

/// What is in files, by their SHA-256. Places are relative to a folder: files, and folders of which
/// all files count.
class WrittenFiles {
 public:
  /// @param key  SHA-256 of all that the files' bytes depend on
  WrittenFiles(const certify::CacheFolder& cache, std::filesystem::path folder, std::string key)
      : cache_(cache), folder_(std::move(folder)), key_(std::move(key)) {}

  /// Whether exactly what was remembered is in these places, and no program is writing here, or was
  /// ended while it was.
  [[nodiscard]] bool are_there(const std::vector<std::string>& places) const;

  /// Notes what is in a place just written, where no other program can have written there: all take
  /// turns with the folder locked. Else nothing will be remembered.
  void note_written(const std::string& place);
  /// Notes what a file that is written holds.
  void note(const std::string& file, std::string_view bytes);
  /// Remembers what was noted.
  void remember() const;

 private:
  [[nodiscard]] std::string state_of(const std::string& place) const;

  const certify::CacheFolder& cache_;
  std::filesystem::path folder_;
  std::string key_;
  std::map<std::string, std::string> noted_;  // lines of a place
  bool is_sure_ = true;
};

}  // namespace kaboum::robot_folder
