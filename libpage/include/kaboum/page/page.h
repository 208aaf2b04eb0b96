#pragma once

#include <map>
#include <string>
#include <string_view>

/// Pages that need nothing besides themselves. docs/pages.md.
namespace kaboum::page {

/// The page of a file of the library (plan.html, preview.html) with each {{name}} replaced by the
/// value of that name, or by the file of that name; what is put in is not looked at again.
/// @throws std::out_of_range where there is neither.
std::string filled(std::string_view file, const std::map<std::string, std::string>& values);

/// JSON as the content of an element <script>, which only "</" and "<!" could end or change.
std::string in_script(const std::string& json);

}  // namespace kaboum::page
