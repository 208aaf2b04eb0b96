// A plan that senses, checked by code that shares nothing with the planner.

#include <kaboum/plan/check.h>
#include <kaboum/plan/load.h>
#include <kaboum/plan/solve.h>

#include <iostream>

int main() {
  using namespace kaboum;
  const plan::Text door{"door.kpl", R"(
domain door
predicates: open, inside
action look()
  effects: add(Kw, open)
action unlock()
  preconds: K(!open)
  effects: add(Kf, open)
action enter()
  preconds: K(open)
  effects: add(Kf, inside)
init: K(!inside)
goal: K(inside)
)",
                        plan::Language::Kpl};
  const plan::Model model = plan::load(door, nullptr);
  const plan::Solution solution = plan::solve(model, {});
  if (solution.outcome != plan::Outcome::Solved) return 1;
  const plan::CheckResult check = plan::check(model, solution.plan);
  std::cout << solution.plan.nodes.size() << " steps; every outcome of sensing leads to the goal: "
            << (check.valid ? "yes" : check.violation) << '\n';
  return check.valid ? 0 : 1;
}
