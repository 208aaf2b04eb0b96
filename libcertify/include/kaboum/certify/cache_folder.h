#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::certify {

/// Results kept between runs, by the hash of all that they depend on. An entry is a file that is
/// written whole or not at all and says what it is, its own hash and its key's. So readers, writers
/// and whatever makes room may work in one folder at the same time, on several machines too,
/// without locks. What is damaged is not used.
class CacheFolder {
 public:
  /// An entry by its name and size; what is in it was not looked at.
  struct Entry {
    std::filesystem::path path;
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type used;  ///< when it was last stored or found
  };

  /// @param folder  empty: nothing is kept
  explicit CacheFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// $KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum; empty where there is none of
  /// these.
  static std::filesystem::path default_folder();
  /// $KABOUM_CACHE_SIZE, such as 500M or 2G, else 4 GiB. [bytes]
  /// @throws Error{InvalidArgument} when the variable is no size
  static std::uintmax_t size_limit();

  /// Content stored under the key's hash (SHA-256, hexadecimal), whose entry counts as used now.
  /// @param kind  one line that names the format of what is stored
  /// @param flaw  becomes the reason why an entry that is there is not used, else empty.
  [[nodiscard]] std::optional<std::string> find(std::string_view kind, const std::string& key,
                                                std::string& flaw) const;

  /// Does nothing when the folder cannot be written. Now and then, at one of 64 keys, makes room as
  /// `prune(size_limit())`.
  void store(std::string_view kind, const std::string& key, std::string_view content) const;

  /// In the order of their last use. Files of other names are passed over.
  [[nodiscard]] std::vector<Entry> entries() const;

  /// Removes the entries that were not used for the longest time until the others are no larger
  /// than this, and what writers that ended long ago left behind. @return what was removed
  std::vector<Entry> prune(std::uintmax_t most) const;

  /// Why an entry is damaged; empty: it is whole. Which input and options it is of is looked at by
  /// who uses it.
  static std::string flaw_of(const Entry& entry);
  /// Kind that an entry states, "KABOUM-SET 3"; empty: nothing.
  static std::string kind_of(const Entry& entry);

 private:
  std::filesystem::path folder_;
};

}  // namespace kaboum::certify
