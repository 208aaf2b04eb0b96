#pragma once

#include <cstddef>
#include <string>

namespace kaboum::batch {

/// One of the parts that a batch is divided into for several machines. A file belongs to the same
/// part whatever other files there are, so that machines need not see them at the same time.
struct Shard {
  std::size_t number = 1;  ///< from 1
  std::size_t count = 1;

  /// Whether a file of this name belongs to it: by the name's hash.
  [[nodiscard]] bool has(const std::string& name) const;
};

/// "2/8". @throws Error{InvalidArgument}
Shard parse_shard(const std::string& text);

}  // namespace kaboum::batch
