// Writes PDDL: its classical part and sensing; what it cannot say is refused.
#include "language/pddl.h"

#include <algorithm>
#include <map>
#include <set>

namespace kaboum::plan {
namespace {

using syntax::Effect;
using syntax::Formula;
using syntax::Name;
using syntax::Term;
using syntax::TypedVariable;
using K = Formula::Kind;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::InvalidInput, "PDDL cannot say: " + what);
}

/// PDDL ignores case: names that differ in nothing else would be one.
void check_names(const syntax::Document& d) {
  std::map<std::string, std::string> seen;
  const auto add = [&](const std::string& kind, const Name& n) {
    std::string lower = kind;
    for (const char c : n.text)
      lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const auto [it, fresh] = seen.emplace(lower, n.text);
    if (!fresh && it->second != n.text)
      refuse("'" + it->second + "' and '" + n.text + "', which differ only in case");
  };
  for (const syntax::Type& t : d.types) add("t ", t.name);
  for (const TypedVariable& c : d.constants) add("c ", c.name);
  for (const syntax::Signature& s : d.predicates) add("p ", s.name);
  for (const syntax::Signature& s : d.functions) add("p ", s.name);
  for (const syntax::Action& a : d.actions) add("a ", a.name);
}
/// In PDDL an addition wins over a deletion, wherever it stands; here the later update does.
void refuse_late_deletions(const std::vector<Effect>& list, std::set<std::string>& added,
                           const std::string& action) {
  for (const Effect& e : list) {
    refuse_late_deletions(e.children, added, action);
    // What one object of a quantified effect adds, the next one's negations come after.
    if (e.kind == Effect::Kind::ForAll) refuse_late_deletions(e.children, added, action);
    if (e.kind != Effect::Kind::Add || e.database != syntax::Database::Kf) continue;
    const Formula& f = e.formulas.at(0);
    if (f.kind == K::Atom) added.insert(f.terms.at(0).name.text);
    if (f.kind == K::Not && f.children.at(0).kind == K::Atom &&
        added.contains(f.children[0].terms.at(0).name.text))
      refuse("action '" + action + "' adds " + f.children[0].terms[0].name.text +
             " and then its negation; put negations first, in a 'forall' of their own");
  }
}
/// Writes the classical part of the language, and sensing.
class PddlPrinter {
 public:
  std::string write(const syntax::Document& d) {
    document_ = &d;
    // PDDL's "object" is the root of all types; as one type among others it needs another name.
    const auto is_object = [](const syntax::Type& t) { return t.name.text == "object"; };
    rename_object_ = std::any_of(d.types.begin(), d.types.end(), is_object) && d.types.size() > 1 &&
                     std::none_of(d.types.begin(), d.types.end(),
                                  [](const syntax::Type& t) { return t.parent.text == "object"; });
    incomplete_ =
        !d.unknown.empty() || std::any_of(d.initial.begin(), d.initial.end(), [](const Effect& e) {
          return e.database == syntax::Database::Kx || e.database == syntax::Database::Or;
        });
    check_names(d);
    if (!d.externals.empty()) refuse("external function '" + d.externals[0].name.text + "'");
    const bool costs = std::any_of(d.actions.begin(), d.actions.end(),
                                   [](const auto& a) { return !a.cost.empty(); });
    const std::string title = d.name.text.empty() ? "unnamed" : d.name.text;
    std::string text = domain(d, title, costs);
    return text + problem(d, title, costs);
  }

 private:
  std::string domain(const syntax::Document& d, const std::string& title, bool costs) const {
    std::string out = "(define (domain " + title +
                      ")\n (:requirements :typing :adl :object-fluents :action-costs " +
                      (d.rules.empty() ? ":contingent" : ":derived-predicates") + ")\n";
    out += " (:types";
    for (const syntax::Type& t : d.types)
      if (t.handle) refuse("a handle type");
    for (const syntax::Type& t : d.types)
      if (t.members.empty() && t.name.text != "number" &&
          (t.name.text != "object" || rename_object_))
        out += " " + type(t.name) + " - " + (t.parent.text.empty() ? "object" : t.parent.text);
    out += ")\n (:constants";
    for (const TypedVariable& c : d.constants) out += " " + c.name.text + " - " + type(c.type);
    out += ")\n (:predicates";
    for (const syntax::Signature& s : d.predicates) out += " " + signature(s);
    out += ")\n (:functions";
    for (const syntax::Signature& s : d.functions)
      out += " " + signature(s) + " - " + type(s.range);
    out += std::string(costs ? " (total-cost) - number" : "") + ")\n";
    for (const syntax::Rule& r : d.rules) out += rule(r);
    for (const syntax::Action& a : d.actions) out += action(a, costs);
    return out + ")\n\n";
  }

