#pragma once

#include <kaboum/base/length.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum {

/// "0.005", "+0.005", "5mm" (a unit of kLengthUnits, without a blank before it) or "0.5%"; nullopt
/// unless it is a positive finite number.
std::optional<Length> parse_length(std::string_view text);
/// The same, or zero: "0", "0mm".
std::optional<Length> parse_distance(std::string_view text);

/// Notes that a file does not state the unit which those lengths that state one are brought into:
/// one for each text.
/// @param taken  that unit, and why it is: "m, which is that of set.glb"
std::vector<std::string> notes_on_unit(std::span<const Length> lengths, const std::string& taken);

}  // namespace kaboum
