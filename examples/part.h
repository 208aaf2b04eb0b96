#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::examples {

/// Range and default of the resolution below.
inline constexpr int kMinBracketResolution = 8;
inline constexpr int kMaxBracketResolution = 256;
inline constexpr int kBracketResolution = 60;

/// An angle bracket such as CAD programs export: base plate with five bolt holes, four of them
/// counterbored, thin wall with slots and holes, bend with inner fillet, rib, rounded corners.
///
/// One closed, manifold, outward-oriented solid without self-intersections, 0.2 × 0.12 × 0.14 m.
/// Coordinates are the doubles nearest to multiples of 1e-7 m; hardly any is a float32 number. The
/// same bytes on every machine whose cosine is right to 1e-9.
///
/// @param resolution  segments of a full circle; planar faces are subdivided in proportion.
/// @throws Error{InvalidArgument} outside of the range above.
geom::Mesh make_bracket(int resolution = kBracketResolution);

}  // namespace kaboum::examples
