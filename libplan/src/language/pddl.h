#pragma once

#include <memory>
#include <string>

#include "language/syntax.h"

namespace kaboum::plan {

/// Reads a PDDL domain or problem: typing, ADL, object fluents, action costs, derived predicates,
/// and :observe with (unknown ...) and (oneof ...) for incomplete knowledge. Closed world but for
/// what is unknown.
/// @throws Error{InvalidInput} naming a requirement or construct that is not supported.
syntax::Document parse_pddl(std::shared_ptr<const Source> source);

/// A type that (:types ...) leaves out, though parameters of the domain name it and the problem has
/// objects of it, is meant all the same.
void declare_shared_types(syntax::Document& domain, const syntax::Document& problem);

/// Domain and problem in one text. @throws Error{InvalidInput} naming what PDDL cannot say.
std::string print_pddl(const syntax::Document& document);

}  // namespace kaboum::plan
