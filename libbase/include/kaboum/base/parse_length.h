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

/// The texts of those lengths that state a unit, each once.
std::vector<std::string> texts_with_unit(std::span<const Length> lengths);

}  // namespace kaboum
