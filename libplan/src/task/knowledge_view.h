#pragma once

#include <kaboum/plan/model.h>

#include <optional>

namespace kaboum::plan {

/// The model as its knowledge databases can keep it: an effect under a condition of the world
/// happens where that is known to hold, and may happen where it is not known to fail; initial
/// entries of Or are left out. What is known in the result is so in the model.
/// nullopt: the model has none of these.
std::optional<Model> knowledge_view(const Model& model);

}  // namespace kaboum::plan
