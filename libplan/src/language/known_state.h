#pragma once

#include <kaboum/plan/known_facts.h>
#include <kaboum/plan/model.h>

#include "language/syntax.h"

namespace kaboum::plan {

/// Declares the words of handles that are known as constants. Ones that are declared stay.
void declare_words(const KnownFacts& known, syntax::Document& document);

/// Takes what is known for the model's initial knowledge. @pre its words are constants.
/// @throws Error{InvalidInput} for names that the model does not have.
void start_from(const KnownFacts& known, Model& model);

}  // namespace kaboum::plan
