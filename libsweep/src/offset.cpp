// Explicit margins: hulls of the corners of cubes that hold the balls of a margin.
// docs/algorithms/swept-volumes.md, "Explicit margin".

#include <kaboum/sweep/sweep.h>

#include <array>
#include <cmath>
#include <numbers>

namespace kaboum::sweep {

std::vector<Vec3> enlarge(std::span<const Vec3> points, double radius) {
  // Corners (0, ±1, ±φ) and their cyclic shifts; the facets are φ²/√3 away from the centre.
  constexpr double kPhi = std::numbers::phi;
  const double r = radius * std::numbers::sqrt3 / (kPhi * kPhi) * (1 + 1e-12);
  std::vector<Vec3> out;
  out.reserve(12 * points.size());
  for (const Vec3& p : points) {
    for (const double a : {-r, r}) {
      for (const double b : {-kPhi * r, kPhi * r}) {
        out.emplace_back(p + Vec3(0, a, b));
        out.emplace_back(p + Vec3(a, b, 0));
        out.emplace_back(p + Vec3(b, 0, a));
      }
    }
  }
  return out;
}

}  // namespace kaboum::sweep
