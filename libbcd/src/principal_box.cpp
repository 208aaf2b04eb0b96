// Boxes round points, along the axes of their covariance or others.

#include "principal_box.h"

#include <Eigen/Eigenvalues>
#include <limits>

namespace kaboum::bcd {

using geom::Vec3;

std::vector<Vec3> PrincipalBox::corners(double margin) const {
  std::vector<Vec3> out;
  out.reserve(8);
  for (int i = 0; i < 8; ++i)
    out.emplace_back(mean + axes * Vec3((i & 1) != 0 ? high.x() + margin : low.x() - margin,
                                        (i & 2) != 0 ? high.y() + margin : low.y() - margin,
                                        (i & 4) != 0 ? high.z() + margin : low.z() - margin));
  return out;
}

PrincipalBox box_along(std::span<const Vec3> points, const Eigen::Matrix3d& axes) {
  PrincipalBox out;
  for (const Vec3& p : points) out.mean += p / static_cast<double>(points.size());
  out.axes = axes;
  out.low = Vec3::Constant(std::numeric_limits<double>::infinity());
  out.high = -out.low;
  for (const Vec3& p : points) {
    const Vec3 q = out.axes.transpose() * (p - out.mean);
    out.low = out.low.cwiseMin(q);
    out.high = out.high.cwiseMax(q);
  }
  return out;
}

std::optional<PrincipalBox> principal_box(std::span<const Vec3> points) {
  if (points.empty()) return std::nullopt;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  if (!eigen.eigenvectors().allFinite()) return std::nullopt;
  return box_along(points, eigen.eigenvectors());
}

}  // namespace kaboum::bcd
