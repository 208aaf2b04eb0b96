// Writes .kpl in one canonical form: what is printed reads as the same document.
#include "language/kpl_printer.h"

#include <algorithm>
#include <set>

#include "language/lexer.h"

namespace kaboum::plan {
namespace {

using syntax::Effect;
using syntax::Formula;
using syntax::Term;
using K = Formula::Kind;

std::string variables(const std::vector<syntax::TypedVariable>& list) {
  std::string text;
  for (const auto& v : list)
    text += (text.empty() ? "?" : ", ?") + v.name.text +
            (v.type.text.empty() ? "" : " : " + v.type.text);
  return "(" + text + ")";
}

/// PDDL has connectives of one formula, which is then all they say; and of none, which are a word.
const Formula& plain(const Formula& f) {
  const bool connective = f.kind == K::And || f.kind == K::Or || f.kind == K::Xor;
  return connective && f.children.size() == 1 ? plain(f.children[0]) : f;
}

/// How tightly an operator binds: a child that binds less is put in parentheses.
int strength(const Formula& f) {
  const Formula& p = plain(f);
  if (p.children.empty()) return 4;
  switch (p.kind) {
    case K::Or:
      return 1;
    case K::Xor:
      return 2;
    case K::And:
      return 3;
    default:
      return 4;
  }
}

std::string joined(const Formula& f, const char* symbol) {
  std::string text;
  for (const Formula& c : f.children) {
    const bool parentheses = strength(c) <= strength(f);
    text += (text.empty() ? "" : symbol) +
            (parentheses ? "(" + print_formula(c) + ")" : print_formula(c));
  }
  return text;
}

std::string tight(const Formula& f) {
  return strength(f) < 4 ? "(" + print_formula(f) + ")" : print_formula(f);
}

const char* name(syntax::Database d) {
  switch (d) {
    case syntax::Database::Kf:
      return "Kf";
    case syntax::Database::Kw:
      return "Kw";
    case syntax::Database::Kv:
      return "Kv";
    case syntax::Database::Kx:
      return "Kx";
    case syntax::Database::Lcw:
      return "LCW";
    case syntax::Database::Or:
      return "Or";
  }
  return "Kf";
}

std::string update(const Effect& e) {
  std::string text;
  for (const Formula& f : e.formulas) text += (text.empty() ? "" : " | ") + print_formula(f);
  const char* what = e.kind == Effect::Kind::Add     ? "add("
                     : e.kind == Effect::Kind::Maybe ? "maybe("
                                                     : "del(";
  return std::string(what) + name(e.database) + ", " + text + ")";
}

std::string effects(const std::vector<Effect>& list, const std::string& indent);

std::string effect(const Effect& e, const std::string& indent) {
  switch (e.kind) {
    case Effect::Kind::Add:
    case Effect::Kind::Maybe:
    case Effect::Kind::Delete:
      return update(e);
    case Effect::Kind::When: {
      // An effect that begins with "forallK" quantifies the condition and what follows alike.
      const std::string condition = print_formula(e.formulas.at(0));
      return (e.of_world                         ? "whenever " + condition
              : condition.starts_with("forallK") ? "(" + condition + ")"
                                                 : condition) +
             " => {\n" + effects(e.children, indent + "  ") + "\n" + indent + "}";
    }
    case Effect::Kind::ForAll:
      return "forall" + variables(e.variables) + " {\n" + effects(e.children, indent + "  ") +
             "\n" + indent + "}";
  }
  return {};
}

std::string effects(const std::vector<Effect>& list, const std::string& indent) {
  std::string text;
  for (const Effect& e : list) text += (text.empty() ? "" : ",\n") + indent + effect(e, indent);
  return text;
}

std::string signature(const syntax::Signature& s) {
  std::string text;
  for (const auto& p : s.parameters)
    text += (text.empty() ? "" : ", ") + (p.text.empty() ? "?any" : p.text);
  return s.name.text + (s.parameters.empty() ? "" : "(" + text + ")");
}

}  // namespace

std::string print_term(const Term& t) {
  std::string text = t.kind == Term::Kind::Variable ? "?" + t.name.text : t.name.text;
  if (t.kind == Term::Kind::Call || (t.kind == Term::Kind::Extern && !t.arguments.empty())) {
    text += "(";
    for (std::size_t i = 0; i < t.arguments.size(); ++i)
      text += (i == 0 ? "" : ", ") + print_term(t.arguments[i]);
    text += ")";
  }
  return t.kind == Term::Kind::Extern ? "extern(" + text + ")" : text;
}

std::string print_formula(const Formula& formula) {
  const Formula& f = plain(formula);
  switch (f.kind) {
    case K::True:
      return "true";
    case K::False:
      return "false";
    case K::And:
      return f.children.empty() ? "true" : joined(f, " & ");
    case K::Or:
      return f.children.empty() ? "false" : joined(f, " | ");
    case K::Xor:
      return joined(f, " xor ");
    case K::Not:
      return "!" + tight(f.children.at(0));
    case K::Exists:
      return "existsK" + variables(f.variables) + " " + tight(f.children.at(0));
    case K::ForAll:
      return "forallK" + variables(f.variables) + " " + tight(f.children.at(0));
    case K::Known:
      return "K(" + print_formula(f.children.at(0)) + ")";
    case K::KnowWhether:
      return "Kw(" + print_formula(f.children.at(0)) + ")";
    case K::ClosedWorld:
      return "LCW(" + print_formula(f.children.at(0)) + ")";
    case K::KnowValue:
      return "Kv(" + print_term(f.terms.at(0)) + ")";
    case K::Atom:
    case K::Extern:
      return print_term(f.terms.at(0));
    case K::Let:
      return "let ?" + f.variables.at(0).name.text + " = " + print_term(f.terms.at(0));
    case K::Equal:
      return print_term(f.terms.at(0)) + " = " + print_term(f.terms.at(1));
    case K::NotEqual:
      return print_term(f.terms.at(0)) + " != " + print_term(f.terms.at(1));
  }
  return {};
}

std::string print_effects(const std::vector<Effect>& list) { return effects(list, ""); }

namespace {

/// Other languages have names that this one has not.
void check_name(const syntax::Name& n) {
  if (n.text.empty()) return;
  static const std::set<std::string, std::less<>> kReserved = {
      "K",      "Kf",     "Kw",  "Kv",   "Kx",    "LCW",     "add",     "del", "maybe",   "forall",
      "exists", "extern", "xor", "true", "false", "forallK", "existsK", "Or",  "whenever"};
  bool readable = false;
  try {
    const std::vector<Token> tokens = tokenize({"", n.text});
    readable = tokens.size() == 2 && tokens[0].kind == Token::Kind::Name &&
               tokens[0].text == n.text && !kReserved.contains(n.text);
  } catch (const Error&) {
    readable = false;
  }
  if (!readable)
    n.location.fail(
        "kpl cannot say the name '" + n.text +
        "': a name is a letter followed by letters, digits, '_' and '-', and no operator");
}

void check_names(const syntax::Document& d) {
  for (const auto& t : d.types) check_name(t.name);
  for (const auto& c : d.constants) check_name(c.name);
  for (const auto* list : {&d.predicates, &d.functions, &d.externals})
    for (const auto& s : *list) check_name(s.name);
  for (const auto& a : d.actions) {
    check_name(a.name);
    for (const auto& p : a.parameters) check_name(p.name);
  }
}

}  // namespace

std::string print_kpl(const syntax::Document& d) {
  check_names(d);
  if (!d.rules.empty())
    d.rules[0].head.location.fail("kpl cannot say derived predicates ('" + d.rules[0].head.text +
                                  "')");
  std::string out;
  if (!d.name.text.empty()) out += "domain " + d.name.text + "\n\n";
  const auto section = [&](const char* heading, const auto& list, const auto& line) {
    if (list.empty()) return;
    out += std::string(heading) + "\n";
    for (const auto& item : list) out += "  " + line(item) + "\n";
    out += "\n";
  };
  section("types:", d.types, [](const syntax::Type& t) {
    std::string members;
    for (const syntax::Name& m : t.members) members += (members.empty() ? " = " : " | ") + m.text;
    return t.name.text + (t.parent.text.empty() ? "" : " : " + t.parent.text) +
           (t.handle ? " handle" : "") + members + ";";
  });
  // A type goes on until the next; so constants without one begin a section of their own.
  const std::string* type = nullptr;
  for (const syntax::TypedVariable& c : d.constants) {
    if (type == nullptr || (c.type.text.empty() && !type->empty())) out += "constants:\n";
    type = &c.type.text;
    out += "  " + (type->empty() ? "" : *type + " ") + c.name.text + ";\n";
  }
  if (type != nullptr) out += "\n";
  section("predicates:", d.predicates,
          [](const syntax::Signature& s) { return signature(s) + ";"; });
  section("functions:", d.functions, [](const syntax::Signature& s) {
    return signature(s) + (s.range.text.empty() ? "" : " : " + s.range.text) + ";";
  });
  section("externals:", d.externals, [](const syntax::Signature& s) {
    return signature(s) + (s.range.text.empty() ? "" : " : " + s.range.text) + ";";
  });
  for (const syntax::Table& t : d.tables) {
    out += "table " + t.external.text + ":\n";
    for (const syntax::Row& r : t.rows) {
      std::string text;
      for (const auto& a : r.arguments) text += (text.empty() ? "" : ", ") + a.text;
      out += "  (" + text + ")" + (r.value.text.empty() ? "" : " = " + r.value.text) + ";\n";
    }
    out += "\n";
  }
  for (const syntax::Action& a : d.actions) {
    out += "action " + a.name.text + variables(a.parameters) + "\n  preconds:\n    ";
    out += print_formula(a.precondition) + "\n  effects:\n" + effects(a.effects, "    ") + "\n";
    if (!a.cost.empty()) out += "  cost: " + print_term(a.cost[0]) + "\n";
    out += "\n";
  }
  section("init:", d.initial, [](const Effect& e) {
    if (e.database == syntax::Database::Kf && e.formulas.size() == 1 &&
        e.formulas[0].kind == K::Equal)
      return print_formula(e.formulas[0]) + ";";
    if (e.database == syntax::Database::Or) {
      std::string text;
      for (const Formula& f : e.formulas) text += (text.empty() ? "" : " | ") + print_formula(f);
      return "Or(" + text + ");";
    }
    return update(e) + ";";
  });
  std::vector<syntax::Name> closed = d.closed;
  if (d.closed_world) {
    const auto is_all = [](const syntax::Signature& s) { return s.name.text == "all"; };
    closed = {{"all", {}}};
    if (std::any_of(d.predicates.begin(), d.predicates.end(), is_all)) {
      closed.clear();
      for (const syntax::Signature& s : d.predicates) closed.push_back(s.name);
    }
  }
  section("closed:", closed, [](const syntax::Name& n) { return n.text + ";"; });
  section("unknown:", d.unknown, [](const Formula& f) { return print_formula(f) + ";"; });
  for (const Formula& g : d.goals) out += "goal:\n  " + print_formula(g) + "\n";
  return out;
}

}  // namespace kaboum::plan
