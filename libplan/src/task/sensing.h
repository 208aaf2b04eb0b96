#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "task/knowledge.h"
#include "task/layout.h"

namespace kaboum::plan {

/// A sensed fluent whose value decides what the change does in this state; kNone: it does the same
/// for all.
Index undecided(const Layout& layout, const Change& change, const Word* state);

/// Fluents whose sensed value some query of the model reads, or Kx ties to one; ascending.
std::vector<Index> sensible_fluents(const Model& model, const Layout& layout);

}  // namespace kaboum::plan
