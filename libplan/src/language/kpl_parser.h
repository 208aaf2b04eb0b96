#pragma once

#include <memory>

#include "language/syntax.h"

namespace kaboum::plan {

/// Reads a .kpl text (docs/planning/language.md): a domain, a problem, or both.
/// @throws Error{InvalidInput} with line, column and caret.
syntax::Document parse_kpl(std::shared_ptr<const Source> source);

}  // namespace kaboum::plan
