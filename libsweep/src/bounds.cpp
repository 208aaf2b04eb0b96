// Bounds of the derivatives of a point of a link along a straight path in joint space.
// docs/algorithms/swept-volumes.md has the proofs. Source: [gaschler2016] Eq. 4.19, 4.20.

#include <kaboum/base/error.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/sweep/motion.h>

#include <algorithm>
#include <cmath>

namespace kaboum::sweep {
namespace {

using geom::kUp;

/// What rounding may take from a distance: of the lengths that cancel on the way, which are none
/// where one transform alone is between.
double lost(double lengths, double distance) { return 0x1p-38 * std::max(0.0, lengths - distance); }

}  // namespace

Reach reach_of(const LinkMotion& motion, std::span<const Vec3> points) {
  ensure(!points.empty(), "bounds of a body without points");
  const auto& stages = motion.stages_;
  Reach out;
  for (const Vec3& p : points) {
    const Vec3 q = motion.after_ * p;
    const double lengths = motion.after_lengths_ + p.norm(), distance = q.norm();
    const double off =
        motion.factors_ > 1 && motion.after_lengths_ > 0 ? lost(lengths, distance) : 0;
    out.lengths = std::max(out.lengths, lengths);
    out.distance = std::max(out.distance, distance + off);
    if (!stages.empty()) out.across = std::max(out.across, (stages.back().across * q).norm() + off);
  }
  return out;
}

MotionBounds::MotionBounds(const LinkMotion& motion, const Reach& reach) {
  const auto& stages = motion.stages_;
  // Largest distance from the origin of the moved frame of a stage, and across the last axis.
  double distance = reach.distance, across = reach.across;
  double angles = 0, lengths = reach.lengths;
  for (std::size_t k = stages.size(); k-- > 0;) {
    const auto& stage = stages[k];
    if (stage.revolute) {
      radius_ = std::max(radius_, across);
      angles += stage.magnitude;
      turn_ += std::abs(stage.delta);
      if (stage.delta != 0) terms_.push_back({true, across * kUp, std::abs(stage.delta) * kUp});
    } else {
      distance += stage.magnitude;
      lengths += stage.magnitude;
      slide_ += std::abs(stage.delta);
      if (stage.delta != 0) terms_.push_back({false, 0, std::abs(stage.delta) * kUp});
    }
    const Vec3& to_origin = stage.before.translation;
    const double off = lost(stage.lengths, to_origin.norm());
    if (k > 0) across = (stages[k - 1].across * to_origin).norm() + off + distance;
    distance += to_origin.norm() + off;
    lengths += stage.lengths;
  }
  std::reverse(terms_.begin(), terms_.end());
  extent_ = distance * kUp;
  lengths_ = lengths * kUp;
  radius_ *= kUp;
  turn_ *= kUp;
  slide_ *= kUp;
  relative_error_ = 0x1p-53 * (256 * static_cast<double>(motion.factors_ + 1) + 8 * angles) * kUp;
}

double MotionBounds::derivative(int n) const {
  const auto power = [](double x, int e) {
    double y = 1;
    for (; e > 0; --e) y *= x;
    return y;
  };
  double sum = 0, turned = 0;
  for (const Term& t : terms_) {
    if (t.revolute) {
      // Expanded, so that all terms are positive: (a + b)^n − a^n = b Σ (a + b)^i a^(n−1−i).
      double difference = 0;
      for (int i = 0; i < n; ++i)
        difference += power(turned + t.delta, i) * power(turned, n - 1 - i);
      sum += t.radius * t.delta * difference;
      turned += t.delta;
    } else {
      sum += n * t.delta * power(turned, n - 1);
    }
  }
  return sum * kUp;
}

double MotionBounds::coarse_second_derivative() const {
  return (radius_ * turn_ * turn_ + 2 * slide_ * turn_) * kUp;
}

double MotionBounds::error(int n) const {
  double scale = std::max(lengths_, extent_);
  for (int i = 0; i < n; ++i) scale *= turn_;
  double slides = n * slide_;
  for (int i = 1; i < n; ++i) slides *= turn_;
  return relative_error_ * (scale + slides) * kUp;
}

}  // namespace kaboum::sweep
