// Sums of squared distances to planes. Source: [garland1997].

#include "quadric.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace kaboum::bmesh {
namespace {

Eigen::Matrix3d matrix(const Quadric& q) {
  Eigen::Matrix3d a;
  a << q.xx, q.xy, q.xz, q.xy, q.yy, q.yz, q.xz, q.yz, q.zz;
  return a;
}

/// Principal frame of a quadric: axes in the columns of R, and the minimiser of least distance to
/// `near` (singular directions are left where `near` is).
struct PrincipalFrame {
  Eigen::Matrix3d axes;
  Vec3 minimiser;
};

PrincipalFrame principal_frame(const Quadric& q, const Vec3& near) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix(q));
  const Vec3 gradient = eigen.eigenvectors().transpose() * q.half_gradient(near);
  const double cutoff = 1e-9 * std::max(eigen.eigenvalues().maxCoeff(), 0.0);
  Vec3 step = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > cutoff) step[k] = -gradient[k] / eigen.eigenvalues()[k];
  return {eigen.eigenvectors(), near + eigen.eigenvectors() * step};
}

/// Some point in the region where both quadrics are small: where the sum's singular directions
/// start.
Vec3 anchor(const Quadric& a, const Quadric& b) {
  const Quadric q = a + b;
  const double t = q.trace();
  return t > 0 ? Vec3(-q.bx / t, -q.by / t, -q.bz / t) : Vec3(Vec3::Zero());
}

}  // namespace

Quadric point_quadric(const Vec3& p) {
  Quadric q;
  q.xx = q.yy = q.zz = 1;
  q.bx = -p.x();
  q.by = -p.y();
  q.bz = -p.z();
  q.c = p.squaredNorm();
  return q;
}

Quadric add_adapted(const Quadric& a, const Quadric& b) {
  Quadric sum = a + b;
  const Vec3 m = principal_frame(sum, anchor(a, b)).minimiser;
  sum.c -= std::max({a(m), b(m), 0.0});
  return sum;
}

Quadric add_diagonal(const Quadric& a, const Quadric& b, double length, bool as_printed) {
  const PrincipalFrame frame = principal_frame(a + b, anchor(a, b));
  Vec3 diagonal = Vec3::Zero();
  double constant = 0;
  for (const Quadric* q : {&a, &b}) {
    const Eigen::Matrix3d s = frame.axes.transpose() * matrix(*q) * frame.axes;
    const Vec3 linear = 2 * (frame.axes.transpose() * q->half_gradient(frame.minimiser));
    double c = (*q)(frame.minimiser);
    for (int i = 0; i < 3; ++i) {
      const double off1 = std::abs(s(i, (i + 1) % 3)), off2 = std::abs(s(i, (i + 2) % 3));
      const double square = as_printed ? std::sqrt(s(i, i) * s(i, i) + off1 * off1 + off2 * off2)
                                       : s(i, i) + off1 + off2;
      const double t = as_printed ? linear[i] : std::abs(linear[i]);
      diagonal[i] = std::max(diagonal[i], square + t / (2 * length));
      c += t * length / 2;
    }
    constant = std::max(constant, c);
  }
  // x ↦ Σ diagonal_i (axis_i · (x − minimiser))² + constant, multiplied out.
  const Eigen::Matrix3d m = frame.axes * diagonal.asDiagonal() * frame.axes.transpose();
  const Vec3 lin = -m * frame.minimiser;
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2),
          m(2, 2), lin[0],  lin[1],  lin[2],  frame.minimiser.dot(m * frame.minimiser) + constant};
}

}  // namespace kaboum::bmesh
