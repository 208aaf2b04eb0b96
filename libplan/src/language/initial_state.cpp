// The initial knowledge: entries one by one, then the atoms that closing predicates makes false.
#include "language/initial_state.h"

#include "language/numbers.h"

namespace kaboum::plan {
namespace {

namespace sx = syntax;

constexpr std::size_t kMaximumInitial = 5'000'000;  // entries, once ground

}  // namespace

void InitialState::declare(const sx::Document& document) {
  std::vector<Update> closed;
  for (const sx::Effect& e : document.initial) {
    if (resolve_number(e, terms_, model_.numbers)) continue;
    Scope scope;
    scope.location = e.location;
    Effect r = effects_.effect(e, scope);
    std::vector<Index> values(scope.slots, 0);
    expand(r, values, e.location, e.database == sx::Database::Lcw ? closed : model_.initial);
  }
  declare_unknown(document);
  for (const sx::Name& name : document.closed) {
    if (name.text == "all" && !terms_.symbols().is_predicate("all")) {
      for (Index p = 0; p < model_.predicates.size(); ++p) close_predicate(p, {}, closed);
      continue;
    }
    close_predicate(terms_.symbols().predicate(name), {}, closed);
  }
  for (Update& u : closed) model_.initial.push_back(std::move(u));
}

void InitialState::declare_unknown(const sx::Document& document) {
  for (const Update& u : model_.initial)
    if (u.database == Update::Database::Or)
      for (const Update::Literal& l : u.literals) {
        std::vector<Index> key = {l.symbol};
        for (const Argument& a : l.arguments) key.push_back(a.index);
        unknown_.insert(std::move(key));
      }
  for (const sx::Formula& f : document.unknown) {
    Scope none;
    std::vector<Unfolded> unfolded;
    Update::Literal l = effects_.literal(f, false, none, unfolded);
    if (l.function || l.negated || !unfolded.empty())
      f.location.fail("'unknown' takes atoms of constants");
    std::vector<Index> key = {l.symbol};
    for (const Argument& a : l.arguments) key.push_back(a.index);
    unknown_.insert(std::move(key));
  }
}

void InitialState::close_predicate(Index predicate, std::vector<Argument> prefix,
                                   std::vector<Update>& out) {
  const Symbol& s = model_.predicates[predicate];
  if (prefix.size() == s.parameters.size()) {
    std::vector<Index> key = {predicate};
    for (const Argument& a : prefix) key.push_back(a.index);
    if (unknown_.contains(key)) return;
    if (out.size() > kMaximumInitial)
      throw Error(ErrorCode::LimitReached, "too many atoms of closed predicates");
    Update u;
    u.database = Update::Database::Lcw;
    u.literals.push_back({false, false, predicate, prefix, {}});
    out.push_back(std::move(u));
    return;
  }
  for (const Index o : model_.types[s.parameters[prefix.size()]].objects) {
    prefix.push_back({false, o});
    close_predicate(predicate, prefix, out);
    prefix.pop_back();
  }
}

/// Ground updates of an initial entry: only the quantification of LCW patterns may remain.
void InitialState::expand(const Effect& e, std::vector<Index>& values,
                          const SourceLocation& location, std::vector<Update>& out) const {
  if (e.kind == Effect::Kind::When) location.fail("an initial entry's arguments are constants");
  if (e.kind == Effect::Kind::ForAll) {
    for (const Index o : model_.types[e.type].objects) {
      values[e.slot] = o;
      for (const Effect& child : e.children) expand(child, values, location, out);
    }
    return;
  }
  if (out.size() > kMaximumInitial) location.fail("too many instances");
  Update u = e.update;
  for (Update::Literal& l : u.literals) {
    for (Argument& a : l.arguments)
      if (a.variable) a = {false, values[a.index]};
    if (l.value && l.value->term) location.fail("an initial entry's value is a constant");
    if (l.value && l.value->variable) l.value = Argument{false, values[l.value->index]};
  }
  out.push_back(std::move(u));
}

}  // namespace kaboum::plan
