#pragma once

#include <memory>
#include <string>

#include "language/syntax.h"

namespace kaboum::plan {

/// Reads the older XML form: <pks> with <domain>, <problem> or both; their text is in the notation
/// of .kpl. @throws Error{InvalidInput} with file and line.
syntax::Document parse_xml(std::shared_ptr<const Source> source);

/// @throws Error{InvalidInput} naming what the form cannot say (types, externals, costs).
std::string print_xml(const syntax::Document& document);

}  // namespace kaboum::plan
