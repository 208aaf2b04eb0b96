#pragma once

#include <vector>

#include "task/task.h"

namespace kaboum::plan {

/// Regression: what must hold before a step so that a condition holds after it.
///
/// The result is taken in the context of one state `before` in which the step was planned: which
/// conditional effects happen is fixed as there (and required), and where an update's result
/// depends on earlier knowledge (deletions, sensing, Kx propagation) that knowledge is required to
/// be as it was. All else is left open, so the condition describes many states: the partial states
/// that let equal sub-plans be shared.
class Regression {
 public:
  explicit Regression(Task& task) : task_(task), after_(task.layout()) {}

  /// The condition before `step` such that the step is possible and `condition` holds after it.
  Formula before(OperatorId step, Formula condition, const Word* before);

 private:
  void touch(Index fluent, bool plain);
  void touch_transfer(const ConditionalEffect::Transfer& t, bool happens, Formula condition);
  void touch_field(Word mask, Index word) { touched_[word] |= mask; }
  Formula rewrite(Formula f);
  [[nodiscard]] bool overlaps(Formula f) const;
  [[nodiscard]] bool reads_field(Formula f, const Fluent& fluent) const;
  void require_footprint(Index call, const Word* state, std::vector<Formula>& out);
  Formula freeze(Formula f, const Word* state);
  void require_as_before(const Fluent& fluent);
  void require_word(Index word);
  void require_read(Formula f);
  [[nodiscard]] std::vector<Index> tied_to(Index fluent) const;

  Task& task_;
  Knowledge after_;
  const Word* before_ = nullptr;
  std::vector<Word> touched_;
  std::vector<Formula> required_;
  bool open_ = false;
};

}  // namespace kaboum::plan
