#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "task/formula.h"
#include "task/knowledge.h"

namespace kaboum::plan {

/// Effects that happen together: the condition, then deletions, then additions, then sensing.
struct ConditionalEffect {
  Formula condition = kTrue;
  BitTest test;  ///< the condition as one, if its mask is not 0
  std::vector<Change> deletions;
  std::vector<Change> additions;
  std::vector<Change> sensing;
  /// Additions that are direct writes (no Kx groups or exclusions concerned), in their order.
  struct MaskedWrite {
    Index word;
    Word mask;
    Word bits;
  };
  std::vector<MaskedWrite> writes;
  std::vector<Change> direct;  ///< what the writes are made of: for analysis
  /// A handle's term takes the value that a term or call has before the action, or a handle that is
  /// given; after the writes, in their order. kNone: it becomes unknown.
  struct Transfer {
    Index fluent;
    Index operand;
  };
  std::vector<Transfer> transfers;
};

struct GroundAction {
  Index schema = 0;
  std::vector<Index> arguments;
  std::int64_t cost = 1;
  Formula precondition = kTrue;
  std::vector<ConditionalEffect> effects;
  std::vector<Index> lets;       ///< calls whose values the precondition gives names to
  bool conditions_call = false;  ///< a condition of an effect calls an external function
  bool asks = false;  ///< an external function is asked about the state: put off where wished
  /// How often `Task::decide` found it possible, and not.
  std::uint32_t granted = 0, refused = 0;
};

}  // namespace kaboum::plan
