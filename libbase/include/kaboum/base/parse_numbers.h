#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace kaboum {

/// "0.1,-2,3": finite numbers with commas between; nullopt for anything else.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace kaboum
