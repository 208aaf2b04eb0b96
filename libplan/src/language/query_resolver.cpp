// Queries on knowledge: K, Kw, Kv, LCW, extern, and what connects them.
#include "language/query_resolver.h"

namespace kaboum::plan {

namespace sx = syntax;

Query QueryResolver::query(const sx::Formula& f, Scope& scope) const {
  using K = sx::Formula::Kind;
  Query q;
  switch (f.kind) {
    case K::True:
      return q;
    case K::False:
      q.kind = Query::Kind::False;
      return q;
    case K::And:
    case K::Or:
    case K::Xor:
    case K::Not:
      q.kind = f.kind == K::And   ? Query::Kind::And
               : f.kind == K::Or  ? Query::Kind::Or
               : f.kind == K::Xor ? Query::Kind::Xor
                                  : Query::Kind::Not;
      for (const sx::Formula& child : f.children) q.children.push_back(query(child, scope));
      return q;
    case K::Exists:
    case K::ForAll:
      return quantified(f, f.kind == K::Exists ? Query::Kind::Exists : Query::Kind::ForAll, scope);
    case K::Known:
      return known(f.children.at(0), false, scope);
    case K::KnowWhether:
      return know_whether(f.children.at(0), scope);
    case K::KnowValue:
      return know_value(f, scope);
    case K::ClosedWorld:
      return closed_world(f, scope);
    case K::Extern:
      return external_condition(f.terms.at(0), scope);
    case K::Equal:
    case K::NotEqual:
      return equality(f, f.kind == K::NotEqual, scope);
    case K::Let:
      f.location.fail("'let' stands among the conjuncts of an action's precondition");
    case K::Atom:
      f.location.fail("a query needs its operator: K(...), Kw(...) or Kv(...)");
  }
  f.location.fail("unexpected formula");
}

Query QueryResolver::precondition(const sx::Formula& f, Scope& scope) const {
  if (f.kind == sx::Formula::Kind::Let) return let(f, scope);
  if (f.kind != sx::Formula::Kind::And) return query(f, scope);
  Query q;
  q.kind = Query::Kind::And;
  for (const sx::Formula& child : f.children) q.children.push_back(precondition(child, scope));
  return q;
}

/// The variable is in scope from here on, in the effects too.
Query QueryResolver::let(const sx::Formula& f, Scope& scope) const {
  const sx::Term& call = f.terms.at(0);
  const sx::Name& name = f.variables.at(0).name;
  Query q;
  q.kind = Query::Kind::Let;
  q.symbol = symbols().external(call.name);
  const Symbol& g = model().externals[q.symbol];
  if (!symbols().is_handle(g.range))
    call.name.location.fail(
        g.range == kNone
            ? "'" + g.name + "' is a truth value: write extern(...) without 'let'"
            : "the values of '" + g.name + "' are enumerated: write a parameter ?" + name.text +
                  " and K(?" + name.text + " = extern(...)) instead of 'let'");
  if (scope.find(name.text) != nullptr)
    name.location.fail("'?" + name.text + "' is declared already");
  std::vector<Unfolded> unfolded;
  q.arguments = terms_.arguments(call, g, scope, unfolded);
  if (!unfolded.empty())
    call.name.location.fail(
        "the arguments of a call named by 'let' are constants, variables and "
        "terms of handle types");
  q.value = Argument{true, scope.fresh()};
  scope.variables.push_back({name.text, q.value->index, g.range});
  return q;
}

BoundSlots QueryResolver::bind(const std::vector<sx::TypedVariable>& variables,
                               Scope& scope) const {
  BoundSlots slots;
  for (const sx::TypedVariable& v : variables) {
    const Index slot = scope.fresh();
    slots.emplace_back(slot, symbols().enumerated_type(v.type));
    scope.variables.push_back({v.name.text, slot, slots.back().second});
  }
  return slots;
}

Query QueryResolver::quantified(const sx::Formula& f, Query::Kind kind, Scope& scope) const {
  const std::size_t outer = scope.variables.size();
  const BoundSlots slots = bind(f.variables, scope);
  Query inner = query(f.children.at(0), scope);
  scope.variables.resize(outer);
  for (auto s = slots.rbegin(); s != slots.rend(); ++s) {
    Query q;
    q.kind = kind;
    q.symbol = s->first;
    q.type = s->second;
    q.children.push_back(std::move(inner));
    inner = std::move(q);
  }
  return inner;
}

/// K(f), or K(!f) when negated.
Query QueryResolver::known(const sx::Formula& f, bool negated, Scope& scope) const {
  using K = sx::Formula::Kind;
  switch (f.kind) {
    case K::Not:
      return known(f.children.at(0), !negated, scope);
    case K::Equal:
    case K::NotEqual:
      return equality(f, (f.kind == K::NotEqual) != negated, scope);
    case K::Extern: {
      Query q = external_condition(f.terms.at(0), scope);
      return negated ? negation(std::move(q)) : q;
    }
    case K::Atom: {
      std::vector<Unfolded> unfolded;
      Query q = atom(f.terms.at(0), scope, unfolded);
      q.negated = negated;
      return wrap(std::move(unfolded), std::move(q));
    }
    default:
      f.location.fail("K(...) holds an atom, an equality, an extern(...), or the negation of one");
  }
}

Query QueryResolver::atom(const sx::Term& t, Scope& scope, std::vector<Unfolded>& unfolded) const {
  const Index* p = symbols().predicate_of(t);
  if (p == nullptr)
    t.name.location.fail(symbols().function_of(t)
                             ? "'" + t.name.text + "' is a function: compare it with '='"
                             : "unknown predicate '" + t.name.text + "'");
  Query q;
  q.kind = model().predicates[*p].derived() ? Query::Kind::Derived : Query::Kind::Known;
  q.symbol = *p;
  q.arguments = terms_.arguments(t, model().predicates[*p], scope, unfolded);
  return q;
}

Query QueryResolver::external_condition(const sx::Term& t, Scope& scope) const {
  const Index g = symbols().external(t.name);
  if (model().externals[g].range != kNone)
    t.name.location.fail("'" + t.name.text + "' has a value: compare it with '='");
  std::vector<Unfolded> unfolded;
  Query q;
  q.kind = Query::Kind::External;
  q.symbol = g;
  q.arguments = terms_.arguments(t, model().externals[g], scope, unfolded);
  return wrap(std::move(unfolded), std::move(q));
}

/// K(a = b) and K(a != b) in all their forms; the known side is looked up before an extern is
/// called.
Query QueryResolver::equality(const sx::Formula& f, bool negated, Scope& scope) const {
  const sx::Term* left = &f.terms.at(0);
  const sx::Term* right = &f.terms.at(1);
  // K(phi = extern(g(x))) with a predicate phi.
  if (right->kind != sx::Term::Kind::Extern && left->kind == sx::Term::Kind::Extern)
    std::swap(left, right);
  if (right->kind == sx::Term::Kind::Extern && symbols().predicate_of(*left) &&
      !symbols().function_of(*left)) {
    return predicate_equality(*left, *right, negated, scope);
  }
  if (right->kind != sx::Term::Kind::Extern && !terms_.is_plain(*right) && terms_.is_plain(*left))
    std::swap(left, right);
  std::vector<Unfolded> unfolded;
  Query q;
  if (terms_.is_plain(*left) && terms_.is_plain(*right)) {
    q.kind = Query::Kind::Same;
    for (const sx::Term* t : {left, right})
      if (const Scope::Variable* v = scope.find(t->name.text);
          t->kind == sx::Term::Kind::Variable && v != nullptr && symbols().is_handle(v->type))
        t->name.location.fail("values of a handle type are compared by an external function");
    q.arguments = {terms_.argument(*left, 0, scope, unfolded),
                   terms_.argument(*right, 0, scope, unfolded)};
    return negated ? negation(std::move(q)) : q;
  }
  if (left->kind == sx::Term::Kind::Extern || terms_.is_plain(*left)) {
    const bool call_is_right = terms_.is_plain(*left);
    return external_equality(call_is_right ? *right : *left, call_is_right ? *left : *right,
                             negated, scope);
  }
  return function_equality(*left, *right, negated, scope);
}

/// K(p = extern(g(x))) with a predicate p: both hold, or neither does.
Query QueryResolver::predicate_equality(const sx::Term& predicate, const sx::Term& external,
                                        bool negated, Scope& scope) const {
  std::vector<Unfolded> unfolded;
  Query p = atom(predicate, scope, unfolded);
  Query g = external_condition(external, scope);
  Query both, neither, either;
  both.kind = neither.kind = Query::Kind::And;
  either.kind = Query::Kind::Or;
  p.negated = negated;
  both.children = {g, p};
  p.negated = !negated;
  neither.children = {negation(std::move(g)), std::move(p)};
  either.children = {std::move(both), std::move(neither)};
  return wrap(std::move(unfolded), std::move(either));
}

Query QueryResolver::external_equality(const sx::Term& call, const sx::Term& other, bool negated,
                                       Scope& scope) const {
  std::vector<Unfolded> unfolded;
  Query q;
  const Index g = symbols().external(call.name);
  const Index range = model().externals[g].range;
  if (range == kNone)
    call.name.location.fail("'" + call.name.text + "' is a truth value, not an object");
  q.kind = Query::Kind::External;
  q.symbol = g;
  q.arguments = terms_.arguments(call, model().externals[g], scope, unfolded);
  q.value = terms_.argument(other, range, scope, unfolded, TermResolver::Typing::Related);
  require_plain(other, *q.value, range);
  if (negated) q = negation(std::move(q));
  return wrap(std::move(unfolded), std::move(q));
}

/// The negation of K(f(x) = c) is "known to differ".
Query QueryResolver::function_equality(const sx::Term& left, const sx::Term& right, bool negated,
                                       Scope& scope) const {
  std::vector<Unfolded> unfolded;
  Query q;
  const Index* function = symbols().function_of(left);
  if (function == nullptr) left.name.location.fail("unknown function '" + left.name.text + "'");
  if (model().functions[*function].numeric)
    left.name.location.fail("'" + left.name.text + "' is a number; numbers only serve as costs");
  q.kind = Query::Kind::KnownValue;
  q.symbol = *function;
  q.negated = negated;
  q.arguments = terms_.arguments(left, model().functions[*function], scope, unfolded);
  q.value = terms_.argument(right, model().functions[*function].range, scope, unfolded,
                            TermResolver::Typing::Related);
  require_plain(right, *q.value, model().functions[*function].range);
  return wrap(std::move(unfolded), std::move(q));
}

/// Handles are compared with constants only.
void QueryResolver::require_plain(const sx::Term& t, const Argument& a, Index type) const {
  if (symbols().is_handle(type) && (a.variable || a.term))
    t.name.location.fail(
        "values of a handle type are compared by an external function, or with a "
        "constant");
}

Query QueryResolver::know_whether(const sx::Formula& f, Scope& scope) const {
  using K = sx::Formula::Kind;
  if (f.kind == K::Not) return know_whether(f.children.at(0), scope);
  std::vector<Unfolded> unfolded;
  if (f.kind == K::Equal || f.kind == K::NotEqual) {
    Query q = equality(f, false, scope);
    Query* leaf = &q;
    while (leaf->kind == Query::Kind::Exists) leaf = &leaf->children.at(0).children.at(1);
    if (leaf->kind != Query::Kind::KnownValue)
      f.location.fail("Kw(...) of an equality needs a function of the state");
    leaf->kind = Query::Kind::WhetherValue;
    return q;
  }
  if (f.kind != K::Atom) f.location.fail("Kw(...) holds an atom or an equality");
  Query q = atom(f.terms.at(0), scope, unfolded);
  if (q.kind == Query::Kind::Derived)
    f.terms[0].name.location.fail("'" + f.terms[0].name.text + "' is derived: it is always known");
  q.kind = Query::Kind::KnowWhether;
  return wrap(std::move(unfolded), std::move(q));
}

Query QueryResolver::know_value(const sx::Formula& f, Scope& scope) const {
  const sx::Term& t = f.terms.at(0);
  const Index* function = symbols().function_of(t);
  if (function == nullptr)
    t.name.location.fail("Kv(...) needs a function; '" + t.name.text + "' is none");
  std::vector<Unfolded> unfolded;
  Query q;
  q.kind = Query::Kind::KnowValue;
  q.symbol = *function;
  q.arguments = terms_.arguments(t, model().functions[*function], scope, unfolded);
  return wrap(std::move(unfolded), std::move(q));
}

BoundSlots QueryResolver::bind_wildcards(const sx::Term& t, Scope& scope) const {
  const Index* p = symbols().predicate_of(t);
  if (p == nullptr) t.name.location.fail("unknown predicate '" + t.name.text + "'");
  BoundSlots slots;
  const Symbol& s = model().predicates[*p];
  for (std::size_t i = 0; i < t.arguments.size() && i < s.parameters.size(); ++i) {
    const sx::Term& a = t.arguments[i];
    if (a.kind != sx::Term::Kind::Variable || scope.find(a.name.text) != nullptr) continue;
    const Index slot = scope.fresh();
    scope.variables.push_back({a.name.text, slot, s.parameters[i]});
    slots.emplace_back(slot, s.parameters[i]);
  }
  return slots;
}

Query QueryResolver::closed_world(const sx::Formula& f, Scope& scope) const {
  const sx::Formula& pattern = f.children.at(0);
  if (pattern.kind != sx::Formula::Kind::Atom) pattern.location.fail("LCW(...) holds an atom");
  const std::size_t outer = scope.variables.size();
  const auto slots = bind_wildcards(pattern.terms.at(0), scope);
  Query inner = know_whether(pattern, scope);
  scope.variables.resize(outer);
  for (const auto& [slot, t] : slots) {
    Query all;
    all.kind = Query::Kind::ForAll;
    all.symbol = slot;
    all.type = t;
    all.children.push_back(std::move(inner));
    inner = std::move(all);
  }
  return inner;
}

}  // namespace kaboum::plan