  [[nodiscard]] std::string rule(const syntax::Rule& r) const {
    std::string head = "(" + r.head.text;
    for (const TypedVariable& v : r.parameters) head += " ?" + v.name.text + " - " + type(v.type);
    return " (:derived " + head + ")\n  " + condition(r.body) + ")\n";
  }

  std::string problem(const syntax::Document& d, const std::string& title, bool costs) const {
    std::string out = "(define (problem " + title + "-problem)\n (:domain " + title + ")\n (:init";
    for (const Effect& e : d.initial) out += "\n  " + initial(e);
    for (const Formula& f : d.unknown) out += "\n  (unknown " + literal(f) + ")";
    if (!closes_world(d))
      refuse(
          "an open world: PDDL takes what is not stated for false; state 'closed: all' if that is "
          "meant");
    out += ")\n (:goal (and";
    for (const Formula& g : d.goals) out += " " + condition(g);
    out += "))\n";
    if (costs) out += " (:metric minimize (total-cost))\n";
    return out + ")\n";
  }

  [[nodiscard]] std::string type(const Name& n) const {
    if (n.text.empty()) return "object";
    for (const syntax::Type& t : document_->types) {
      if (t.name.text != n.text || t.members.empty()) continue;
      std::string either = "(either";
      for (const Name& m : t.members) either.append(" ").append(type(m));
      return either + ")";
    }
    return rename_object_ && n.text == "object" ? "kpl-object" : n.text;
  }
  [[nodiscard]] std::string variables(const std::vector<TypedVariable>& list) const {
    std::string out;
    for (const TypedVariable& v : list)
      out += (out.empty() ? "?" : " ?") + v.name.text + " - " + type(v.type);
    return "(" + out + ")";
  }
  [[nodiscard]] std::string signature(const syntax::Signature& s) const {
    std::string out = "(" + s.name.text;
    for (std::size_t i = 0; i < s.parameters.size(); ++i)
      out += " ?x" + std::to_string(i) + " - " + type(s.parameters[i]);
    return out + ")";
  }
  [[nodiscard]] bool is_function(const Term& t) const {
    return t.kind != Term::Kind::Variable &&
           std::any_of(document_->functions.begin(), document_->functions.end(),
                       [&](const syntax::Signature& s) { return s.name.text == t.name.text; });
  }
  /// f(x) != c, in any form.
  static bool rules_out(const Formula& f, bool negated = false) {
    if (f.kind == K::Not) return rules_out(f.children.at(0), !negated);
    return f.kind == (negated ? K::Equal : K::NotEqual);
  }
  std::string term(const Term& t, bool call) const {
    if (t.kind == Term::Kind::Extern) refuse("extern(...)");
    if (t.kind == Term::Kind::Variable) return "?" + t.name.text;
    const bool nullary = t.kind == Term::Kind::Name && !call && is_function(t);
    if (t.kind == Term::Kind::Name && !call && !nullary) return t.name.text;
    std::string out = "(" + t.name.text;
    for (const Term& a : t.arguments) out += " " + term(a, false);
    return out + ")";
  }
  std::string literal(const Formula& f) const {
    switch (f.kind) {
      case K::Not:
        return "(not " + literal(f.children.at(0)) + ")";
      case K::Equal:
        return "(= " + term(f.terms.at(0), false) + " " + term(f.terms.at(1), false) + ")";
      case K::NotEqual:
        return "(not (= " + term(f.terms.at(0), false) + " " + term(f.terms.at(1), false) + "))";
      case K::Atom:
        return term(f.terms.at(0), true);
      default:
        refuse("extern(...)");
    }
  }
  std::string condition(const Formula& f) const {
    const auto joined = [&](const char* op) {
      std::string out = std::string("(") + op;
      for (const Formula& c : f.children) out += " " + condition(c);
      return out + ")";
    };
    switch (f.kind) {
      case K::True:
        return "(and)";
      case K::False:
        return "(or)";
      case K::And:
        return joined("and");
      case K::Or:
        return joined("or");
      case K::Known:
        return literal(f.children.at(0));
      case K::Exists:
      case K::ForAll:
        return std::string(f.kind == K::Exists ? "(exists " : "(forall ") + variables(f.variables) +
               " " + condition(f.children.at(0)) + ")";
      case K::Not:
        refuse("a lack of knowledge, such as !K(...)");
      case K::Xor:
        refuse("an exclusive or");
      default:
        refuse("a query of Kw, Kv, LCW or extern, or 'let'");
    }
  }
  /// What an addition to Kf says; one to Kw or Kv goes to `observed`.
  std::string addition(const Effect& e, std::string& observed) const {
    const Formula& f = e.formulas.at(0);
    if (e.database == syntax::Database::Kw || e.database == syntax::Database::Kv) {
      if (!observed.empty()) refuse("two observations of one action");
      observed = literal(f);
      return "";
    }
    if (e.database != syntax::Database::Kf) refuse("an effect on Kx or LCW");
    if (rules_out(f)) refuse("the observation that a term has not some value");
    if (f.kind != K::Equal) return " " + literal(f);
    const bool swapped = !is_function(f.terms.at(0));
    return " (assign " + term(f.terms.at(swapped ? 1 : 0), true) + " " +
           term(f.terms.at(swapped ? 0 : 1), false) + ")";
  }

