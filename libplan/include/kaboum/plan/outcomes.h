#pragma once

#include <map>
#include <string>

namespace kaboum::plan {

/// Outcomes of sensing, read from JSON {"isSpillable(o1)": true, "place(o2)": "shelf"}: by atom or
/// term "true", "false" or a value.
/// @param file  its name, for messages.
/// @throws Error{InvalidInput} for other texts.
std::map<std::string, std::string> parse_outcomes(const std::string& text, const std::string& file);

}  // namespace kaboum::plan
