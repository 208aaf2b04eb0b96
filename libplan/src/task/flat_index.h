#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "task/numbering.h"

namespace kaboum::plan {

/// Numbers by hash: one flat table with open addressing.
class FlatIndex {
 public:
  FlatIndex() : slots_(1U << 10U) {}

  /// The number with this hash for which `same(number)` holds; kNone if there is none.
  template <class Same>
  [[nodiscard]] Index find(std::uint64_t hash, const Same& same) const {
    const std::uint32_t tag = tag_of(hash);
    for (std::size_t s = tag & (slots_.size() - 1); slots_[s].number != kNone;
         s = (s + 1) & (slots_.size() - 1))
      if (slots_[s].tag == tag && same(slots_[s].number)) return slots_[s].number;
    return kNone;
  }
  /// @pre it is not there.
  void insert(std::uint64_t hash, Index number) {
    if ((size_ + 1) * 4 > slots_.size() * 3) grow();
    ++size_;
    put({tag_of(hash), number});
  }
  /// Most bytes for one more number, where the table has just grown.
  static constexpr std::size_t kBytesEach = 24;

 private:
  struct Slot {
    std::uint32_t tag = 0;
    Index number = kNone;
  };
  static std::uint32_t tag_of(std::uint64_t hash) {
    return static_cast<std::uint32_t>(hash ^ (hash >> 32U));
  }
  void put(Slot slot) {
    std::size_t s = slot.tag & (slots_.size() - 1);
    while (slots_[s].number != kNone) s = (s + 1) & (slots_.size() - 1);
    slots_[s] = slot;
  }
  void grow() {
    std::vector<Slot> old(slots_.size() * 2);
    old.swap(slots_);
    for (const Slot& s : old)
      if (s.number != kNone) put(s);
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace kaboum::plan
