#pragma once

#include <kaboum/base/length.h>

#include <optional>
#include <string_view>

namespace kaboum {

/// "0.005", "+0.005", "5mm" (a unit of kLengthUnits, without a blank before it) or "0.5%"; nullopt
/// unless it is a positive finite number.
std::optional<Length> parse_length(std::string_view text);

}  // namespace kaboum
