#pragma once

#include <kaboum/plan/load.h>
#include <kaboum/plan/model.h>

#include "language/syntax.h"

namespace kaboum::plan {

/// Looks every name up and checks arity and types.
/// @throws Error{InvalidInput} at the first unknown name, wrong arity, wrong type, doubly declared
///         name, unbound external function, or entry that a database cannot hold.
Model resolve(const syntax::Document& document, const ExternalBindings& bindings);

}  // namespace kaboum::plan
