#pragma once

#include <kaboum/certify/convex_set.h>

#include <filesystem>

namespace kaboum::certify {

/// Results kept between runs: files named by a hash of everything that they depend on (the
/// triangles as read, the file's hash, the request, the version). Entries are written whole or not
/// at all. Each states the hash of its key and one of all its bytes, and its container says what it
/// is of. So one that is damaged, or that lies under another one's name, is not used. Concurrent
/// writers write the same.
class SetCache {
 public:
  /// In $KABOUM_CACHE, else $XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum; empty where there is none
  /// of these: nothing is kept then.
  static std::filesystem::path default_folder();

  explicit SetCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Everything that a result depends on.
  struct Key {
    std::string hash;                      ///< SHA-256
    geom::Provenance origin;               ///< what the container says of itself; its claims apart
    std::optional<double> clearance = {};  ///< of a wrap, where one is covered [length]
    bool may_be_unwrapped = false;         ///< only where one is needed
    bool has_radii = false;                ///< bodies are not polytopes alone
  };
  static Key key_of(const geom::Mesh& mesh, const std::string& sha256, const SetRequest& request);
  /// @param mesh_hash  hash_of the mesh
  static Key key_of(const std::string& mesh_hash, const std::string& sha256,
                    const SetRequest& request);
  /// Hash of the triangles as read. Their bytes say more than a file's, which may refer to others,
  /// and than a reader's version.
  static std::string hash_of(const geom::Mesh& mesh);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// @param flaw  becomes the reason why a file that is there is not used, else empty.
  [[nodiscard]] std::optional<CertifiedSet> find(const Key& key, std::string& flaw) const;

  /// Does nothing when the folder cannot be written.
  void store(const Key& key, const CertifiedSet& set) const;

 private:
  std::filesystem::path folder_;
};

/// Set made by certify_set, now or in an earlier run.
struct FoundSet {
  CertifiedSet set;
  bool cached = false;
};

/// certify_set, unless the cache has the result.
/// @param cache  null: none.
std::optional<FoundSet> find_or_certify(const geom::Mesh& mesh, const std::string& sha256,
                                        const SetRequest& request, const SetCache* cache,
                                        const Hooks& hooks = {});

}  // namespace kaboum::certify
