#pragma once

#include <string>

#include "language/syntax.h"

namespace kaboum::plan {

/// The document in .kpl; reading it again gives the same document.
std::string print_kpl(const syntax::Document& document);

/// Pieces, also used for messages: "f(?x, c)", "K(!p(?x)) & ...".
std::string print_term(const syntax::Term& term);
std::string print_formula(const syntax::Formula& formula);
std::string print_effects(const std::vector<syntax::Effect>& effects);

}  // namespace kaboum::plan
