#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>

namespace kaboum::sweep {

/// Parses well-formed XML; documents nested deeper than tinyxml2 allows (100 elements) are refused.
/// @throws Error{InvalidInput} naming the line.
void parse_xml(tinyxml2::XMLDocument& document, std::string_view text, const std::string& name);

/// "file:line: what" as Error{InvalidInput}.
[[noreturn]] void fail_at(const std::string& name, int line, const std::string& what);

}  // namespace kaboum::sweep
