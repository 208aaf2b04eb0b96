// Straight lines of a tool by inverse kinematics.
#include "lines.h"

#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/numeric.h>
#include <kaboum/kinematics/redundant.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/gripper.h>

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

/// An arm and the closed form that it has, or that it has behind redundant joints.
struct Solver {
  ik::Arm arm;
  std::optional<ik::ClosedForm> form = ik::recognise(arm);
  std::optional<ik::RedundantArm> redundant = ik::recognise_redundant(arm);
};

/// The configuration that reaches a pose next to another one; redundant joints stay where they can.
std::optional<std::vector<double>> next_to(const Solver& solver, const world::Transform& target,
                                           const std::vector<double>& reference) {
  const ik::Arm& arm = solver.arm;
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
  if (solver.form) {
    ik::SolveOptions options;
    std::copy(reference.begin(), reference.end(), options.reference.begin());
    for (const ik::Solution& solution : ik::solve(*solver.form, target, options))
      consider(std::span(solution.q).first(arm.axes.size()));
  } else if (solver.redundant) {
    for (const ik::RedundantSolution& solution :
         ik::solve_with_redundant(*solver.redundant, target, reference))
      consider(solution.q);
  }
  if (!solver.form && !best) {
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
  if (finger_joint_above(robot, link)) return std::nullopt;
  const robot::Robot& kinematics = robot.kinematics;
  const Solver solver{
      ik::arm_of(kinematics, kinematics.links[0].name, kinematics.links[link].name)};
  const ik::Arm& arm = solver.arm;
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
    const auto q = next_to(solver, i == count ? end : target, reference);
    if (!q) return std::nullopt;
    reference = *q;
    std::vector<double> full = path.back();
    for (std::size_t j = 0; j < q->size(); ++j) full[arm.variables[j]] = (*q)[j];
    if (find_out_of_limits(kinematics, full)) return std::nullopt;
    path.push_back(std::move(full));
  }
  return path;
}

}  // namespace kaboum::manipulation
