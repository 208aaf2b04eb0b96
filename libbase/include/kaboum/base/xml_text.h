#pragma once

#include <string>
#include <string_view>

namespace kaboum {

/// Text as it stands in XML, in elements and in attributes with double quotation marks.
std::string escape_xml(std::string_view text);

}  // namespace kaboum
