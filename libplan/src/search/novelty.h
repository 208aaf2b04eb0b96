#pragma once

#include <cstdint>
#include <vector>

#include "task/numbering.h"

namespace kaboum::plan {

/// What states have had so far, class by class: facts, and facts that came about beside others
/// [lipovetzky2017bfws].
class Novelty {
 public:
  /// @param most_bytes  that pairs may take: once half of it is in use, no further pair is new.
  Novelty(Index facts, std::size_t most_bytes);

  /// 1 if the class had no state with one of `fresh` so far, 2 if none with one of `fresh` besides
  /// one of `present`, else 3.
  /// @param fresh    among those present
  /// @param present  ascending is fastest
  int of(Index state_class, const std::vector<Index>& fresh, const std::vector<Index>& present);

  [[nodiscard]] std::size_t bytes() const {
    return blocks_.size() * sizeof(Block) + had_.size() * facts_ / 8;
  }

 private:
  /// Of one class and fact, 64 others that it came about beside.
  struct Block {
    std::uint64_t key;  ///< 0: none
    std::uint64_t others;
  };
  std::uint64_t& others(std::uint64_t key);
  bool put_pairs(std::uint64_t row, const std::vector<Index>& present);
  void grow();

  std::size_t facts_;
  std::uint64_t row_blocks_;
  std::size_t most_blocks_;
  std::vector<std::vector<std::uint64_t>> had_;  ///< facts, by class
  std::vector<Block> blocks_;                    ///< open addressing
  std::size_t size_ = 0;
};

}  // namespace kaboum::plan
