// Straight lines of a tool by inverse kinematics, and paths on which something stays upright.
#include "lines.h"

#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/numeric.h>
#include <kaboum/robot/kinematics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace kaboum::manipulation {
namespace ik = kaboum::kinematics;
namespace {

/// Joints that turn farther from one waypoint to the next have jumped. [rad, or length]
constexpr double kJump = 0.5;
/// Most that the tool turns from one waypoint to the next. [rad]
constexpr double kTurn = 0.1;
/// Stretches of a segment that are shorter are not halved again.
constexpr double kShortest = 1e-6;

/// The configuration that reaches a pose next to another one.
std::optional<std::vector<double>> next_to(const ik::Arm& arm,
                                           const std::optional<ik::ClosedForm>& form,
                                           const world::Transform& target,
                                           const std::vector<double>& reference) {
  std::optional<std::vector<double>> best;
  double least = kJump;
  const auto consider = [&](std::span<const double> q) {
    auto near = ik::nearest_copy(arm, q, reference);
    if (!near) return;
    double most = 0;
    for (std::size_t i = 0; i < near->size(); ++i)
      most = std::max(most, std::abs((*near)[i] - reference[i]));
    if (most >= least) return;
    least = most;
    best = std::move(near);
  };
  if (form) {
    ik::SolveOptions options;
    std::copy(reference.begin(), reference.end(), options.reference.begin());
    for (const ik::Solution& solution : ik::solve(*form, target, options))
      consider(std::span(solution.q).first(arm.axes.size()));
  } else {
    ik::NumericOptions options;
    options.starts = 1;
    options.first = reference;
    if (const auto solution = ik::solve_numeric(arm, target, options)) consider(solution->q);
  }
  return best;
}

}  // namespace

std::optional<robot::Path> follow_line(const world::RobotModel& robot, std::uint32_t link,
                                       const std::vector<double>& from, const world::Transform& to,
                                       double step) {
  const robot::Robot& kinematics = robot.kinematics;
  const ik::Arm arm = ik::arm_of(kinematics, kinematics.links[0].name, kinematics.links[link].name);
  const auto form = ik::recognise(arm);
  const world::Transform start = forward(kinematics, from)[link],
                         end = ik::inverse(robot.base) * to;
  const Eigen::Quaterniond a(start.linear), b(end.linear);
  const double turn = a.angularDistance(b);
  const auto count = static_cast<std::size_t>(std::ceil(
      std::max({1.0, (end.translation - start.translation).norm() / step, turn / kTurn})));
  std::vector<double> reference;
  for (const std::uint32_t variable : arm.variables) reference.push_back(from[variable]);
  robot::Path path{from};
  for (std::size_t i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    const world::Transform target{
        a.slerp(share, b).toRotationMatrix(),
        start.translation + share * (end.translation - start.translation)};
    const auto q = next_to(arm, form, i == count ? end : target, reference);
    if (!q) return std::nullopt;
    reference = *q;
    std::vector<double> full = path.back();
    for (std::size_t j = 0; j < q->size(); ++j) full[arm.variables[j]] = (*q)[j];
    if (find_out_of_limits(kinematics, full)) return std::nullopt;
    path.push_back(std::move(full));
  }
  return path;
}

bool stays_upright(const world::RobotModel& robot, const robot::Path& path,
                   const Upright& upright) {
  const robot::Robot& kinematics = robot.kinematics;
  const auto lean = [&](const std::vector<double>& q) {
    const geom::Vec3 up =
        robot.base.linear * (forward(kinematics, q)[upright.link].linear * upright.up);
    return std::atan2(up.head<2>().norm(), up.z());
  };
  for (std::size_t s = 0; s + 1 < path.size(); ++s) {
    // Most that the link turns along the whole segment: its angular velocity is the sum of those of
    // the joints before it.
    double turned = 0;
    for (std::uint32_t at = upright.link; at > 0; at = kinematics.joints[at - 1].parent) {
      const robot::Joint& joint = kinematics.joints[at - 1];
      if (joint.type == robot::JointType::Revolute)
        turned +=
            std::abs(joint.multiplier * (path[s + 1][joint.variable] - path[s][joint.variable]));
    }
    std::vector<std::pair<double, double>> stretches{{0, 1}};  // the earlier one last
    while (!stretches.empty()) {
      const auto [begin, end] = stretches.back();
      stretches.pop_back();
      const double middle = 0.5 * (begin + end);
      std::vector<double> q = path[s];
      for (std::size_t j = 0; j < q.size(); ++j) q[j] += middle * (path[s + 1][j] - q[j]);
      constexpr double kRounding = 1e-9;
      const double leans = lean(q) + kRounding;
      if (leans + 0.5 * turned * (end - begin) <= upright.angle) continue;
      if (leans > upright.angle || end - begin < kShortest) return false;
      stretches.emplace_back(middle, end);
      stretches.emplace_back(begin, middle);
    }
  }
  return true;
}

}  // namespace kaboum::manipulation
