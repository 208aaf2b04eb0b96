// Inverse kinematics of a robot of a scene: all configurations where there is a closed form, those
// that are found elsewhere.
#include "goals.h"

#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/numeric.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>

namespace kaboum::manipulation {
namespace ik = kaboum::kinematics;

void add_goals(Goals& goals, const world::RobotModel& robot, std::uint32_t link,
               const world::Transform& target, const std::vector<double>& from,
               std::uint64_t seed) {
  const robot::Robot& kinematics = robot.kinematics;
  const ik::Arm arm = ik::arm_of(kinematics, kinematics.links[0].name, kinematics.links[link].name);
  const world::Transform in_base = ik::inverse(robot.base) * target;
  std::vector<double> reference;
  for (const std::uint32_t variable : arm.variables) reference.push_back(from[variable]);

  const auto add = [&](std::span<const double> q) {
    const auto near = ik::nearest_copy(arm, q, reference);
    if (!near) return;
    std::vector<double> full = from;
    for (std::size_t i = 0; i < near->size(); ++i) full[arm.variables[i]] = (*near)[i];
    full = configuration_of(word_of(full), robot);
    if (!robot::find_out_of_limits(kinematics, full))
      goals.configurations.push_back(std::move(full));
  };
  if (const auto form = ik::recognise(arm)) {
    ik::SolveOptions options;
    std::copy(reference.begin(), reference.end(), options.reference.begin());
    for (const ik::Solution& solution : ik::solve(*form, in_base, options)) {
      if (solution.singular & ik::kWrist) goals.all = false;  // a joint is free
      add(std::span(solution.q).first(arm.axes.size()));
    }
    return;
  }
  goals.all = false;
  ik::NumericOptions options;
  options.seed = seed;
  for (const ik::NumericSolution& solution : ik::solve_numeric_all(arm, in_base, options))
    add(solution.q);
}

}  // namespace kaboum::manipulation
