#pragma once

#include <kaboum/plan/model.h>

#include <optional>
#include <span>
#include <vector>

#include "task/answer_tree.h"
#include "task/layout.h"

namespace kaboum::plan {

/// Thrown by a reader, through the host's function, that is to go no further.
struct ReadingStopped {};

/// Content of a fluent, where it is the same however what is sensed turns out; else kNone, and
/// `sensed` is the fluent to branch on.
Index settled_content(const Layout& layout, Index fluent, const Word* state, Index& sensed);

/// The reader that an external function is called with: notes what is read, or reads from notes.
class NotedReader final : public StateReader {
 public:
  /// @param state  null: an answer is confirmed, which may not read more than the notes say.
  /// @param named  objects: what is of others is not read, reading is stopped there; null: all is.
  NotedReader(const Layout& layout, const Word* state, Footprint& notes,
              const std::vector<Index>* named = nullptr)
      : layout_(layout), state_(state), notes_(notes), named_(named) {}

  /// The sensed fluent that was asked for, so that a branch must come first; kNone: none was.
  [[nodiscard]] Index sensed() const { return sensed_; }

  std::optional<Index> value(Index function, std::span<const Index> arguments) override;
  std::optional<bool> truth(Index predicate, std::span<const Index> arguments) override;

 private:
  Index read(Index fluent);

  const Layout& layout_;
  const Word* state_;
  Footprint& notes_;
  const std::vector<Index>* named_;
  Index sensed_ = kNone;
};

}  // namespace kaboum::plan
