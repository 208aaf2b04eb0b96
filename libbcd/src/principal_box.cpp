// Boxes along the axes of the covariance of points.

#include "principal_box.h"

#include <Eigen/Eigenvalues>

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

std::optional<PrincipalBox> principal_box(std::span<const Vec3> points) {
  if (points.empty()) return std::nullopt;
  PrincipalBox out;
  for (const Vec3& p : points) out.mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) covariance += (p - out.mean) * (p - out.mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  out.axes = eigen.eigenvectors();
  if (!out.axes.allFinite()) return std::nullopt;
  out.low = Vec3::Constant(std::numeric_limits<double>::infinity());
  out.high = -out.low;
  for (const Vec3& p : points) {
    const Vec3 q = out.axes.transpose() * (p - out.mean);
    out.low = out.low.cwiseMin(q);
    out.high = out.high.cwiseMax(q);
  }
  return out;
}

}  // namespace kaboum::bcd
