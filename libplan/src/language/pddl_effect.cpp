// What effects of PDDL mean here: the order of additions and deletions, and conditional effects
// whose condition is not known.
#include "language/pddl_effect.h"

namespace kaboum::plan {
namespace {

using syntax::Effect;
using syntax::Formula;

/// The deletions, or all others.
std::vector<Effect> part(const std::vector<Effect>& list, bool deletions) {
  std::vector<Effect> out;
  for (const Effect& e : list) {
    if (e.kind == Effect::Kind::When || e.kind == Effect::Kind::ForAll) {
      Effect copy = e;
      copy.children = part(e.children, deletions);
      if (!copy.children.empty()) out.push_back(std::move(copy));
    } else if ((e.formulas.at(0).kind == Formula::Kind::Not) == deletions) {
      out.push_back(e);
    }
  }
  return out;
}

}  // namespace

std::vector<Effect> pddl::additions_last(const std::vector<Effect>& effects) {
  std::vector<Effect> all = part(effects, true);
  for (Effect& e : part(effects, false)) all.push_back(std::move(e));
  return all;
}

void pddl::decide_in_world(std::vector<Effect>& effects) {
  for (Effect& e : effects) {
    decide_in_world(e.children);
    e.of_world = e.kind == Effect::Kind::When;
  }
}

}  // namespace kaboum::plan
