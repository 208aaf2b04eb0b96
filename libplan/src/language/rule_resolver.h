#pragma once

#include <kaboum/plan/model.h>

#include "language/query_resolver.h"
#include "language/syntax.h"

namespace kaboum::plan {

/// Resolves the rules of derived predicates, and gives these their levels.
/// @throws Error{InvalidInput} at a head that does not fit its predicate, at a predicate that
///         depends on its own negation, and where not all is known.
void resolve_rules(const syntax::Document& document, const QueryResolver& queries, Model& model);

/// @pre the initial state is resolved
/// @throws Error{InvalidInput} at the first rule if some function has no value for some arguments.
void require_values(const syntax::Document& document, const Model& model);

}  // namespace kaboum::plan
