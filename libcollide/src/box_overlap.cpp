// Separating axes of two oriented boxes.

#include <kaboum/collide/box_overlap.h>

#include <cmath>

namespace kaboum::collide {

bool boxes_are_apart(const Eigen::Matrix3d& axes, const geom::Vec3& between, const geom::Vec3& a,
                     const geom::Vec3& b) {
  // Every term below is off by less than a few units of 2^-53 of the lengths it is a sum of; the
  // axes are off by as much from being orthonormal. This is a thousand times that.
  const double slack = 1e-12 * (between.lpNorm<1>() + a.sum() + b.sum());
  const Eigen::Matrix3d extent = axes.cwiseAbs();

  const geom::Vec3 along_a = between.cwiseAbs() - a - extent * b;
  if ((along_a.array() > slack).any()) return true;
  const geom::Vec3 along_b = (axes.transpose() * between).cwiseAbs() - b - extent.transpose() * a;
  if ((along_b.array() > slack).any()) return true;

  // Across an edge of each: axis i of the first box × axis j of the second one.
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double distance = std::abs(between[i2] * axes(i1, j) - between[i1] * axes(i2, j));
      const double radius = a[i1] * extent(i2, j) + a[i2] * extent(i1, j) + b[j1] * extent(i, j2) +
                            b[j2] * extent(i, j1);
      if (distance - radius > slack) return true;
    }
  }
  return false;
}

}  // namespace kaboum::collide
