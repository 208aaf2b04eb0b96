// Terms and conditions of PDDL. Its worlds are closed: a condition p becomes K(p), (not p) becomes
// K(!p).
#include "language/pddl_formula.h"

namespace kaboum::plan {

using syntax::Formula;
using syntax::Name;
using syntax::Term;
using syntax::TypedVariable;

namespace pddl {

using K = Formula::Kind;

const SExpression& item(const SExpression& e, std::size_t i, const char* what) {
  if (!e.list || i >= e.items.size()) e.location.fail(std::string("expected ") + what);
  return e.items[i];
}

Name name(const SExpression& e, const char* what) {
  if (e.list || e.word.empty()) e.location.fail(std::string("expected ") + what);
  return {e.word, e.location};
}

Name type_name(const SExpression& e) {
  if (!e.list) return {e.word, e.location};
  if (!e.headed("either") || e.items.size() < 2)
    e.location.fail("expected a type, or (either TYPE ...)");
  std::string text = "either";
  for (std::size_t i = 1; i < e.items.size(); ++i)
    text.append("_").append(name(e.items[i], "a type").text);
  return {text, e.location};
}

std::vector<TypedVariable> typed(const SExpression& e, std::size_t from, bool variables) {
  std::vector<TypedVariable> result;
  std::size_t untyped = 0;
  for (std::size_t i = from; i < e.items.size(); ++i) {
    if (e.items[i].is("-")) {
      const SExpression& t = item(e, i + 1, "a type after '-'");
      if (t.list && !variables)
        t.location.fail(
            "(either ...) is not supported here: an object, and a type, is of one type");
      for (; untyped < result.size(); ++untyped) result[untyped].type = type_name(t);
      ++i;
      continue;
    }
    Name n = name(e.items[i], "a name");
    if (variables != (n.text[0] == '?'))
      n.location.fail(variables ? "expected a variable such as ?x"
                                : "expected a name, found a variable");
    if (variables) n.text.erase(0, 1);
    if (variables && n.text.empty()) n.location.fail("a variable's name must follow '?'");
    result.push_back({n, {}});
  }
  return result;
}

Term term(const SExpression& e) {
  Term t;
  if (!e.list) {
    t.name = {e.word, e.location};
    if (e.word[0] == '?') {
      t.kind = Term::Kind::Variable;
      t.name.text.erase(0, 1);
    }
    return t;
  }
  t.name = name(item(e, 0, "a name"), "a name");
  t.kind = e.items.size() > 1 ? Term::Kind::Call : Term::Kind::Name;
  for (std::size_t i = 1; i < e.items.size(); ++i) t.arguments.push_back(term(e.items[i]));
  return t;
}

Formula make(K kind, const SourceLocation& location, std::vector<Formula> children) {
  Formula f;
  f.kind = kind;
  f.location = location;
  f.children = std::move(children);
  return f;
}

Formula literal(const SExpression& e) {
  if (e.headed("=")) {
    Formula f = make(K::Equal, e.location);
    f.terms = {term(item(e, 1, "a term")), term(item(e, 2, "a term"))};
    return f;
  }
  Formula f = make(K::Atom, e.location);
  f.terms.push_back(term(e));
  return f;
}

Formula formula(const SExpression& e, bool positive) {
  if (!e.list) e.location.fail("expected a condition in parentheses");
  if (e.items.empty()) return make(positive ? K::True : K::False, e.location);
  const auto children = [&](std::size_t from, bool sign) {
    std::vector<Formula> all;
    for (std::size_t i = from; i < e.items.size(); ++i) all.push_back(formula(e.items[i], sign));
    return all;
  };
  if (e.headed("and")) return make(positive ? K::And : K::Or, e.location, children(1, positive));
  if (e.headed("or")) return make(positive ? K::Or : K::And, e.location, children(1, positive));
  if (e.headed("not")) return formula(item(e, 1, "a condition"), !positive);
  if (e.headed("imply"))
    return make(positive ? K::Or : K::And, e.location,
                {formula(item(e, 1, "a condition"), !positive),
                 formula(item(e, 2, "a condition"), positive)});
  if (e.headed("exists") || e.headed("forall")) {
    Formula f = make(e.headed("exists") == positive ? K::Exists : K::ForAll, e.location,
                     {formula(item(e, 2, "a condition"), positive)});
    f.variables = typed(item(e, 1, "variables"), 0, true);
    return f;
  }
  Formula inner = literal(e);
  if (!positive) inner = make(K::Not, e.location, {std::move(inner)});
  return make(K::Known, e.location, {std::move(inner)});
}

}  // namespace pddl
}  // namespace kaboum::plan
