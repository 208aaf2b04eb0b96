// Kinematics of its own, in long double.

#include <kaboum/judge/placement.h>

#include <cmath>

namespace kaboum::judge {
namespace {

using geom::Transform;
using geom::Vec3;
using Real = long double;
using Matrix = Eigen::Matrix<Real, 3, 3>;
using Vector = Eigen::Matrix<Real, 3, 1>;

struct Pose {
  Matrix linear = Matrix::Identity();
  Vector shift = Vector::Zero();
};

Pose pose_of(const Transform& t) { return {t.linear.cast<Real>(), t.translation.cast<Real>()}; }

Pose operator*(const Pose& a, const Pose& b) {
  return {a.linear * b.linear, a.linear * b.shift + a.shift};
}

Transform rounded(const Pose& p) { return {p.linear.cast<double>(), p.shift.cast<double>()}; }

Matrix about(const Vec3& axis, Real angle) {
  const Vector a = axis.cast<Real>().normalized();
  const Real c = std::cos(angle), s = std::sin(angle), x = a[0], y = a[1], z = a[2], v = 1 - c;
  Matrix r;
  r << c + x * x * v, x * y * v - z * s, x * z * v + y * s,  //
      y * x * v + z * s, c + y * y * v, y * z * v - x * s,   //
      z * x * v - y * s, z * y * v + x * s, c + z * z * v;
  return r;
}

}  // namespace

std::vector<Transform> places(const robot::Robot& robot, const Transform& base,
                              std::span<const double> q) {
  std::vector<Pose> poses{pose_of(base)};
  for (const robot::Joint& joint : robot.joints) {
    Pose local = pose_of(joint.origin);
    if (joint.type != robot::JointType::Fixed) {
      const Real value = static_cast<Real>(joint.multiplier) * q[joint.variable] + joint.offset;
      const Pose motion = joint.type == robot::JointType::Revolute
                              ? Pose{about(joint.axis, value), Vector::Zero()}
                              : Pose{Matrix::Identity(), value * joint.axis.cast<Real>()};
      local = local * motion;
    }
    poses.push_back(poses[joint.parent] * local);
  }
  std::vector<Transform> out;
  for (const Pose& p : poses) out.push_back(rounded(p));
  return out;
}

Transform product(const Transform& a, const Transform& b) {
  return rounded(pose_of(a) * pose_of(b));
}

}  // namespace kaboum::judge
