#pragma once

#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/transform.h>

#include <Eigen/Geometry>
#include <random>
#include <vector>

namespace kaboum::test {

inline geom::Vec3 random_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  const double x = unit(random), y = unit(random), z = unit(random);
  return {x, y, z};
}

inline Eigen::Matrix3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

/// Every fourth one is parallel to the axes: where separating axes degenerate.
inline geom::Transform random_pose(std::mt19937_64& random, double size) {
  Eigen::Matrix3d turn = random_rotation(random);
  if (random() % 4 == 0)
    turn = Eigen::AngleAxisd(static_cast<double>(random() % 4) * EIGEN_PI / 2,
                             geom::Vec3::Unit(static_cast<int>(random() % 3)))
               .toRotationMatrix();
  return {turn, random_point(random, size)};
}

inline geom::Mesh random_body(std::mt19937_64& random, double size) {
  for (;;) {
    std::vector<geom::Vec3> points;
    const geom::Vec3 center = random_point(random, size);
    for (std::size_t i = 4 + random() % 9; i-- > 0;)
      points.emplace_back(center + random_point(random, 0.4));
    if (auto hull = geom::convex_hull(points)) return *hull;
  }
}

/// Whether hull(a) and pose · hull(b) meet: whether the origin is in the hull of all differences of
/// their vertices, by exact predicates. Shares nothing with separating axes or directions.
/// (Vertices of b are rounded when they are posed.)
inline bool meet(const std::vector<geom::Vec3>& a, const std::vector<geom::Vec3>& b,
                 const geom::Transform& pose) {
  std::vector<geom::Vec3> differences;
  for (const geom::Vec3& q : b)
    for (const geom::Vec3& p : a) differences.emplace_back(pose * q - p);
  const auto hull = geom::convex_hull(differences);
  if (!hull) return true;  // flat: not decided here
  for (const auto& [i, j, k] : hull->triangles)
    if (geom::orient3d(hull->vertices[i], hull->vertices[j], hull->vertices[k],
                       geom::Vec3::Zero()) == geom::Sign::Positive)
      return false;
  return true;
}

}  // namespace kaboum::test
