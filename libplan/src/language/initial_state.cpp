// The initial knowledge: entries one by one, then the atoms that closing predicates makes false.
#include "language/initial_state.h"

#include <algorithm>

#include "language/numbers.h"

namespace kaboum::plan {
namespace {

namespace sx = syntax;

constexpr std::size_t kMaximumInitial = 5'000'000;  // entries, once ground
/// Predicates with more atoms are closed only where that matters.
constexpr double kManyAtoms = 1'000'000;

/// Whether it may matter to a query if an atom that no step changes is false, or not known to be
/// true.
bool tells_false(const Query& q, Index predicate) {
  using K = Query::Kind;
  if ((q.kind == K::KnowWhether || (q.kind == K::Known && q.negated)) && q.symbol == predicate)
    return true;
  return std::ranges::any_of(q.children,
                             [&](const Query& child) { return tells_false(child, predicate); });
}

/// The same of effects; also where one of them changes the predicate.
bool tells_false(const std::vector<Effect>& effects, Index predicate) {
  return std::ranges::any_of(effects, [&](const Effect& e) {
    if (e.kind == Effect::Kind::Update)
      return std::ranges::any_of(e.update.literals, [&](const Update::Literal& l) {
        return !l.function && l.symbol == predicate;
      });
    return e.of_world || tells_false(e.condition, predicate) || tells_false(e.children, predicate);
  });
}

/// Whether plans may depend on the predicate's atoms being false, rather than not known to be true.
bool closing_matters(const Model& model, Index predicate) {
  const auto reads = [](const ExternalFunction& f) { return f.reads_state; };
  return std::ranges::any_of(model.external_functions, reads) ||
         tells_false(model.goal, predicate) ||
         std::ranges::any_of(model.rules,
                             [&](const Rule& r) { return tells_false(r.body, predicate); }) ||
         std::ranges::any_of(model.actions, [&](const Action& a) {
           return tells_false(a.precondition, predicate) || tells_false(a.effects, predicate);
         });
}

double atoms_of(const Model& model, Index predicate) {
  double out = 1;
  for (const Index t : model.predicates[predicate].parameters)
    out *= static_cast<double>(model.types[t].objects.size());
  return out;
}

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
  const bool world = closes_world(document);
  for (const sx::Name& name : document.closed)
    if (name.text != "all" || terms_.symbols().is_predicate("all"))
      close(terms_.symbols().predicate(name), closed);
  for (Index p = 0; world && p < model_.predicates.size(); ++p) close(p, closed);
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

void InitialState::close(Index predicate, std::vector<Update>& out) {
  if (model_.predicates[predicate].derived()) return;
  if (atoms_of(model_, predicate) <= kManyAtoms || closing_matters(model_, predicate))
    close_predicate(predicate, {}, out);
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
