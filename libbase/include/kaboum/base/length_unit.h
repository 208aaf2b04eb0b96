#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace kaboum {

inline constexpr std::size_t kLengthUnitCount = 8;
/// Names of the units of length that options, containers and scenes may state.
inline constexpr std::array<std::string_view, kLengthUnitCount> kLengthUnits{
    "m", "dm", "cm", "mm", "um", "km", "in", "ft"};

}  // namespace kaboum
