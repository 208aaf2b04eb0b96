// Inverse kinematics of a robot of a scene: all configurations where there is a closed form, with
// some of each family that a free joint makes; some where joints before a closed form are
// redundant; those that are found elsewhere.
#include "goals.h"

#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/numeric.h>
#include <kaboum/kinematics/redundant.h>
#include <kaboum/kinematics/solution_set.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/gripper.h>

#include <algorithm>
#include <numeric>

namespace kaboum::manipulation {
namespace ik = kaboum::kinematics;
namespace {

/// Configurations of a family that are taken at first.
constexpr std::size_t kOfFamily = 24;
/// Values of redundant joints with configurations, up to eight each, that are taken at first.
constexpr std::size_t kOfRedundant = 6;
/// Between the values that words keep. [rad, or length]
constexpr double kWordStep = 1e-9;

/// As words keep it. Rounding may take a value past its limit: then the next one within is taken.
std::vector<double> rounded(std::vector<double> q, const world::RobotModel& robot) {
  std::vector<double> out = configuration_of(word_of(q), robot);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const robot::Variable& v = robot.kinematics.variables[i];
    if (v.lower && out[i] < *v.lower) q[i] = out[i] + kWordStep;
    if (v.upper && out[i] > *v.upper) q[i] = out[i] - kWordStep;
  }
  return configuration_of(word_of(q), robot);
}

/// Whether no joint moves but the arm's, and those of grippers, which what they hold decides.
bool is_alone(const world::RobotModel& model, const ik::Arm& arm) {
  const auto moving =
      std::ranges::count_if(model.kinematics.joints, [&](const robot::Joint& joint) {
        return joint.type != robot::JointType::Fixed &&
               std::ranges::none_of(model.grippers, [&](const world::Gripper& gripper) {
                 return std::ranges::find(gripper.joints, joint.variable) != gripper.joints.end();
               });
      });
  return static_cast<std::size_t>(moving) == arm.axes.size();
}

}  // namespace

std::size_t spread(unsigned choice, std::size_t n) {
  auto step = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(n)));
  while (std::gcd(step, n) != 1) ++step;
  return (choice - 1) * step % n;
}

void add_goals(Goals& goals, const world::RobotModel& robot, std::uint32_t link,
               const world::Transform& target, const std::vector<double>& from,
               const GoalSearch& search) {
  const robot::Robot& kinematics = robot.kinematics;
  const ik::Arm arm = ik::arm_of(kinematics, kinematics.links[0].name, kinematics.links[link].name);
  const world::Transform in_base = ik::inverse(robot.base) * target;
  std::vector<double> reference;
  for (const std::uint32_t variable : arm.variables) reference.push_back(from[variable]);
  goals.alone = goals.alone && is_alone(robot, arm);
  // What is held decides where fingers are: no link that they move is put anywhere.
  if (finger_joint_above(robot, link)) {
    goals.all = false;
    return;
  }

  const auto add = [&](std::span<const double> q) {
    const auto near = ik::nearest_copy(arm, q, reference);
    if (!near) return;
    std::vector<double> full = from;
    for (std::size_t i = 0; i < near->size(); ++i) full[arm.variables[i]] = (*near)[i];
    // Fingers stay to the last bit where what is held has them.
    full = with_fingers_of(robot, from, rounded(std::move(full), robot));
    if (robot::find_out_of_limits(kinematics, full))
      goals.all = false;  // limits closer than words can tell
    else
      goals.configurations.push_back(std::move(full));
  };
  if (const auto form = ik::recognise(arm)) {
    ik::SolutionSetOptions options;
    std::copy(reference.begin(), reference.end(), options.solve.reference.begin());
    options.representatives = kOfFamily * (search.attempt + 1);
    const ik::SolutionSet set = ik::solve_set(*form, in_base, options);
    goals.all = goals.all && set.complete && set.families.empty();
    for (const ik::Solution& solution : set.isolated)
      add(std::span(solution.q).first(arm.axes.size()));
    for (const ik::SolutionFamily& family : set.families)
      for (const ik::Solution& solution : family.representatives)
        add(std::span(solution.q).first(arm.axes.size()));
    return;
  }
  if (const auto redundant = ik::recognise_redundant(arm)) {
    ik::RedundantOptions options;
    options.reference = reference;
    options.values = kOfRedundant * (search.attempt + 1);
    const ik::RedundantSolutions solutions = ik::solve_redundant(*redundant, in_base, options);
    goals.all = goals.all && solutions.out_of_reach;
    for (const ik::RedundantSolution& solution : solutions.found) add(solution.q);
    return;
  }
  goals.all = false;
  ik::NumericOptions options;
  options.seed = search.seed;
  options.first = reference;
  if (arm.axes.size() > 6) options.solutions = kOfFamily * (search.attempt + 1);
  if (search.any) options.solutions = 1;
  for (const ik::NumericSolution& solution : ik::solve_numeric_all(arm, in_base, options))
    add(solution.q);
}

}  // namespace kaboum::manipulation
