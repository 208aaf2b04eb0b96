#pragma once

#include <limits>

namespace kaboum::pairs::detail {

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Sums of a few products are rounded by far less than this share of what enters them.
inline constexpr double kRounding = 0x1p-40;

}  // namespace kaboum::pairs::detail
