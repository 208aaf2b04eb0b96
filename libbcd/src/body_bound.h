#pragma once

#include <cstddef>
#include <vector>

#include "solid_field.h"

namespace kaboum::bcd {

/// A number of convex bodies that is proved to be too few: no so many bodies that contain all
/// corners of the mesh stay nearer to the solid and its triangles than `distance`. At most `most`,
/// and no claim that one more would do. docs/algorithms/convex-decomposition.md, "More bodies".
std::size_t too_few_bodies(const Mesh& mesh, const SolidField& solid, double distance,
                           std::size_t most);

}  // namespace kaboum::bcd
