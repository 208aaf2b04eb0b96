#pragma once

/// What rounding takes at most. The verifier's own: what makes results has others.
namespace kaboum::verify {

inline constexpr double kUnit = 0x1p-53;        // relative error of one rounding
inline constexpr double kGrowth = 1 + 0x1p-50;  // more than the ≤ 6 roundings in an error term
inline constexpr double kUp = 1 + 0x1p-40;  // covers the rounding of a few hundred positive terms
inline constexpr double kTiny = 0x1p-1070;  // more than what underflow takes from one operation

}  // namespace kaboum::verify
