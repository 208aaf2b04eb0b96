// A hash table of states that are held as differences.
#include "search/difference_store.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan {
namespace {

constexpr std::size_t kLong = 32;                      // words: shorter states are held whole
constexpr std::size_t kChunk = std::size_t{1} << 13U;  // words

}  // namespace

DifferenceStore::DifferenceStore(const Word* first, Index words)
    : words_(words),
      whole_(words <= kLong),
      chunk_(std::max(kChunk, 2 * words_)),
      table_(1U << 10U, kNone),
      first_(first, first + words),
      at_hand_(first_) {
  chunks_.push_back(std::make_unique_for_overwrite<Word[]>(chunk_));
  if (whole_) record_ = first_;
  const std::uint64_t hash = Knowledge::hash_of(first, words);
  entries_.push_back({hash, keep_record(), static_cast<Index>(record_.size()), kNone, 0});
  table_[hash & (table_.size() - 1)] = 0;
}

/// A place and a content for each word that differs from the first state's, in order: the parent's,
/// and what has been written to since.
void DifferenceStore::encode(const Knowledge& state, const Entry& parent) {
  const Word* const words = state.words();
  if (whole_) {
    record_.assign(words, words + words_);
    return;
  }
  changed_.clear();
  for (const auto& [place, before] : state.log()) changed_.push_back(place);
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  record_.clear();
  const Word* p = record(parent);
  const Word* const end = p + parent.length;
  const auto keep_before = [&](Word place) {
    for (; p != end && p[0] < place; p += 2) record_.insert(record_.end(), p, p + 2);
  };
  for (const Index place : changed_) {
    keep_before(place);
    if (p != end && p[0] == place) p += 2;
    if (words[place] == first_[place]) continue;
    record_.push_back(place);
    record_.push_back(words[place]);
  }
  keep_before(words_);
}

std::uint64_t DifferenceStore::keep_record() {
  const std::size_t left = chunks_.size() * chunk_ - used_;
  if (record_.size() > left) {
    used_ = chunks_.size() * chunk_;
    chunks_.push_back(std::make_unique_for_overwrite<Word[]>(chunk_));
  }
  const std::uint64_t at = used_;
  if (!record_.empty()) std::copy(record_.begin(), record_.end(), &chunks_.back()[at % chunk_]);
  used_ += record_.size();
  return at;
}

std::pair<Index, bool> DifferenceStore::insert(const Knowledge& state, Index parent, Index step) {
  if ((entries_.size() + 1) * 4 > table_.size() * 3) grow();
  encode(state, entries_[parent]);
  const std::uint64_t hash = state.hash();
  std::size_t slot = hash & (table_.size() - 1);
  for (; table_[slot] != kNone; slot = (slot + 1) & (table_.size() - 1)) {
    const Entry& e = entries_[table_[slot]];
    if (e.hash == hash && e.length == record_.size() &&
        std::equal(record_.begin(), record_.end(), record(e)))
      return {table_[slot], false};
  }
  if (entries_.size() == kNone - 1) throw Error(ErrorCode::LimitReached, "more than 2^32 states");
  const auto number = static_cast<Index>(entries_.size());
  entries_.push_back({hash, keep_record(), static_cast<Index>(record_.size()), parent, step});
  table_[slot] = number;
  return {number, true};
}

const Word* DifferenceStore::read(Index state) {
  const Entry& e = entries_[state];
  const Word* const r = record(e);
  if (whole_) return r;
  if (state == read_) return at_hand_.data();
  const Entry& before = entries_[std::exchange(read_, state)];
  const Word* const b = record(before);
  for (Index i = 0; i < before.length; i += 2) at_hand_[b[i]] = first_[b[i]];
  for (Index i = 0; i < e.length; i += 2) at_hand_[r[i]] = r[i + 1];
  return at_hand_.data();
}

std::size_t DifferenceStore::bytes() const {
  return chunks_.size() * chunk_ * sizeof(Word) + entries_.size() * sizeof(Entry) +
         table_.size() * sizeof(Index);
}

std::size_t DifferenceStore::growth() const {
  constexpr std::size_t kNear = 1U << 14U;
  return (entries_.size() + kNear) * 4 > table_.size() * 3 ? 2 * table_.size() * sizeof(Index) : 0;
}

std::vector<Index> DifferenceStore::path(Index state) const {
  std::vector<Index> steps;
  for (; entries_[state].parent != kNone; state = entries_[state].parent)
    steps.push_back(entries_[state].step);
  return {steps.rbegin(), steps.rend()};
}

void DifferenceStore::grow() {
  std::vector<Index> larger(table_.size() * 2, kNone);
  for (Index i = 0; i < entries_.size(); ++i) {
    std::size_t slot = entries_[i].hash & (larger.size() - 1);
    while (larger[slot] != kNone) slot = (slot + 1) & (larger.size() - 1);
    larger[slot] = i;
  }
  table_ = std::move(larger);
}

}  // namespace kaboum::plan
