#pragma once

#include <zip.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "source.h"

namespace kaboum::io {

/// The parts of a package by the Open Packaging Conventions (ISO/IEC 29500-2): a zip archive in
/// memory. Internal to kaboum_io.
///
/// Part names are compared without case, as the conventions demand; a package with two parts of one
/// name is refused. What all parts read inflate to is bounded in proportion to the package.
class Package {
 public:
  /// @throws Error{InvalidInput} when the bytes are no zip archive or inconsistent.
  explicit Package(const Source& source);

  /// The bytes of a part, its checksum verified. A leading slash in `name` is passed over.
  /// @throws Error{InvalidInput}; Error{LimitReached} when it inflates out of proportion.
  std::string read(std::string_view name);

  /// Name of a part as compared: lower case, without leading slash.
  static std::string key(std::string_view name);
  /// Keys of all parts.
  [[nodiscard]] std::vector<std::string> parts() const;

  /// The part that the package's only relationship of `type` leads to.
  std::string target(std::string_view type);

 private:
  struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };

  const Source& source_;
  std::unique_ptr<zip_t, Discard> archive_;
  std::map<std::string, zip_uint64_t> entries_;
  std::uint64_t budget_;  ///< bytes that may still be inflated
};

}  // namespace kaboum::io
