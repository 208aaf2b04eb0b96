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

/// The effects as such that may happen.
std::vector<Effect> possibly(std::vector<Effect> effects) {
  std::vector<Effect> all;
  for (Effect& e : effects) {
    if (e.kind == Effect::Kind::When || e.kind == Effect::Kind::ForAll) {
      e.children = possibly(std::move(e.children));
      if (e.children.empty()) continue;
    } else if (e.database != syntax::Database::Kf) {
      continue;
    } else {
      e.kind = Effect::Kind::Maybe;
    }
    all.push_back(std::move(e));
  }
  return all;
}

}  // namespace

std::vector<Effect> pddl::additions_last(const std::vector<Effect>& effects) {
  std::vector<Effect> all = part(effects, true);
  for (Effect& e : part(effects, false)) all.push_back(std::move(e));
  return all;
}

std::vector<Effect> pddl::conditions_decided(const std::vector<Effect>& effects, bool incomplete) {
  std::vector<Effect> all;
  for (const Effect& e : effects) {
    Effect known = e;
    known.children = conditions_decided(e.children, incomplete);
    if (e.kind != Effect::Kind::When) {
      all.push_back(std::move(known));
      continue;
    }
    Effect unknown = known;
    known.formulas.resize(1);
    all.push_back(std::move(known));
    if (!incomplete) continue;
    unknown.children = possibly(std::move(unknown.children));
    if (unknown.children.empty()) continue;
    unknown.formulas = {make(Formula::Kind::And, e.location,
                             {make(Formula::Kind::Not, e.location, {e.formulas.at(0)}),
                              make(Formula::Kind::Not, e.location, {e.formulas.at(1)})})};
    all.push_back(std::move(unknown));
  }
  return all;
}

}  // namespace kaboum::plan