  std::string effects(const std::vector<Effect>& list, std::string& observed) const {
    std::string out = "(and";
    for (const Effect& e : list) {
      switch (e.kind) {
        case Effect::Kind::Add:
          out += addition(e, observed);
          break;
        case Effect::Kind::Maybe:
        case Effect::Kind::Delete:
          refuse("loss of knowledge, del(...) or maybe(...)");
        case Effect::Kind::When: {
          std::string inner;
          if (incomplete_ && !e.of_world)
            refuse(
                "a conditional effect where knowledge is incomplete: that of PDDL may happen while "
                "its condition is not known ('whenever')");
          out += " (when " + condition(e.formulas.at(0)) + " " + effects(e.children, inner) + ")";
          if (!inner.empty()) refuse("a conditional observation");
          break;
        }
        case Effect::Kind::ForAll: {
          std::string inner;
          out += " (forall " + variables(e.variables) + " " + effects(e.children, inner) + ")";
          if (!inner.empty()) refuse("a quantified observation");
          break;
        }
      }
    }
    return out + ")";
  }
  std::string action(const syntax::Action& a, bool costs) const {
    std::string observed;
    std::set<std::string> added;
    refuse_late_deletions(a.effects, added, a.name.text);
    std::string all = effects(a.effects, observed);
    if (costs) {
      all.pop_back();
      const std::string cost =
          a.cost.empty() ? "1" : term(a.cost[0], a.cost[0].kind == Term::Kind::Call);
      all += " (increase (total-cost) " + cost + "))";
    }
    return " (:action " + a.name.text + "\n  :parameters " + variables(a.parameters) +
           "\n  :precondition " + condition(a.precondition) + "\n  :effect " + all +
           (observed.empty() ? "" : "\n  :observe " + observed) + ")\n";
  }
  std::string initial(const Effect& e) const {
    switch (e.database) {
      case syntax::Database::Kf:
        return literal(e.formulas.at(0));
      case syntax::Database::Kx: {
        std::string out = "(oneof";
        for (const Formula& f : e.formulas) out += " " + literal(f);
        return out + ")";
      }
      case syntax::Database::Or: {
        std::string out = "(or";
        for (const Formula& f : e.formulas) out += " " + literal(f);
        return out + ")";
      }
      default:
        refuse("initial entries of Kw, Kv and LCW");
    }
  }

  const syntax::Document* document_ = nullptr;
  bool rename_object_ = false;
  bool incomplete_ = false;  ///< not all is known at the start
};

}  // namespace

std::string print_pddl(const syntax::Document& document) { return PddlPrinter().write(document); }

}  // namespace kaboum::plan
