#pragma once

#include <kaboum/plan/load.h>
#include <kaboum/plan/model.h>

#include "language/symbol_table.h"
#include "language/syntax.h"

namespace kaboum::plan {

/// Binds each external function to the host's, or to the document's table of values.
/// @return one per external of the model.
/// @throws Error{InvalidInput} at a malformed row, or a function bound to nothing.
std::vector<ExternalFunction> bind_externals(const syntax::Document& document,
                                             const ExternalBindings& bindings,
                                             const SymbolTable& symbols);

}  // namespace kaboum::plan
