#pragma once

#include <kaboum/certify/cache_folder.h>
#include <kaboum/certify/robot.h>
#include <kaboum/robot/link_body.h>

#include <optional>
#include <string>
#include <vector>

// Certified sets of links kept between runs: deciding what many bodies hold takes longer than all
// else where the meshes' sets are known. Internal to kaboum_certify: what is read becomes a claim.
namespace kaboum::certify {

/// A link's set to be: what it depends on.
struct LinkCase {
  const std::vector<robot::LinkBody>& bodies;  ///< as they are placed
  const LinkCertificate& certificate;
  const geom::Provenance& claims;  ///< that the set is to make; its distance apart
};

class LinkCache {
 public:
  /// @param folder  null: nothing is kept
  LinkCache(const CacheFolder* folder, const LinkCase& link);

  /// The set of an earlier run for the same bodies and claims.
  /// @param flaw  becomes the reason why a file that is there is not used, else empty.
  [[nodiscard]] std::optional<CertifiedLink> find(std::string& flaw) const;

  /// Keeps it, unless it was made in no time.
  void store(const CertifiedLink& made) const;

 private:
  const CacheFolder* folder_;  // null: nothing is kept
  LinkCase link_;
  std::string key_;
};

}  // namespace kaboum::certify
