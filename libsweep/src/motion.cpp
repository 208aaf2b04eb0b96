// Where a link is along a stretch of a path, with the derivatives, and what rounding may do to
// them. docs/algorithms/swept-volumes.md.

#include <kaboum/base/error.h>
#include <kaboum/sweep/motion.h>

#include <algorithm>
#include <cmath>

namespace kaboum::sweep {

LinkMotion::LinkMotion(const Robot& robot, std::uint32_t link, std::span<const double> from,
                       std::span<const double> to) {
  std::vector<std::uint32_t> chain;
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) chain.push_back(l - 1);
  std::reverse(chain.begin(), chain.end());
  factors_ = chain.size() + 1;
  Transform fixed;
  double lengths = 0;
  for (const std::uint32_t j : chain) {
    const robot::Joint& joint = robot.joints[j];
    fixed = fixed * joint.origin;
    lengths += joint.origin.translation.norm();
    if (joint.type == robot::JointType::Fixed) continue;
    Stage stage;
    stage.before = fixed;
    stage.lengths = lengths;
    fixed = {};
    lengths = 0;
    stage.revolute = joint.type == robot::JointType::Revolute;
    stage.axis = joint.axis;
    const Vec3& a = joint.axis;
    stage.cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    stage.across = Mat3::Identity() - a * a.transpose();
    stage.from = joint.multiplier * from[joint.variable] + joint.offset;
    stage.to = joint.multiplier * to[joint.variable] + joint.offset;
    stage.magnitude = std::abs(joint.multiplier) *
                          std::max(std::abs(from[joint.variable]), std::abs(to[joint.variable])) +
                      std::abs(joint.offset);
    // Of the variable, not of the joint: exactly zero when the variable rests.
    stage.delta = joint.multiplier * (to[joint.variable] - from[joint.variable]);
    moves_ = moves_ || stage.delta != 0;
    stages_.push_back(stage);
  }
  after_ = fixed;
  after_lengths_ = lengths;
}

Transform LinkMotion::at(double s) const {
  Transform t;
  for (const Stage& k : stages_) {
    t = t * k.before;
    const double value = s == 1 ? k.to : k.from + s * k.delta;
    if (k.revolute) {
      const double cosine = std::cos(value), sine = std::sin(value);
      t.linear = t.linear * (Mat3::Identity() + sine * k.cross + (cosine - 1) * k.across).eval();
    } else {
      t.translation += t.linear * (value * k.axis);
    }
  }
  return t * after_;
}

LinkMotion::Expansion LinkMotion::expand(double s) const {
  Expansion c;
  for (int n = 1; n <= kOrder; ++n) c[n].linear.setZero();
  int order = 0;  // coefficients above it are zero so far
  const auto fixed = [&](const Transform& t) {
    for (int n = 0; n <= order; ++n) {
      c[n].translation += c[n].linear * t.translation;
      c[n].linear = (c[n].linear * t.linear).eval();
    }
  };
  for (const Stage& k : stages_) {
    fixed(k.before);
    const double value = s == 1 ? k.to : k.from + s * k.delta;
    if (!k.revolute) {
      for (int n = order; n >= 0; --n) {
        const Vec3 direction = c[n].linear * k.axis;
        c[n].translation += value * direction;
        if (n < kOrder) c[n + 1].translation += k.delta * direction;
      }
      if (k.delta != 0) order = kOrder;
      continue;
    }
    // The turn is along + even; its derivatives by the angle are odd, −even, −odd, even, …
    const double cosine = std::cos(value), sine = std::sin(value);
    const Mat3 even = sine * k.cross + cosine * k.across;
    if (k.delta == 0) {
      const Mat3 turn = Mat3::Identity() - k.across + even;
      for (int n = 0; n <= order; ++n) c[n].linear = (c[n].linear * turn).eval();
      continue;
    }
    const Mat3 odd = cosine * k.cross - sine * k.across;
    std::array<Mat3, kOrder + 1> by_even, by_odd;
    for (int n = 0; n <= order; ++n) {
      by_even[n].noalias() = c[n].linear * even;
      by_odd[n].noalias() = c[n].linear * odd;
    }
    for (int n = kOrder; n >= 0; --n) {
      Mat3 sum = Mat3::Zero();
      if (n <= order) sum = (c[n].linear * k.axis) * k.axis.transpose();
      double factor = 1;  // deltaⁱ / i!
      for (int i = 0; i <= n; ++i) {
        if (i > 0) factor *= k.delta / i;
        if (n - i > order) continue;
        const double sign = i % 4 < 2 ? factor : -factor;
        sum += sign * (i % 2 == 0 ? by_even[n - i] : by_odd[n - i]);
      }
      c[n].linear = sum;
    }
    order = kOrder;
  }
  fixed(after_);
  return c;
}

}  // namespace kaboum::sweep
