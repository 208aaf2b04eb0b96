// Grammar of terms, of what stands inside K(...), and of queries, by recursive descent.
#include "language/formula_parser.h"

#include <utility>

namespace kaboum::plan {

using syntax::Formula;
using syntax::Term;
using syntax::TypedVariable;

Term FormulaParser::cost() { return in_.peek().kind == Token::Kind::Number ? number() : term(); }

Term FormulaParser::number() {
  Term t;
  t.name = {in_.peek().text, in_.location()};
  in_.skip();
  return t;
}

std::vector<TypedVariable> FormulaParser::parameters() {
  std::vector<TypedVariable> result;
  do {
    TypedVariable v;
    if (in_.peek().kind == Token::Kind::Name)
      v.type = in_.name("a type");  // the thesis's "object o"
    if (in_.peek().kind == Token::Kind::Variable) {
      v.name = {in_.peek().text, in_.location()};
      in_.skip();
    } else {
      in_.location().fail("expected a parameter such as ?x, found " + in_.found());
    }
    if (in_.accept(":")) v.type = in_.name("a type");
    result.push_back(std::move(v));
  } while (in_.accept(","));
  return result;
}

Formula FormulaParser::make(Formula::Kind kind) const {
  Formula f;
  f.kind = kind;
  f.location = in_.location();
  return f;
}

Formula FormulaParser::joined(Formula::Kind kind, std::string_view symbol,
                              Formula (FormulaParser::*operand)()) {
  Formula first = (this->*operand)();
  if (!in_.is(symbol)) return first;
  Formula all = make(kind);
  all.children.push_back(std::move(first));
  while (in_.accept(symbol)) all.children.push_back((this->*operand)());
  return all;
}

Formula FormulaParser::formula() {
  const TokenStream::Level level(in_);
  return joined(Formula::Kind::Or, "|", &FormulaParser::exclusive);
}

Formula FormulaParser::exclusive() {
  return joined(Formula::Kind::Xor, "xor", &FormulaParser::conjunction);
}

Formula FormulaParser::conjunction() {
  return joined(Formula::Kind::And, "&", &FormulaParser::unary);
}

Formula FormulaParser::unary() {
  const TokenStream::Level level(in_);
  Formula f = make(Formula::Kind::Not);
  if (in_.accept("!")) {
    f.children.push_back(unary());
    return f;
  }
  if (in_.accept("(")) {
    f = formula();
    in_.expect(")", "to close the parenthesis");
    return f;
  }
  if (in_.is("(", 1))
    if (auto query = operator_with_parenthesis(f)) return std::move(*query);
  if (in_.is("let") && in_.peek(1).kind == Token::Kind::Variable) return let(std::move(f));
  if (in_.accept("true")) {
    f.kind = Formula::Kind::True;
    return f;
  }
  if (in_.accept("false")) {
    f.kind = Formula::Kind::False;
    return f;
  }
  fail_query();
}

/// K(...), Kw(...), a quantifier and the like; nullopt if the next token begins none of these.
std::optional<Formula> FormulaParser::operator_with_parenthesis(Formula f) {
  if (in_.accept("K")) return modal(f, Formula::Kind::Known);
  if (in_.accept("Kw")) return modal(f, Formula::Kind::KnowWhether);
  if (in_.accept("LCW")) return modal(f, Formula::Kind::ClosedWorld);
  if (in_.accept("Kv")) {
    f.kind = Formula::Kind::KnowValue;
    in_.expect("(", "after Kv");
    f.terms.push_back(term());
    in_.expect(")", "after the function term of Kv");
    return f;
  }
  if (in_.accept("forallK") || in_.accept("forall")) return quantified(f, Formula::Kind::ForAll);
  if (in_.accept("existsK") || in_.accept("exists")) return quantified(f, Formula::Kind::Exists);
  if (in_.is("extern")) {
    f.terms.push_back(term());
    return comparison(f, Formula::Kind::Extern);
  }
  return std::nullopt;
}

Formula FormulaParser::let(Formula f) {
  f.kind = Formula::Kind::Let;
  in_.skip();
  TypedVariable v;
  v.name = {in_.peek().text, in_.location()};
  in_.skip();
  f.variables.push_back(std::move(v));
  in_.expect("=", "after the variable of 'let'");
  f.terms.push_back(term());
  if (f.terms[0].kind != Term::Kind::Extern)
    f.terms[0].name.location.fail("'let ?y = ...' names what extern(...) returns");
  return f;
}

void FormulaParser::fail_query() const {
  std::string hint;
  if (in_.peek().kind == Token::Kind::Name)
    hint = in_.peek(1).kind == Token::Kind::Name && !in_.is(":", 2)
               ? " (a section begins with 'action', 'init:', 'goal:' and the like)"
               : ": write K(" + in_.peek().text + (in_.is("(", 1) ? "(...)" : "") +
                     ") for what is known";
  in_.location().fail(
      "expected a query such as K(...), !K(...), Kw(...), Kv(...), forallK or extern(...), "
      "found " +
      in_.found() + hint);
}

Formula FormulaParser::modal(Formula f, Formula::Kind kind) {
  f.kind = kind;
  in_.expect("(", "after the operator");
  f.children.push_back(literal());
  in_.expect(")", "after the formula");
  return f;
}

Formula FormulaParser::quantified(Formula f, Formula::Kind kind) {
  f.kind = kind;
  in_.expect("(", "after the quantifier");
  f.variables = parameters();
  in_.expect(")", "after the quantifier's variables");
  f.children.push_back(unary());
  return f;
}

Formula FormulaParser::literal() {
  const TokenStream::Level level(in_);
  Formula f = make(Formula::Kind::Atom);
  if (in_.accept("!")) {
    f.kind = Formula::Kind::Not;
    f.children.push_back(literal());
    return f;
  }
  if (in_.accept("(")) {
    f = literal();
    in_.expect(")", "to close the parenthesis");
    return f;
  }
  f.terms.push_back(term());
  const bool external = f.terms[0].kind == Term::Kind::Extern;
  return comparison(std::move(f), external ? Formula::Kind::Extern : Formula::Kind::Atom);
}

Formula FormulaParser::comparison(Formula f, Formula::Kind alone) {
  f.kind = alone;
  if (in_.is("=") || in_.is("!=")) {
    f.kind = in_.is("=") ? Formula::Kind::Equal : Formula::Kind::NotEqual;
    in_.skip();
    f.terms.push_back(term());
  }
  return f;
}

Term FormulaParser::term() {
  const TokenStream::Level level(in_);
  Term t;
  if (in_.peek().kind == Token::Kind::Variable) {
    t.kind = Term::Kind::Variable;
    t.name = {in_.peek().text, in_.location()};
    in_.skip();
    return t;
  }
  if (in_.peek().kind == Token::Kind::Number) return number();
  t.name = in_.name("a variable, a constant or a function");
  if (t.name.text == "extern" && in_.accept("(")) {
    t = term();
    if (t.kind == Term::Kind::Variable)
      t.name.location.fail("expected an external function after extern(");
    t.kind = Term::Kind::Extern;
    in_.expect(")", "to close extern(");
    return t;
  }
  if (in_.accept("(")) {
    t.kind = Term::Kind::Call;
    while (!in_.is(")")) {
      t.arguments.push_back(term());
      if (!in_.accept(",")) break;
    }
    in_.expect(")", "after the arguments");
  }
  return t;
}

}  // namespace kaboum::plan
