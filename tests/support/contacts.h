#pragma once

#include <kaboum/geom/transform.h>

#include <random>

namespace kaboum::test {

/// Two hulls that touch, but for a few roundings.
struct Contact {
  geom::Mesh a, b;
  geom::Transform pose_a, pose_b;
  double size = 1;  ///< of the bodies [length]
};

/// Facets, edges and vertices in contact with each other, needles and flat bodies among them,
/// scales of 1e-6 to 1e6, up to a thousand times their size from the origin; every fifth pair
/// parallel to the axes, of small whole numbers.
Contact random_contact(std::mt19937_64& random);

}  // namespace kaboum::test
