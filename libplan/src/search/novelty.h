#pragma once

#include <cstdint>
#include <vector>

#include "task/numbering.h"

namespace kaboum::plan {

/// What states have had so far, class by class: facts, and facts that came about beside others
/// [lipovetzky2017bfws].
class Novelty {
 public:
  static constexpr std::size_t kMostPairs = std::size_t{1} << 18U;

  /// @param most_bytes  that pairs may take: where half of it is in use, no further pair is new.
  Novelty(Index facts, std::size_t most_bytes);

  /// 1 if the class had no state with one of `fresh` so far, 2 if none with one of `fresh` besides
  /// one of `present`, else 3.
  /// Pairs are not looked at where they would be more than kMostPairs.
  /// @param fresh    among those present
  /// @param present  ascending is fastest
  int of(Index state_class, const std::vector<Index>& fresh, const std::vector<Index>& present);

  [[nodiscard]] std::size_t bytes() const {
    return blocks_.size() * sizeof(Block) + had_.size() * row_blocks_ * sizeof(std::uint64_t);
  }
  /// What it takes besides, for a while, when it next grows, if that is near.
  [[nodiscard]] std::size_t growth() const {
    return (size_ + kMostPairs) * 4 > blocks_.size() * 3 ? 2 * blocks_.size() * sizeof(Block) : 0;
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
