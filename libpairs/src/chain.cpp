// Kinematics of one link relative to another one.

#include "chain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace kaboum::pairs::detail {
namespace {

Transform inverse(const Transform& t) {
  const Eigen::Matrix3d back = t.linear.transpose();
  return {back, -(back * t.translation)};
}

Eigen::Matrix3d turn(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

Chain::Chain(const robot::Robot& robot, std::uint32_t a, std::uint32_t b) {
  // From each up to the link that both hang from; parents come before their children.
  std::vector<std::uint32_t> up, down;
  for (std::uint32_t x = a, y = b; x != y;) {
    std::uint32_t& later = x > y ? x : y;
    (x > y ? up : down).push_back(later - 1);
    later = robot.joints[later - 1].parent;
  }
  std::ranges::reverse(down);
  factors_ = up.size() + down.size() + 1;
  std::set<std::uint32_t> variables;
  for (const auto* way : {&up, &down})
    for (const std::uint32_t j : *way)
      if (robot.joints[j].type != robot::JointType::Fixed)
        variables.insert(robot.joints[j].variable);
  variables_.assign(variables.begin(), variables.end());
  const auto local = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::ranges::lower_bound(variables_, v) - variables_.begin());
  };
  Transform fixed;
  const auto motion = [&](const robot::Joint& joint, double sign) {
    if (joint.type == robot::JointType::Fixed) return;
    joints_.push_back({joint.type == robot::JointType::Revolute, local(joint.variable),
                       sign * joint.multiplier, 0});
    steps_.push_back({fixed, joint.axis, sign * joint.offset});
    fixed = {};
  };
  for (const std::uint32_t j : up) {
    motion(robot.joints[j], -1);
    fixed = fixed * inverse(robot.joints[j].origin);
    extent_ += robot.joints[j].origin.translation.norm();
  }
  for (const std::uint32_t j : down) {
    fixed = fixed * robot.joints[j].origin;
    extent_ += robot.joints[j].origin.translation.norm();
    motion(robot.joints[j], 1);
  }
  after_ = fixed;
  find_limits(robot);
  if (!limits_) return;
  own_limits_ = limits_;
  for (const auto* way : {&up, &down})
    for (const std::uint32_t j : *way) narrow(robot.joints[j]);
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    Joint& joint = joints_[k];
    joint.most = std::abs(joint.multiplier) * std::max(std::abs(limits_->low[joint.variable]),
                                                       std::abs(limits_->high[joint.variable])) +
                 std::abs(steps_[k].offset);
    if (!joint.revolute) extent_ += joint.most;
  }
  extent_ *= 1 + 0x1p-40;
}

void Chain::find_limits(const robot::Robot& robot) {
  Limits out;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const robot::Variable& variable = robot.variables[variables_[i]];
    if (variable.lower && variable.upper) {
      out.low.push_back(*variable.lower);
      out.high.push_back(*variable.upper);
      continue;
    }
    // A turn after which all joints are where they were.
    double multiplier = 0;  // the least; all others are multiples of it, exactly
    for (const Joint& joint : joints_) {
      if (joint.variable != i || joint.multiplier == 0) continue;
      if (!joint.revolute) return;
      const double here = std::abs(joint.multiplier);
      multiplier = multiplier == 0 ? here : std::min(multiplier, here);
    }
    for (const Joint& joint : joints_)
      if (joint.variable == i && multiplier != 0 && std::fmod(joint.multiplier, multiplier) != 0)
        return;
    const double period = multiplier == 0 ? 0 : 2 * std::numbers::pi / multiplier * (1 + 0x1p-40);
    out.low.push_back(
        variable.lower.value_or(variable.upper ? *variable.upper - period : -period / 2));
    out.high.push_back(out.low.back() + period);
  }
  limits_ = std::move(out);
}

void Chain::narrow(const robot::Joint& joint) {
  if (joint.type == robot::JointType::Fixed || joint.multiplier == 0 || !own_limits_) return;
  const auto v = static_cast<std::size_t>(std::ranges::lower_bound(variables_, joint.variable) -
                                          variables_.begin());
  double &low = own_limits_->low[v], &high = own_limits_->high[v];
  const auto bound = [&](const std::optional<double>& limit, bool lower) {
    if (!limit) return;
    const double value = (*limit - joint.offset) / joint.multiplier;
    if (lower == (joint.multiplier > 0))
      low = std::max(low, value);
    else
      high = std::min(high, value);
  };
  bound(joint.lower, true);
  bound(joint.upper, false);
  if (!(low <= high)) own_limits_.reset();
}

void Chain::place(std::span<const double> values, Placed& out) const {
  out.axes.resize(joints_.size());
  out.origins.resize(joints_.size());
  Transform t;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const Joint& joint = joints_[k];
    t = t * steps_[k].before;
    out.axes[k] = t.linear * steps_[k].axis;
    out.origins[k] = t.translation;
    const double value = joint.multiplier * values[joint.variable] + steps_[k].offset;
    if (joint.revolute)
      t.linear = (t.linear * turn(steps_[k].axis, value)).eval();
    else
      t.translation += value * out.axes[k];
  }
  out.b = t * after_;
}

double Chain::error(double reach) const {
  double turns = 1;
  for (const Joint& joint : joints_)
    if (joint.revolute) turns += joint.most;
  // 200 · 2^-53 for each factor; see the page.
  return 200 * 0x1p-53 * (static_cast<double>(factors_ + joints_.size()) + turns) *
         (extent_ + reach);
}

}  // namespace kaboum::pairs::detail
