// Novelty of one and of two facts, in a hash table of rows of bits.
#include "search/novelty.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

std::size_t slot_of(std::uint64_t key, std::size_t slots) {
  key *= 0x9e3779b97f4a7c15ULL;
  return (key ^ (key >> 29U)) & (slots - 1);
}

}  // namespace

Novelty::Novelty(Index facts, std::size_t most_bytes)
    : facts_(facts),
      row_blocks_((std::uint64_t{facts} + 63) / 64),
      most_blocks_(most_bytes / sizeof(Block)),
      blocks_(1U << 12U, Block{0, 0}) {}

void Novelty::grow() {
  std::vector<Block> larger(blocks_.size() * 2, Block{0, 0});
  for (const Block& b : blocks_) {
    if (b.key == 0) continue;
    std::size_t slot = slot_of(b.key, larger.size());
    while (larger[slot].key != 0) slot = (slot + 1) & (larger.size() - 1);
    larger[slot] = b;
  }
  blocks_ = std::move(larger);
}

std::uint64_t& Novelty::others(std::uint64_t key) {
  if ((size_ + 1) * 4 > blocks_.size() * 3) grow();
  std::size_t slot = slot_of(key, blocks_.size());
  while (blocks_[slot].key != key && blocks_[slot].key != 0)
    slot = (slot + 1) & (blocks_.size() - 1);
  if (blocks_[slot].key == 0) {
    blocks_[slot].key = key;
    ++size_;
  }
  return blocks_[slot].others;
}

/// @return whether one of the pairs is new.
bool Novelty::put_pairs(std::uint64_t row, const std::vector<Index>& present) {
  bool fresh = false;
  for (auto p = present.begin(); p != present.end();) {
    const Index block = *p / 64;
    std::uint64_t bits = 0;
    for (; p != present.end() && *p / 64 == block; ++p) bits |= std::uint64_t{1} << (*p % 64);
    std::uint64_t& had = others(row * row_blocks_ + block + 1);
    fresh = fresh || (bits & ~had) != 0;
    had |= bits;
  }
  return fresh;
}

int Novelty::of(Index state_class, const std::vector<Index>& fresh,
                const std::vector<Index>& present) {
  if (state_class >= had_.size()) had_.resize(state_class + 1);
  std::vector<std::uint64_t>& had = had_[state_class];
  if (had.empty()) had.assign(row_blocks_, 0);
  int novelty = 3;
  for (const Index f : fresh) {
    std::uint64_t& word = had[f / 64];
    const std::uint64_t bit = std::uint64_t{1} << (f % 64);
    if ((word & bit) == 0) novelty = 1;
    word |= bit;
  }
  if (size_ * 2 >= most_blocks_ || fresh.size() * present.size() > kMostPairs) return novelty;
  for (const Index f : fresh)
    if (put_pairs(state_class * facts_ + f, present)) novelty = std::min(novelty, 2);
  return novelty;
}

}  // namespace kaboum::plan
