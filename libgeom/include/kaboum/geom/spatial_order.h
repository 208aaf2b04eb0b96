#pragma once

#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::geom {

/// Triangle indices along a space-filling curve (Morton's) through the triangles' centres, so that
/// runs of them lie close together. Linear time; deterministic; equal places keep their order.
std::vector<std::uint32_t> spatial_order(const Mesh& mesh);

/// The same for points. The curve's grid is displaced against the points' box by `shift` times its
/// largest extent, so that places which one order tears apart are neighbours in others.
///
/// @pre 0 ≤ shift ≤ 1; coordinates are finite.
std::vector<std::uint32_t> spatial_order(std::span<const Vec3> points, double shift);

}  // namespace kaboum::geom
