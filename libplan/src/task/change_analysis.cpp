// Which ground atoms and terms can change at all: only they take room in a state.
#include "task/change_analysis.h"

#include <kaboum/base/error.h>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumVisits = 2'000'000;  // bindings looked at to find what can change
constexpr std::size_t kMaximumGroups = 100'000;    // entries of Kx, once ground

template <class Visit>
void for_each_update(const std::vector<Effect>& effects, const Visit& visit) {
  for (const Effect& e : effects) {
    if (e.kind == Effect::Kind::Update) {
      visit(e.update);
    } else {
      for_each_update(e.children, visit);
    }
  }
}

}  // namespace

ChangeAnalysis::ChangeAnalysis(const Model& model, const Numbering& numbering, Limits& limits)
    : atom_changes(numbering.atoms(), 0),
      term_changes(numbering.terms(), 0),
      atom_constants(numbering.atoms(), AtomKnowledge::Unknown),
      term_constants(numbering.terms(), kNone),
      function_exclusions(model.functions.size(), 0),
      model_(model),
      numbering_(numbering),
      limits_(limits),
      predicate_changes_(model.predicates.size(), 0),
      function_changes_(model.functions.size(), 0),
      open_symbols_(model.predicates.size(), 0) {
  for (const Action& a : model.actions)
    for_each_update(a.effects, [&](const Update& u) { scan(u, false); });
  initial_constants();
  close_constants();
  for (const Action& a : model.actions) mark_action(a);
  if (visits_ > kMaximumVisits) mark_all();
}

/// Which symbols some update names; whether anything is sensed.
void ChangeAnalysis::scan(const Update& u, bool initial) {
  using D = Update::Database;
  if (u.database == D::Kw || u.database == D::Kv) sensing |= u.add;
  if (u.database == D::Lcw && u.add && !initial) sensing = true;
  for (const Update::Literal& l : u.literals) {
    if (l.function && (u.database == D::Kx || (u.database == D::Kf && l.negated)))
      function_exclusions[l.symbol] = 1;
    if (!initial) (l.function ? function_changes_ : predicate_changes_)[l.symbol] = 1;
  }
}

void ChangeAnalysis::mark(const Update::Literal& l, const Index* slots) {
  std::vector<Index> arguments;
  for (const Argument& a : l.arguments) arguments.push_back(value_of(a, slots));
  const std::size_t n = number(l, arguments.data());
  if (n != kNone) (l.function ? term_changes : atom_changes)[n] = 1;
}

void ChangeAnalysis::mark_update(const Update& u, const Index* slots) {
  for (const Update::Literal& l : u.literals) mark(l, slots);
  if (u.database != Update::Database::Kx || u.literals[0].function) return;
  std::vector<Atom> atoms;
  for (const Update::Literal& l : u.literals) {
    std::vector<Index> arguments;
    for (const Argument& a : l.arguments) arguments.push_back(value_of(a, slots));
    atoms.emplace_back(l.symbol, std::move(arguments));
  }
  group_atoms.push_back(std::move(atoms));
  if (group_atoms.size() > kMaximumGroups)
    throw Error(ErrorCode::LimitReached, "too many entries of Kx");
}

void ChangeAnalysis::mark_effects(const std::vector<Effect>& effects, std::vector<Index>& slots) {
  for (const Effect& e : effects) {
    limits_.work();
    if (++visits_ > kMaximumVisits) return;
    if (e.kind == Effect::Kind::Update) {
      mark_update(e.update, slots.data());
    } else if (e.kind == Effect::Kind::When) {
      mark_effects(e.children, slots);
    } else {
      for (const Index o : model_.types[e.type].objects) {
        slots[e.slot] = o;
        mark_effects(e.children, slots);
      }
    }
  }
}

/// A conjunct that only constant knowledge decides.
bool ChangeAnalysis::is_constant(const Query& q) const {
  switch (q.kind) {
    case Query::Kind::Known:
    case Query::Kind::KnowWhether:
      return !predicate_changes_[q.symbol];
    case Query::Kind::Not:
      return is_constant(q.children[0]);
    case Query::Kind::Same:
      return true;
    default:
      return false;
  }
}

