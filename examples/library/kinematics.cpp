// Where a tool can be: all configurations for a pose, and random ones that hold it over a table.

#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/sample.h>

#include <array>
#include <iostream>
#include <numbers>

int main() {
  using namespace kaboum::kinematics;
  const double quarter = std::numbers::pi / 2;
  // Denavit-Hartenberg rows (theta, d, a, alpha), distal; lengths in metres.
  const std::array<kaboum::robot::Dh, 6> rows{{{0, .35, .085, -quarter},
                                               {-quarter, 0, .38, 0},
                                               {-quarter, 0, .1, -quarter},
                                               {0, .425, 0, quarter},
                                               {2 * quarter, 0, 0, quarter},
                                               {0, .085, 0, 0}}};
  const Arm arm = arm_of_distal(rows);
  const auto form = recognise(arm);
  if (!form) return 1;

  const Transform target = forward(arm, std::array{0.3, 0.4, 1.2, 0.7, 0.5, -0.2});
  const Solutions found = solve(*form, target);
  std::cout << found.size() << " configurations put the tool at (" << target.translation.transpose()
            << ")\n";

  ConstraintProblem problem;
  problem.robots = {{arm, {}}};
  const FrameId tool{FrameId::Kind::Tool, 0}, world;
  problem.constraints = {
      {Relation::Angle, {tool, Line{}}, {world, Line{}}, std::numbers::pi},  // it points down
      {Relation::Distance, {tool, Point{}}, {world, Plane{}}, 0.1}};
  ConstraintSampler sampler(problem);
  const auto sample = sampler.next();
  if (!sample) return 1;
  std::cout << "one of those that hold it over the table:";
  for (const double q : sample->at.joints[0]) std::cout << ' ' << q;
  std::cout << '\n';
  return found.size() == 4 ? 0 : 1;
}
