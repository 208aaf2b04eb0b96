#pragma once

#include <kaboum/geom/mesh.h>

#include <optional>
#include <span>
#include <vector>

#include "piece.h"

namespace kaboum::bcd {

/// float32 points whose hull contains the piece's part of the solid: exact points and, where they
/// are not float32 numbers or were computed, the corners of a float32 box round them.
/// @param error  bound of the error of computed points, per coordinate.
std::vector<Vec3> outer_points(const Piece& piece, double error);

/// An exactly convex float32 polytope that contains `required` (float32 points), exactly: the hull
/// of `shape` with its vertices moved outwards as little as that takes; nullopt when the shape is
/// too thin for that or would get more than `most` vertices.
/// @throws Error{LimitReached} when coordinates exceed float32.
std::optional<geom::Mesh> push_out(std::span<const Vec3> shape, std::span<const Vec3> required,
                                   std::size_t most);

/// A prism of at most `most` vertices, with float32 coordinates, that contains `required`, exactly;
/// nullopt when none is found.
std::optional<geom::Mesh> prism_round(std::span<const Vec3> required, std::size_t most);

/// push_out; instead of nothing the hull of `required`, or, if it has more than `most` vertices, a
/// prism across its thinnest direction.
geom::Mesh enclose(std::span<const Vec3> shape, std::span<const Vec3> required, std::size_t most);

}  // namespace kaboum::bcd
