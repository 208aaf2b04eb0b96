// Arguments: variables, constants, and nested terms, which are unfolded into variables of their
// own.
#include "language/term_resolver.h"

#include "language/plural.h"

namespace kaboum::plan {

namespace sx = syntax;

Argument TermResolver::argument(const sx::Term& t, Index wanted, Scope& scope,
                                std::vector<Unfolded>& unfolded, Typing typing) const {
  if (t.kind == sx::Term::Kind::Variable) {
    const Scope::Variable* v = scope.find(t.name.text);
    if (v == nullptr) t.name.location.fail("unknown variable '?" + t.name.text + "'");
    if (typing == Typing::Subtype || !symbols_.related(v->type, wanted))
      symbols_.check_type(t.name, v->type, wanted);
    return {true, v->slot};
  }
  if (t.kind == sx::Term::Kind::Name && !symbols_.function_of(t)) {
    if (symbols_.predicate_of(t) && !symbols_.is_constant(t.name))
      t.name.location.fail("'" + t.name.text + "' is a predicate, not a value");
    return {false, symbols_.object(t.name, wanted)};
  }
  return symbols_.is_handle(wanted) ? handle_term(t, wanted, scope)
                                    : unfold(t, wanted, scope, unfolded);
}

/// Not unfolded: the term is evaluated in the state.
Argument TermResolver::handle_term(const sx::Term& t, Index wanted, Scope& scope) const {
  if (t.kind == sx::Term::Kind::Extern)
    t.name.location.fail("a call that returns a handle is given a name first: let ?y = extern(" +
                         t.name.text + "...) in the precondition");
  const Index* f = symbols_.function_of(t);
  if (f == nullptr) t.name.location.fail("unknown function '" + t.name.text + "'");
  const Symbol& s = model().functions[*f];
  if (s.numeric) t.name.location.fail("'" + t.name.text + "' is a number, not a handle");
  symbols_.check_type(t.name, s.range, wanted);
  std::vector<Unfolded> inner;
  FunctionTerm term{*f, arguments(t, s, scope, inner)};
  if (!inner.empty())
    t.name.location.fail("the arguments of a handle's term are constants and variables");
  return {false, 0, std::make_shared<const FunctionTerm>(std::move(term))};
}

Argument TermResolver::unfold(const sx::Term& t, Index wanted, Scope& scope,
                              std::vector<Unfolded>& unfolded) const {
  Query condition;
  Index range = kNone;
  std::vector<Unfolded> inner;
  if (t.kind == sx::Term::Kind::Extern) {
    const Index g = symbols_.external(t.name);
    range = model().externals[g].range;
    if (range == kNone)
      t.name.location.fail("'" + t.name.text + "' is a truth value, not an object");
    condition.kind = Query::Kind::External;
    condition.symbol = g;
    condition.arguments = arguments(t, model().externals[g], scope, inner);
  } else {
    const Index* f = symbols_.function_of(t);
    if (f == nullptr) t.name.location.fail("unknown function '" + t.name.text + "'");
    range = model().functions[*f].range;
    if (model().functions[*f].numeric)
      t.name.location.fail("'" + t.name.text + "' is a number, not an object");
    condition.kind = Query::Kind::KnownValue;
    condition.symbol = *f;
    condition.arguments = arguments(t, model().functions[*f], scope, inner);
  }
  if (!symbols_.related(range, wanted)) symbols_.check_type(t.name, range, wanted);
  const Index slot = scope.fresh();
  condition.value = Argument{true, slot};
  for (Unfolded& u : inner) unfolded.push_back(std::move(u));
  unfolded.push_back(
      {slot, symbols_.is_subtype(wanted, range) ? wanted : range, std::move(condition)});
  return {true, slot};
}

std::vector<Argument> TermResolver::arguments(const sx::Term& t, const Symbol& s, Scope& scope,
                                              std::vector<Unfolded>& unfolded) const {
  if (t.arguments.size() != s.parameters.size())
    t.name.location.fail("'" + s.name + "' takes " + plural(s.parameters.size(), "argument") +
                         ", not " + std::to_string(t.arguments.size()));
  std::vector<Argument> result;
  for (std::size_t i = 0; i < t.arguments.size(); ++i)
    result.push_back(argument(t.arguments[i], s.parameters[i], scope, unfolded));
  return result;
}

bool TermResolver::is_plain(const sx::Term& t) const {
  return t.kind == sx::Term::Kind::Variable ||
         (t.kind == sx::Term::Kind::Name && !symbols_.function_of(t));
}

}  // namespace kaboum::plan
