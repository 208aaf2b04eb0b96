#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "search/state_store.h"
#include "task/solve_limits.h"
#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// Worlds of one component and sets of them, each once.
class WorldSets {
 public:
  explicit WorldSets(const WorldTask::Component& component)
      : words_(component.words), worlds_(component.words) {}

  Index world(const Word* contents);
  /// The set of these worlds, sorted in place. @pre not empty.
  Index set(std::vector<Index>& worlds);

  struct Members {
    const Index* first;
    Index count;
    [[nodiscard]] const Index* begin() const { return first; }
    [[nodiscard]] const Index* end() const { return first + count; }
  };
  [[nodiscard]] Members members(Index set) const {
    return {elements_.data() + begins_[set], static_cast<Index>(begins_[set + 1] - begins_[set])};
  }
  /// All worlds so far are numbered below this.
  [[nodiscard]] Index size() const { return static_cast<Index>(worlds_.size()); }
  [[nodiscard]] const Word* contents(Index world) const { return worlds_[world]; }
  /// Bits that are 1 in all, in some, worlds of a set.
  [[nodiscard]] const Word* in_all(Index set) const { return bits_.data() + set * 2 * words_; }
  [[nodiscard]] const Word* in_some(Index set) const { return in_all(set) + words_; }
  [[nodiscard]] Index words() const { return words_; }
  [[nodiscard]] std::size_t bytes() const {
    return worlds_.bytes() + elements_.capacity() * sizeof(Index) +
           bits_.capacity() * sizeof(Word) + (begins_.capacity() + table_.size()) * sizeof(Index);
  }

 private:
  void grow();
  [[nodiscard]] std::uint64_t hash(const Index* worlds, std::size_t count) const;

  Index words_;
  StateStore worlds_;
  std::vector<Index> elements_;
  std::vector<std::size_t> begins_ = {0};
  std::vector<Word> bits_;
  std::vector<Index> table_ = std::vector<Index>(256, kNone);
};

/// Whether all literals are known at the start and contradict the constraint.
bool is_contradicted(const WorldTask& task, const Constraint& c);

/// The worlds that a component's initial constraints allow. nullopt: more than `most`.
/// @throws Error{InvalidInput} if there are none.
std::optional<std::vector<Index>> initial_worlds(const WorldTask& task, Index component,
                                                 std::size_t most, WorldSets& sets, Limits& limits);

}  // namespace kaboum::plan::worlds
