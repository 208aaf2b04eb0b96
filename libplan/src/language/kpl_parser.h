#pragma once

#include <memory>

#include "language/syntax.h"

namespace kaboum::plan {

/// Reads a .kpl text (docs/planning/language.md): a domain, a problem, or both.
/// @throws Error{InvalidInput} with line, column and caret.
syntax::Document parse_kpl(std::shared_ptr<const Source> source);

/// Pieces of another document that are written in the same notation (the XML form). Each text is
/// read to its end.
namespace kpl_piece {
syntax::Formula formula(const Source& source);
std::vector<syntax::Effect> effects(const Source& source);
std::vector<syntax::Effect> initial(const Source& source);
std::vector<syntax::TypedVariable> parameters(const Source& source);
std::vector<syntax::Signature> signatures(const Source& source);
std::vector<syntax::TypedVariable> constants(const Source& source);
}  // namespace kpl_piece

}  // namespace kaboum::plan
