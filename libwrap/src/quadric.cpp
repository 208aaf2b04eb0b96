// Quadrics of planes, and their minimisers. Proposals only: nothing is decided here.
#include "quadric.h"

#include <Eigen/Eigenvalues>

namespace kaboum::wrap {

void Quadric::add_plane(const Vec3& n, const Vec3& p, double w) {
  const double d = -n.dot(p);
  a += w * n * n.transpose();
  b += w * d * n;
  c += w * d * d;
  weight += w;
}

void Quadric::add_point(const Vec3& p, double w) {
  a += w * Eigen::Matrix3d::Identity();
  b -= w * p;
  c += w * p.squaredNorm();
}

Quadric& Quadric::operator+=(const Quadric& other) {
  a += other.a;
  b += other.b;
  c += other.c;
  weight += other.weight;
  return *this;
}

Vec3 Quadric::minimiser(const Vec3& p) const {
  // Directions in which the quadric hardly changes are left alone.
  constexpr double kFlat = 1e-2;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(a);
  const Vec3 slope = a * p + b;
  Vec3 result = p;
  for (int k = 0; k < 3; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value > kFlat * eigen.eigenvalues()[2])) continue;
    const Vec3 direction = eigen.eigenvectors().col(k);
    result -= direction.dot(slope) / value * direction;
  }
  return result;
}

}  // namespace kaboum::wrap
