#pragma once

#include <vector>

#include "language/s_expression.h"
#include "language/syntax.h"

namespace kaboum::plan {

/// Readers of PDDL's parts. All throw Error{InvalidInput} where something else is expected.
namespace pddl {

/// Item `i` of a list; `what` is for the message if there is none.
const SExpression& item(const SExpression& e, std::size_t i, const char* what);
syntax::Name name(const SExpression& e, const char* what);
/// Of a type; of (either a b) that of the union, which PddlParser declares.
syntax::Name type_name(const SExpression& e);
/// "a b - t c": items from `from` on.
std::vector<syntax::TypedVariable> typed(const SExpression& e, std::size_t from, bool variables);

syntax::Term term(const SExpression& e);
/// Inside K: an atom or an equality.
syntax::Formula literal(const SExpression& e);
/// The condition, or its negation if not `positive`.
syntax::Formula formula(const SExpression& e, bool positive);
syntax::Formula make(syntax::Formula::Kind kind, const SourceLocation& location,
                     std::vector<syntax::Formula> children = {});

}  // namespace pddl

}  // namespace kaboum::plan
