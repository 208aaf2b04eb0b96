#pragma once

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "task/knowledge.h"

namespace kaboum::plan {

/// States seen by a search, each once, with the step that led there. Of long states only the words
/// are held that differ from the first one's: most fluents of a large task never change.
class DifferenceStore {
 public:
  /// Holds the first state, as number 0.
  DifferenceStore(const Word* first, Index words);

  /// The state's number, and whether it is new.
  /// @param state  the parent's, but for what its log tells.
  std::pair<Index, bool> insert(const Knowledge& state, Index parent, Index step);

  /// The state's words, until another is read.
  const Word* read(Index state);
  [[nodiscard]] std::uint64_t hash(Index state) const { return entries_[state].hash; }

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  [[nodiscard]] std::size_t bytes() const;
  /// What it takes besides, for a while, when it next grows, if that is near.
  [[nodiscard]] std::size_t growth() const;

  /// Steps from the first state to `state`.
  [[nodiscard]] std::vector<Index> path(Index state) const;

 private:
  struct Entry {
    std::uint64_t hash;
    std::uint64_t record;  ///< its place in `chunks_`
    Index length;          ///< of the record
    Index parent;
    Index step;
  };

  [[nodiscard]] const Word* record(const Entry& e) const {
    return chunks_[e.record / chunk_].get() + e.record % chunk_;
  }
  void encode(const Knowledge& state, const Entry& parent);
  std::uint64_t keep_record();
  void grow();

  std::size_t words_;
  bool whole_;         ///< records are the states themselves
  std::size_t chunk_;  ///< words in each; no record straddles two
  std::vector<std::unique_ptr<Word[]>> chunks_;
  std::uint64_t used_ = 0;
  std::deque<Entry> entries_;  ///< in chunks as well: memory is never held twice while they grow
  std::vector<Index> table_;   ///< open addressing
  std::vector<Word> first_, at_hand_, record_;
  std::vector<Index> changed_;
  Index read_ = 0;
};

}  // namespace kaboum::plan
