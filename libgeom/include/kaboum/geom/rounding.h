#pragma once

// Bounds of what rounding takes, for whatever makes results; libverify has its own.
namespace kaboum::geom {

/// Distances of points and triangles err by less than this times the largest |coordinate
/// difference|, norms and quotients by less than this relatively: it is above 72 · 2^-53, as
/// derived in docs/algorithms/distances.md, "Point and triangle".
inline constexpr double kDistanceRounding = 8e-15;

/// A factor that covers the rounding of a few hundred positive terms.
inline constexpr double kUp = 1 + 0x1p-40;

}  // namespace kaboum::geom
