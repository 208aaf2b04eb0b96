#pragma once

#include <kaboum/plan/model.h>

#include <string>

namespace kaboum::plan {

/// Where the databases know less than could be concluded: the first such construct of the model, as
/// "the entries of Kx (...)"; empty if they lose nothing, so that a search without a plan is a
/// proof. Errs on the side of naming one.
std::string lost_knowledge(const Model& model);

/// The same of sets of possible worlds: only effects that hang on what is known, not on the world.
std::string lost_in_worlds(const Model& model);

}  // namespace kaboum::plan
