#pragma once

#include <array>
#include <string>

namespace kaboum {

/// Names of the units of length that options, containers and scenes may state.
inline const std::array<std::string, 8> kLengthUnits{"m", "dm", "cm", "mm", "um", "km", "in", "ft"};

}  // namespace kaboum
