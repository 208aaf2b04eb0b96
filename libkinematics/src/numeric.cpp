// Numeric inverse kinematics: damped least squares (Levenberg–Marquardt) on the pose's error, with
// joints kept within their limits, from random starts.
#include <kaboum/base/error.h>
#include <kaboum/kinematics/numeric.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "joint_limits.h"

namespace kaboum::kinematics {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// From a pose to the target: the way in parts of `length`, the turn as a rotation vector.
Vec6 gap(const Transform& pose, const Transform& target, double length) {
  const Eigen::AngleAxisd turn(Mat3(target.linear * pose.linear.transpose()));
  Vec6 e;
  e << (target.translation - pose.translation) / length, turn.angle() * turn.axis();
  return e;
}

class Descent {
 public:
  Descent(const Arm& arm, const Transform& target, const NumericOptions& options)
      : arm_(arm), target_(target), options_(options), length_(std::max(reach(arm), 1e-300)) {}

  [[nodiscard]] std::vector<double> random_start(Random& random) const {
    std::vector<double> q;
    for (const Axis& axis : arm_.axes)
      q.push_back(options_.limits ? random_value(axis, length_, random)
                                  : random_value(free(axis), length_, random));
    return q;
  }

  /// Moves q to where the error is least near it. Whether that is within the bound.
  bool run(std::vector<double>& q) const {
    constexpr int kFew = 8;  // axes of which matrices need no memory of their own
    return arm_.axes.size() <= kFew ? descend<kFew>(q) : descend<Eigen::Dynamic>(q);
  }

  [[nodiscard]] PoseError error(const std::vector<double>& q) const {
    return difference(forward(arm_, q), target_);
  }

 private:
  /// @tparam Most  axes
  template <int Most>
  bool descend(std::vector<double>& q) const {
    using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, Most>;
    using Square =
        Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Most, Most>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, Most, 1>;
    double damping = 1e-3;
    Transform pose;
    Jacobian here = jacobian(arm_, q, &pose);  // at q
    Vec6 e = gap(pose, target_, length_);
    for (int i = 0; i < options_.iterations; ++i) {
      if (met(pose)) return true;
      Jacobian j = here;
      j.topRows(3) /= length_;
      freeze(j, e, q);
      Square normal = j.transpose().lazyProduct(j);
      normal.diagonal().array() += damping;
      const Column step = normal.ldlt().solve(Column(j.transpose().lazyProduct(e)));
      std::vector<double> next = q;
      double moved = 0;
      for (std::size_t k = 0; k < q.size(); ++k) {
        next[k] += std::clamp(step[static_cast<Eigen::Index>(k)], -1.0, 1.0);
        if (options_.limits) next[k] = into_limits(arm_.axes[k], next[k]);
        moved = std::max(moved, std::abs(next[k] - q[k]));
      }
      Transform next_pose;
      const Jacobian there = jacobian(arm_, next, &next_pose);
      const Vec6 next_e = gap(next_pose, target_, length_);
      if (next_e.norm() < e.norm()) {
        q = std::move(next);
        here = there;
        pose = next_pose;
        e = next_e;
        damping = std::max(damping / 8, 1e-15);
      } else {
        if (damping > 1e3 || moved < 1e-15) return false;  // nowhere is better: a local minimum
        damping *= 16;
      }
    }
    return met(pose);
  }

  static Axis free(Axis axis) {
    axis.lower = -std::numeric_limits<double>::infinity();
    axis.upper = -axis.lower;
    return axis;
  }

  [[nodiscard]] bool met(const Transform& pose) const {
    const PoseError e = difference(pose, target_);
    return e.position <= options_.bound * length_ && e.rotation <= options_.bound;
  }

  /// Joints on a limit that the step would take past it do not take part in it.
  template <class Jacobian>
  void freeze(Jacobian& j, const Vec6& e, const std::vector<double>& q) const {
    if (!options_.limits) return;
    for (std::size_t k = 0; k < q.size(); ++k) {
      const double downhill = j.col(static_cast<Eigen::Index>(k)).dot(e);
      if ((q[k] <= arm_.axes[k].lower && downhill < 0) ||
          (q[k] >= arm_.axes[k].upper && downhill > 0))
        j.col(static_cast<Eigen::Index>(k)).setZero();
    }
  }

  const Arm& arm_;
  const Transform& target_;
  const NumericOptions& options_;
  double length_;
};

bool same(const Arm& arm, const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double gap = arm.axes[i].turns
                           ? std::remainder(a[i] - b[i], 2 * std::numbers::pi / arm.axes[i].rate)
                           : a[i] - b[i];
    if (std::abs(gap) > 1e-6) return false;
  }
  return true;
}

/// Calls found(solution) for every start that leads to one, until it returns true.
template <class Callback>
void from_starts(const Arm& arm, const Transform& target, const NumericOptions& options,
                 const Callback& found) {
  if (!options.first.empty() && options.first.size() != arm.axes.size())
    throw Error(ErrorCode::InvalidArgument, std::to_string(options.first.size()) +
                                                " values to start from for an arm with " +
                                                std::to_string(arm.axes.size()) + " axes");
  const Descent descent(arm, target, options);
  Random random(options.seed);
  for (int start = 1; start <= options.starts; ++start) {
    if (options.progress)
      options.progress("start " + std::to_string(start) + " of " + std::to_string(options.starts));
    std::vector<double> q =
        start == 1 && !options.first.empty() ? options.first : descent.random_start(random);
    if (options.limits)
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = into_limits(arm.axes[i], q[i]);
    if (!descent.run(q)) continue;
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = without_turns(options.limits ? arm.axes[i] : Axis{arm.axes[i].turns}, q[i]);
    NumericSolution solution{q, descent.error(q), start};
    if (found(solution)) return;
  }
}

}  // namespace

std::optional<NumericSolution> solve_numeric(const Arm& arm, const Transform& target,
                                             const NumericOptions& options) {
  std::optional<NumericSolution> out;
  from_starts(arm, target, options, [&](NumericSolution& s) {
    out = std::move(s);
    return true;
  });
  return out;
}

std::vector<NumericSolution> solve_numeric_all(const Arm& arm, const Transform& target,
                                               const NumericOptions& options) {
  std::vector<NumericSolution> out;
  from_starts(arm, target, options, [&](NumericSolution& s) {
    const bool known = std::any_of(out.begin(), out.end(),
                                   [&](const NumericSolution& o) { return same(arm, o.q, s.q); });
    if (!known) out.push_back(std::move(s));
    return options.solutions > 0 && out.size() >= options.solutions;
  });
  return out;
}

}  // namespace kaboum::kinematics
