#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli.h"

namespace kaboum::tools {

/// Results kept between runs: files named by a hash of everything that they depend on, in
/// $KABOUM_CACHE, else in the XDG cache directory. Entries are written whole or not at all; each
/// states the hash of its key and one of all its bytes, so that one that is damaged, or that lies
/// under another one's name, is not used. Concurrent writers write the same.
class SetCache {
 public:
  struct Entry {
    std::vector<char> container;  ///< GLB
    Json report;
  };

  /// @param key  everything the result depends on.
  explicit SetCache(const std::string& key);

  /// @param flaw  becomes the reason why a file that is there is not used, else empty.
  [[nodiscard]] std::optional<Entry> find(std::string& flaw) const;
  /// Does nothing when the directory cannot be written.
  void store(const Entry& entry) const;
  /// Of the entry; empty where there is no place for a cache.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::string key_;  // its hash
  std::filesystem::path path_;
};

}  // namespace kaboum::tools
