// Least fixed points of rules in a state, level by level: what comes to hold wakes the atoms whose
// rules read it.
#include "task/derived_atoms.h"

#include <algorithm>
#include <set>

#include "task/formula_evaluator.h"

namespace kaboum::plan {
namespace {

using Kind = FormulaPool::Kind;

/// What stands at the ends of a formula.
template <class Visit>
void for_each_leaf(const FormulaPool& pool, Formula f, std::set<Formula>& seen,
                   const Visit& visit) {
  if (!seen.insert(f).second) return;
  const FormulaPool::Node& n = pool.node(f);
  const bool connective =
      n.kind == Kind::And || n.kind == Kind::Or || n.kind == Kind::Xor || n.kind == Kind::Not;
  if (!connective) return visit(n);
  for (const Formula* c = pool.begin(f); c != pool.end(f); ++c)
    for_each_leaf(pool, *c, seen, visit);
}

}  // namespace

Index DerivedAtoms::add(Index level, bool recursive) {
  const auto atom = static_cast<Index>(atoms_.size());
  atoms_.push_back({level, recursive, kFalse, {}});
  truth_.push_back(0);
  waiting_.push_back(0);
  if (levels_.size() <= level) levels_.resize(level + 1);
  levels_[level].atoms.push_back(atom);
  levels_[level].known = false;
  return atom;
}

void DerivedAtoms::define(Index atom, Formula body) {
  atoms_[atom].body = body;
  Level& level = levels_[atoms_[atom].level];
  level.known = false;
  std::set<Formula> seen;
  for_each_leaf(pool_, body, seen, [&](const FormulaPool::Node& n) {
    if (n.kind != Kind::Derived) return;
    Atom& read = atoms_[n.a];
    if (read.level == atoms_[atom].level) {
      read.users.push_back(atom);
      return;
    }
    const auto at = std::lower_bound(level.below.begin(), level.below.end(), read.level);
    if (at == level.below.end() || *at != read.level) level.below.insert(at, read.level);
  });
}

/// The level and those below that it rests on, if not `all` only those not known; ascending.
std::vector<Index> DerivedAtoms::needed(Index level, bool all) const {
  std::vector<Index> todo = {level};
  std::set<Index> found = {level};
  while (!todo.empty()) {
    const Index l = todo.back();
    todo.pop_back();
    for (const Index b : levels_[l].below)
      if ((all || !levels_[b].known) && found.insert(b).second) todo.push_back(b);
  }
  return {found.begin(), found.end()};
}

bool DerivedAtoms::holds(Index atom, const Word* state, const FormulaEvaluator& evaluator) {
  if (working_) return truth_[atom] != 0;
  if (!std::equal(state_.begin(), state_.end(), state) || state_.empty()) {
    state_.assign(state, state + layout_.words());
    for (Level& l : levels_) l.known = false;
  }
  if (levels_[atoms_[atom].level].known) return truth_[atom] != 0;
  working_ = true;
  for (const Index l : needed(atoms_[atom].level, false)) work_out(levels_[l], state, evaluator);
  working_ = false;
  return truth_[atom] != 0;
}

void DerivedAtoms::work_out(Level& level, const Word* state, const FormulaEvaluator& evaluator) {
  for (const Index a : level.atoms) {
    truth_[a] = 0;
    waiting_[a] = 1;
  }
  std::vector<Index> queue(level.atoms.rbegin(), level.atoms.rend());
  while (!queue.empty()) {
    const Index a = queue.back();
    queue.pop_back();
    waiting_[a] = 0;
    if (!evaluator.holds(atoms_[a].body, state)) continue;
    truth_[a] = 1;
    for (const Index u : atoms_[a].users) {
      if (truth_[u] != 0 || waiting_[u] != 0) continue;
      waiting_[u] = 1;
      queue.push_back(u);
    }
  }
  level.known = true;
}

std::vector<Index> DerivedAtoms::fluents(Index atom) const {
  std::set<Index> all;
  std::set<Formula> seen;
  for (const Index l : needed(atoms_[atom].level, true))
    for (const Index a : levels_[l].atoms)
      for_each_leaf(pool_, atoms_[a].body, seen, [&](const FormulaPool::Node& n) {
        if (n.kind != Kind::Derived && n.kind != Kind::True && n.kind != Kind::False)
          all.insert(n.a);
      });
  return {all.begin(), all.end()};
}

}  // namespace kaboum::plan
