#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli.h"

namespace kaboum::tools {

/// Results kept between runs: files named by a hash of everything that they depend on, in
/// $KABOUM_CACHE, else in the XDG cache directory. Entries are written whole or not at all, carry a
/// hash of themselves, and are ignored when it does not match; concurrent writers write the same.
class SetCache {
 public:
  struct Entry {
    std::vector<char> container;  ///< GLB
    Json report;
  };

  /// @param key  everything the result depends on.
  explicit SetCache(const std::string& key);

  [[nodiscard]] std::optional<Entry> find() const;
  /// Does nothing when the directory cannot be written.
  void store(const Entry& entry) const;

 private:
  std::filesystem::path path_;  ///< empty: no place for a cache
};

}  // namespace kaboum::tools
