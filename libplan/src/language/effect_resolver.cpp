// Effects: updates of the databases Kf, Kw, Kv, Kx and LCW, their conditions and quantifiers.
#include "language/effect_resolver.h"

#include "language/unfolding.h"

namespace kaboum::plan {
namespace {

namespace sx = syntax;

/// `children` for every object of the slot's type.
Effect for_all(const std::pair<Index, Index>& slot, std::vector<Effect> children) {
  Effect all;
  all.kind = Effect::Kind::ForAll;
  all.slot = slot.first;
  all.type = slot.second;
  all.children = std::move(children);
  return all;
}

/// A query as one of the world, where all is known: K(p) stands for p, !K(p) for !p. The result, or
/// its negation if not `positive`, has literals below its connectives.
Query of_world(const Query& q, bool positive, const SourceLocation& location) {
  using K = Query::Kind;
  Query out = q;
  switch (q.kind) {
    case K::True:
    case K::KnowWhether:
    case K::WhetherValue:
    case K::KnowValue:
      out = {};
      out.kind = positive ? K::True : K::False;
      return out;
    case K::False:
      out.kind = positive ? K::False : K::True;
      return out;
    case K::And:
    case K::Or:
      out.kind = (q.kind == K::And) == positive ? K::And : K::Or;
      break;
    case K::Exists:
    case K::ForAll:
      out.kind = (q.kind == K::Exists) == positive ? K::Exists : K::ForAll;
      break;
    case K::Not:
      return of_world(q.children[0], !positive, location);
    case K::Known:
    case K::KnownValue:
    case K::Derived:
      out.negated = q.negated != !positive;
      return out;
    case K::Same:
      return positive ? out : negation(std::move(out));
    case K::Xor:
    case K::External:
    case K::Let:
      location.fail("a condition of the world has neither 'xor' nor external functions");
  }
  for (Query& c : out.children) c = of_world(c, positive, location);
  return out;
}

}  // namespace

Update::Literal EffectResolver::literal(const sx::Formula& f, bool negated, Scope& scope,
                                        std::vector<Unfolded>& unfolded) const {
  using K = sx::Formula::Kind;
  if (f.kind == K::Not) return literal(f.children.at(0), !negated, scope, unfolded);
  Update::Literal l;
  if (f.kind == K::Atom) {
    const sx::Term& t = f.terms.at(0);
    Query q = queries_.atom(t, scope, unfolded);
    if (q.kind == Query::Kind::Derived)
      t.name.location.fail("'" + t.name.text +
                           "' is derived by rules: no effect and no initial entry can set it");
    l.symbol = q.symbol;
    l.arguments = std::move(q.arguments);
    l.negated = negated;
    return l;
  }
  if (f.kind != K::Equal && f.kind != K::NotEqual)
    f.location.fail("a database holds atoms, equalities of a function, and their negations");
  const bool swapped = !symbols().function_of(f.terms.at(0));
  const sx::Term& left = f.terms.at(swapped ? 1 : 0);
  const sx::Term& right = f.terms.at(swapped ? 0 : 1);
  const Index* function = symbols().function_of(left);
  if (function == nullptr) left.name.location.fail("unknown function '" + left.name.text + "'");
  const Symbol& s = model().functions[*function];
  if (s.numeric)
    left.name.location.fail("'" + left.name.text +
                            "' is a number; only the initial state gives its value");
  l.function = true;
  l.symbol = *function;
  l.arguments = terms_.arguments(left, s, scope, unfolded);
  l.value = terms_.argument(right, s.range, scope, unfolded);
  l.negated = (f.kind == K::NotEqual) != negated;
  if (l.negated && symbols().is_handle(s.range))
    left.name.location.fail("of a handle only the value itself is kept, not what it is not");
  return l;
}

Update EffectResolver::update(const sx::Effect& e, Scope& scope,
                              std::vector<Unfolded>& unfolded) const {
  Update u;
  u.add = e.kind != sx::Effect::Kind::Delete;
  u.maybe = e.kind == sx::Effect::Kind::Maybe;
  u.database = static_cast<Update::Database>(e.database);
  const sx::Formula& first = e.formulas.at(0);
  const auto refuse_handle = [&] {
    const Update::Literal& l = u.literals[0];
    if ((!u.add || u.maybe) && l.function && symbols().is_handle(model().functions[l.symbol].range))
      first.location.fail("a handle is given up whatever it is: del(Kv, ...)");
  };
  switch (e.database) {
    case sx::Database::Kf:
    case sx::Database::Lcw:
      u.literals.push_back(literal(first, false, scope, unfolded));
      refuse_handle();
      break;
    case sx::Database::Kw:
      u.literals.push_back(literal(first, false, scope, unfolded));
      u.literals[0].negated = false;
      if (u.literals[0].function)
        first.location.fail("Kw holds atoms; the value of a function belongs to Kv");
      break;
    case sx::Database::Kv: {
      if (first.kind != sx::Formula::Kind::Atom || !symbols().function_of(first.terms.at(0)))
        first.location.fail("Kv holds a function term");
      const sx::Term& t = first.terms.at(0);
      Update::Literal l;
      l.function = true;
      l.symbol = *symbols().function_of(t);
      if (model().functions[l.symbol].numeric)
        t.name.location.fail("'" + t.name.text + "' is a number, never sensed");
      if (u.add && symbols().is_handle(model().functions[l.symbol].range))
        t.name.location.fail("'" + t.name.text + "' is a handle, never sensed");
      l.arguments = terms_.arguments(t, model().functions[l.symbol], scope, unfolded);
      u.literals.push_back(std::move(l));
      break;
    }
    case sx::Database::Kx:
      exclusive(e, u, scope, unfolded);
      break;
    case sx::Database::Or:
      for (const sx::Formula& f : e.formulas) {
        u.literals.push_back(literal(f, false, scope, unfolded));
        if (u.literals.back().function)
          f.location.fail("an alternative of Or is an atom or its negation");
      }
      break;
  }
  return u;
}

void EffectResolver::exclusive(const sx::Effect& e, Update& u, Scope& scope,
                               std::vector<Unfolded>& unfolded) const {
  if (e.formulas.size() < 2) e.location.fail("Kx needs two or more alternatives: Kx, a | b");
  for (const sx::Formula& f : e.formulas) {
    u.literals.push_back(literal(f, false, scope, unfolded));
    const Update::Literal& l = u.literals.back();
    if (l.function && symbols().is_handle(model().functions[l.symbol].range))
      f.location.fail("alternatives of Kx are never handles");
    if (l.negated) f.location.fail("an alternative of Kx is an atom or f(x) = c, not a negation");
    if (l.function != u.literals[0].function)
      f.location.fail(
          "the alternatives of one Kx entry are all atoms or all values of one function");
    if (l.function && l.symbol != u.literals[0].symbol)
      f.location.fail("the alternatives of one Kx entry are values of one function term");
    if (l.function)
      for (std::size_t i = 0; i < l.arguments.size(); ++i)
        if (l.arguments[i].variable != u.literals[0].arguments[i].variable ||
            l.arguments[i].index != u.literals[0].arguments[i].index)
          f.location.fail("the alternatives of one Kx entry are values of one function term");
  }
}

Effect EffectResolver::update_effect(const sx::Effect& e, Scope& scope) const {
  const std::size_t outer = scope.variables.size();
  BoundSlots wildcards;
  if (e.database == sx::Database::Lcw) {
    if (e.formulas.at(0).kind != sx::Formula::Kind::Atom)
      e.formulas[0].location.fail("LCW(...) holds an atom");
    wildcards = queries_.bind_wildcards(e.formulas[0].terms.at(0), scope);
  }
  std::vector<Unfolded> unfolded;
  Effect result;
  result.update = update(e, scope, unfolded);
  scope.variables.resize(outer);
  for (const auto& slot : wildcards) {
    std::vector<Effect> children;
    children.push_back(std::move(result));
    result = for_all(slot, std::move(children));
  }
  return wrap(std::move(unfolded), std::move(result));
}

Effect EffectResolver::effect(const sx::Effect& e, Scope& scope) const {
  switch (e.kind) {
    case sx::Effect::Kind::Add:
    case sx::Effect::Kind::Maybe:
    case sx::Effect::Kind::Delete:
      return update_effect(e, scope);
    case sx::Effect::Kind::When: {
      Effect result;
      result.kind = Effect::Kind::When;
      result.condition = queries_.query(e.formulas.at(0), scope);
      if (e.of_world) {
        const Query said = std::move(result.condition);
        result.of_world = true;
        result.condition = of_world(said, true, e.location);
        result.denial = of_world(said, false, e.location);
      }
      for (const sx::Effect& child : e.children) result.children.push_back(effect(child, scope));
      return result;
    }
    case sx::Effect::Kind::ForAll: {
      const std::size_t outer = scope.variables.size();
      const BoundSlots slots = queries_.bind(e.variables, scope);
      std::vector<Effect> children;
      for (const sx::Effect& child : e.children) children.push_back(effect(child, scope));
      scope.variables.resize(outer);
      for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
        Effect all = for_all(*slot, std::move(children));
        children.clear();
        children.push_back(std::move(all));
      }
      return std::move(children.at(0));
    }
  }
  e.location.fail("unexpected effect");
}

}  // namespace kaboum::plan
