#pragma once

#include <set>
#include <string>

namespace kaboum::io {

/// The text as a name for a file that every system and URI takes: what is no letter, digit, '-',
/// '_' or '.' becomes '_'. Never empty, never hidden.
std::string plain_file_name(const std::string& wish);

/// Names for files, none of them twice, whatever the case of its letters.
class FileNames {
 public:
  /// A plain name like the wish; the same for the same calls in the same order.
  std::string unique(const std::string& wish);
  /// A name that is not to be given.
  void reserve(const std::string& name);

 private:
  std::set<std::string> taken_;
};

}  // namespace kaboum::io
