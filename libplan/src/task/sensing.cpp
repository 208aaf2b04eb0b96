// Which sensed values matter: to a change in a state, and to a task at all.
#include "task/sensing.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

/// What the entry would tell once sensed values are at hand must be concluded before it goes.
Index undecided_member(const Layout& layout, const Group& g, const Word* state) {
  for (std::size_t i = 0; i < g.members.size(); ++i) {
    if (((state[g.word] >> i) & 1U) == 0) continue;
    const Index m = g.members[i];
    if (layout.fluents()[m].get(state) == static_cast<Word>(AtomKnowledge::Whether)) return m;
    if (const Index tie = layout.sensed_tie(m, state); tie != kNone) return tie;
  }
  return kNone;
}

/// What Kx would conclude from an atom's value must be concluded before the atom changes.
Index undecided_in_groups(const Layout& layout, Index fluent, const Word* state) {
  const Fluent& f = layout.fluents()[fluent];
  if (f.groups.empty()) return kNone;
  const Word content = f.get(state);
  if (content == static_cast<Word>(AtomKnowledge::Unknown)) return layout.sensed_tie(fluent, state);
  if (content != static_cast<Word>(AtomKnowledge::Whether)) return kNone;
  const bool in_entry = std::any_of(f.groups.begin(), f.groups.end(), [&](const auto& g) {
    return ((state[layout.groups()[g.first].word] >> g.second) & 1U) != 0;
  });
  return in_entry ? fluent : kNone;
}

/// Symbols that the goal, preconditions and conditions of effects read.
struct ReadSymbols {
  std::vector<char> predicates, functions;

  explicit ReadSymbols(const Model& model)
      : predicates(model.predicates.size(), 0), functions(model.functions.size(), 0) {
    for (const ExternalFunction& f : model.external_functions)
      if (f.reads_state) {  // it may read anything
        predicates.assign(predicates.size(), 1);
        functions.assign(functions.size(), 1);
      }
    add(model.goal);
    for (const Action& a : model.actions) {
      add(a.precondition);
      add(a.effects);
    }
  }

 private:
  void add(const Query& q) {
    switch (q.kind) {
      case Query::Kind::Known:
      case Query::Kind::KnowWhether:
        predicates[q.symbol] = 1;
        break;
      case Query::Kind::KnownValue:
      case Query::Kind::WhetherValue:
      case Query::Kind::KnowValue:
        functions[q.symbol] = 1;
        break;
      default:
        break;
    }
    for (const Query& c : q.children) add(c);
  }
  void add(const std::vector<Effect>& effects) {
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::When) add(e.condition);
      add(e.children);
    }
  }
};

}  // namespace

Index undecided(const Layout& layout, const Change& c, const Word* state) {
  using K = Change::Kind;
  if (c.kind == K::DeleteGroup) return undecided_member(layout, layout.groups()[c.fluent], state);
  if (c.kind == K::AddGroup || c.kind == K::AddWhether || c.kind == K::AddClosed ||
      c.kind == K::AddSensed)
    return kNone;
  const Fluent& f = layout.fluents()[c.fluent];
  const Word content = f.get(state);
  switch (c.kind) {
    case K::DeleteTrue:
    case K::DeleteFalse:
    case K::DeleteClosed:
      if (content == static_cast<Word>(AtomKnowledge::Whether)) return c.fluent;
      break;
    case K::DeleteValue:
    case K::DeleteExclude:
    case K::Exclude:
    case K::AddOptions:
      return content == kValueSensed ? c.fluent : kNone;
    default:
      break;
  }
  return undecided_in_groups(layout, c.fluent, state);
}

std::vector<Index> sensible_fluents(const Model& model, const Layout& layout) {
  ReadSymbols read(model);
  std::vector<Index> sensible;
  for (Index i = 0; i < layout.fluents().size(); ++i) {
    const Fluent& f = layout.fluents()[i];
    // An atom in a disjunction may tell something of another that is read.
    if (!f.groups.empty() || (f.function ? read.functions : read.predicates)[f.symbol] != 0)
      sensible.push_back(i);
  }
  return sensible;
}

}  // namespace kaboum::plan
