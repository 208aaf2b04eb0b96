#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "task/layout.h"

namespace kaboum::plan {

/// The state that a model's initial entries describe.
/// @throws Error{InvalidInput} if they contradict each other.
std::vector<Word> initial_knowledge(const Model& model, const Layout& layout);

}  // namespace kaboum::plan
