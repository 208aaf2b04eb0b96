#pragma once

#include <array>
#include <vector>

#include "box_tree.h"
#include "mesh_pair.h"

/// Parts of boxes, cut by planes in rounded arithmetic.
namespace kaboum::verify {

using Tetrahedron = std::array<Vec3, 4>;

/// Half-space: normal·x ≤ height.
struct Plane {
  Vec3 normal;
  double height;
};

/// A tetrahedron and how often a cut made one of its corners.
struct Part {
  Tetrahedron corners;
  int cuts;
};

constexpr int kMostCuts = 64;  // what rounding_of_distances allows for

/// The six tetrahedra of a box that share a diagonal.
std::array<Tetrahedron, 6> tetrahedra(const Bounds& box);

/// Cuts a tetrahedron that has corners on both sides of a plane.
void cut(const Part& part, const Plane& plane, std::vector<Part>& above, std::vector<Part>& below);

}  // namespace kaboum::verify