/// Certainly false of the constant knowledge that initial Kf entries give. Atoms in Kw or Kx are
/// not constant: unknown is then no proof, so symbols with such entries are skipped.
bool ChangeAnalysis::refuted(const Query& q, const Index* slots) const {
  if (q.kind == Query::Kind::Not) {
    const Query& c = q.children[0];
    if (c.kind == Query::Kind::Same)
      return value_of(c.arguments[0], slots) == value_of(c.arguments[1], slots);
    if (c.kind != Query::Kind::Known || open_symbols_[c.symbol]) return false;
    return holds(c, slots);
  }
  if (q.kind == Query::Kind::Same)
    return value_of(q.arguments[0], slots) != value_of(q.arguments[1], slots);
  if (q.kind != Query::Kind::Known || open_symbols_[q.symbol]) return false;
  return !holds(q, slots);
}

bool ChangeAnalysis::holds(const Query& q, const Index* slots) const {
  std::vector<Index> arguments;
  for (const Argument& a : q.arguments) arguments.push_back(value_of(a, slots));
  const std::size_t n = numbering_.atom(q.symbol, arguments.data());
  if (n == kNone) return false;
  return atom_constants[n] == (q.negated ? AtomKnowledge::False : AtomKnowledge::True);
}

void ChangeAnalysis::mark_action(const Action& a) {
  struct Check {
    const Query* query;
    Index depth;
  };
  std::vector<Check> checks;
  for (const Query* q : conjuncts(a.precondition)) {
    if (!is_constant(*q)) continue;
    const auto free = free_slots(*q);
    checks.push_back({q, free.empty() ? 0 : free.back() + 1});
  }
  std::vector<Index> slots(a.slots, 0);
  const auto visit = [&](const auto& self, Index depth) -> void {
    for (const Check& c : checks)
      if (c.depth == depth && refuted(*c.query, slots.data())) return;
    if (depth == a.parameters.size()) {
      mark_effects(a.effects, slots);
      return;
    }
    for (const Index o : model_.types[a.parameters[depth].type].objects) {
      limits_.work();
      if (++visits_ > kMaximumVisits) return;
      slots[depth] = o;
      self(self, depth + 1);
    }
  };
  visit(visit, 0);
}

void ChangeAnalysis::initial_constants() {
  for (const Update& u : model_.initial) {
    scan(u, true);
    if (u.database == Update::Database::Kx || u.database == Update::Database::Kw)
      for (const Update::Literal& l : u.literals)
        if (!l.function) open_symbols_[l.symbol] = 1;
    if (u.database == Update::Database::Lcw) continue;
    const Update::Literal& l = u.literals[0];
    std::vector<Index> arguments;
    for (const Argument& a : l.arguments) arguments.push_back(a.index);
    if (u.database != Update::Database::Kf || (l.function && l.negated)) {
      mark_update(u, nullptr);  // disjunctive or sensed knowledge, or f != c: not constant
      continue;
    }
    const std::size_t n = number(l, arguments.data());
    ensure(n != kNone, "initial knowledge outside its types");
    if (l.function) {
      term_constants[n] = l.value->index;
    } else {
      atom_constants[n] = l.negated ? AtomKnowledge::False : AtomKnowledge::True;
    }
  }
}

/// What closing leaves unstated is false.
void ChangeAnalysis::close_constants() {
  for (const Update& u : model_.initial) {
    if (u.database != Update::Database::Lcw) continue;
    std::vector<Index> arguments;
    for (const Argument& a : u.literals[0].arguments) arguments.push_back(a.index);
    const Index p = u.literals[0].symbol;
    const std::size_t n = numbering_.atom(p, arguments.data());
    if (atom_constants[n] == AtomKnowledge::Unknown) atom_constants[n] = AtomKnowledge::False;
  }
}

/// Too many bindings to look at: everything named by an effect may change.
void ChangeAnalysis::mark_all() {
  const auto all = [](const std::vector<std::size_t>& first, const std::vector<char>& symbols,
                      std::vector<char>& changes) {
    for (std::size_t s = 0; s < symbols.size(); ++s)
      for (std::size_t n = first[s]; n < first[s + 1]; ++n) changes[n] |= symbols[s];
  };
  all(numbering_.first_atom(), predicate_changes_, atom_changes);
  all(numbering_.first_term(), function_changes_, term_changes);
  for (const Action& a : model_.actions)
    for_each_update(a.effects, [](const Update& u) {
      if (u.database == Update::Database::Kx && !u.literals[0].function)
        throw Error(ErrorCode::LimitReached, "too many action instances for effects on Kx");
    });
}

}  // namespace kaboum::plan
