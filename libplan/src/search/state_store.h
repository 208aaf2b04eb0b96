#pragma once

#include <kaboum/base/error.h>

#include <cstring>
#include <memory>
#include <vector>

#include "task/layout.h"

namespace kaboum::plan {

/// States seen by a search, each once, with the step that led there. Contents lie in chunks that
/// never move; a flat table of 32-bit numbers with open addressing finds them.
class StateStore {
 public:
  explicit StateStore(Index words) : words_(words), table_(1U << 10U, kNone) {}

  struct Link {
    Index parent;
    Index step;
  };

  /// The state's number, and whether it is new.
  std::pair<Index, bool> insert(const Word* state, std::uint64_t hash, Index parent, Index step) {
    if ((size_ + 1) * 4 > table_.size() * 3) grow();
    std::size_t slot = hash & (table_.size() - 1);
    while (table_[slot] != kNone) {
      if (equal((*this)[table_[slot]], state)) return {table_[slot], false};
      slot = (slot + 1) & (table_.size() - 1);
    }
    if (size_ == kNone - 1) throw Error(ErrorCode::LimitReached, "more than 2^32 states");
    if (size_ % kChunk == 0) {
      contents_.push_back(std::make_unique<Word[]>(kChunk * words_));
      links_.push_back(std::make_unique<Link[]>(kChunk));
    }
    const auto number = static_cast<Index>(size_++);
    std::memcpy(at(number), state, words_ * sizeof(Word));
    link(number) = {parent, step};
    table_[slot] = number;
    return {number, true};
  }

  void prefetch(std::uint64_t hash) const {
    __builtin_prefetch(&table_[hash & (table_.size() - 1)]);
  }

  [[nodiscard]] const Word* operator[](Index state) const {
    return contents_[state / kChunk].get() + static_cast<std::size_t>(state % kChunk) * words_;
  }
  Link& link(Index state) { return links_[state / kChunk][state % kChunk]; }
  [[nodiscard]] const Link& link(Index state) const {
    return links_[state / kChunk][state % kChunk];
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const {
    return contents_.size() * kChunk * (words_ * sizeof(Word) + sizeof(Link)) +
           table_.size() * sizeof(Index);
  }

  /// What it takes besides, for a while, when it next grows, if that is near.
  [[nodiscard]] std::size_t growth() const {
    return (size_ + 4 * kChunk) * 4 > table_.size() * 3 ? 2 * table_.size() * sizeof(Index) : 0;
  }

  /// Steps from the first state to `state`.
  [[nodiscard]] std::vector<Index> path(Index state) const {
    std::vector<Index> steps;
    for (; link(state).parent != kNone; state = link(state).parent)
      steps.push_back(link(state).step);
    return {steps.rbegin(), steps.rend()};
  }

 private:
  static constexpr std::size_t kChunk = 1U << 12U;

  Word* at(Index state) {
    return contents_[state / kChunk].get() + static_cast<std::size_t>(state % kChunk) * words_;
  }
  [[nodiscard]] bool equal(const Word* a, const Word* b) const {
    for (Index i = 0; i < words_; ++i)
      if (a[i] != b[i]) return false;
    return true;
  }
  void grow();

  std::size_t words_;
  std::size_t size_ = 0;
  std::vector<std::unique_ptr<Word[]>> contents_;
  std::vector<std::unique_ptr<Link[]>> links_;
  std::vector<Index> table_;
};

}  // namespace kaboum::plan
