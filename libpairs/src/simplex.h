#pragma once

#include <kaboum/geom/mesh.h>

#include <array>

namespace kaboum::pairs::detail {

using geom::Vec3;

/// Up to four points, for the search of the point of a convex set that is nearest to the origin
/// (E. G. Gilbert, D. W. Johnson, S. S. Keerthi, 1988). In rounded arithmetic: it finds directions,
/// and nothing is claimed of them.
struct Simplex {
  std::array<Vec3, 4> points, on_a, on_b;
  std::array<double, 4> weights{};
  int size = 0;

  void add(const Vec3& p, const Vec3& a, const Vec3& b) {
    points[size] = p;
    on_a[size] = a;
    on_b[size] = b;
    weights[size] = 0;
    ++size;
  }
  /// Keeps the points that the nearest one is a mean of. @return the nearest one
  Vec3 reduce();
};

}  // namespace kaboum::pairs::detail
