// Grammar of PDDL: a domain, a problem, or both; :observe, (unknown ...) and (oneof ...) for
// incomplete knowledge.
#include "language/pddl.h"

#include <algorithm>
#include <array>
#include <set>

#include "language/pddl_effect.h"
#include "language/pddl_formula.h"
#include "language/s_expression.h"

namespace kaboum::plan {
namespace {

using namespace pddl;  // this file's business are its readers
using syntax::Effect;
using syntax::Formula;
using syntax::Name;
using syntax::Term;
using syntax::TypedVariable;
using K = Formula::Kind;

std::string text_of(const SExpression& e) {
  if (!e.list) return e.word;
  std::string text = "(";
  for (const SExpression& i : e.items) text += text_of(i) + " ";
  return text + ")";
}

class PddlParser {
 public:
  explicit PddlParser(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

  syntax::Document read() {
    document_.sources.push_back(source_);
    const std::vector<SExpression> all = read_s_expressions(*source_);
    if (all.empty()) source_->fail(0, "expected (define ...)");
    for (const SExpression& e : all) declare_unions(e);
    for (const SExpression& e : all) define(e);
    declare_used_types();
    if (costs_)
      for (syntax::Action& a : document_.actions)
        if (a.cost.empty()) a.cost.push_back({Term::Kind::Name, {"0", a.name.location}, {}});
    for (syntax::Action& a : document_.actions) a.effects = additions_last(a.effects);
    document_.assumes_complete = !contingent_ && !document_.actions.empty();
    if (document_.assumes_complete && !document_.unknown.empty())
      document_.unknown[0].location.fail(
          "incomplete knowledge needs the requirement ':contingent' in the domain");
    if (contingent_)
      for (syntax::Action& a : document_.actions) decide_in_world(a.effects);
    return std::move(document_);
  }

 private:
  void define(const SExpression& e) {
    if (!e.headed("define")) e.location.fail("expected (define ...)");
    const SExpression& head = item(e, 1, "(domain NAME) or (problem NAME)");
    const bool domain = head.headed("domain");
    if (!domain && !head.headed("problem"))
      head.location.fail("expected (domain NAME) or (problem NAME)");
    const Name n = name(item(head, 1, "a name"), "a name");
    if (domain || document_.name.text.empty()) document_.name = n;
    for (std::size_t i = 2; i < e.items.size(); ++i) section(e.items[i]);
    if (!domain) close_world();
  }

  void section(const SExpression& e) {
    const std::string key = name(item(e, 0, "a section"), "a section").text;
    if (key == ":requirements") {
      for (std::size_t i = 1; i < e.items.size(); ++i) requirement(e.items[i]);
    } else if (key == ":types") {
      typed_ = true;
      for (const TypedVariable& t : typed(e, 1, false)) declare_type({t.name, t.type});
    } else if (key == ":constants" || key == ":objects") {
      for (TypedVariable& c : typed(e, 1, false)) document_.constants.push_back(std::move(c));
    } else if (key == ":predicates") {
      for (std::size_t i = 1; i < e.items.size(); ++i)
        document_.predicates.push_back(signature(e.items[i]));
    } else if (key == ":functions") {
      functions(e);
    } else if (key == ":action" || key == ":sensor") {
      action(e);
    } else if (key == ":derived") {
      rule(e);
    } else if (key == ":init") {
      for (std::size_t i = 1; i < e.items.size(); ++i) initial(e.items[i]);
      for (const SExpression* i : invariants_) invariant(*i);
    } else if (key == ":goal") {
      document_.goals.push_back(formula(item(e, 1, "a goal"), true));
    } else if (key == ":metric") {
      const SExpression& what = item(e, 2, "what to minimise");
      if (!item(e, 1, "minimize").is("minimize") ||
          !(what.is("total-cost") || what.headed("total-cost")))
        e.location.fail("only the metric 'minimize (total-cost)' is supported");
    } else if (key != ":domain" && key != ":hidden") {  // the latter is for simulators of the world
      e.location.fail("unsupported section '" + key + "'");
    }
  }

  /// A type may be named again: below "object" it is anyway.
  void declare_type(const syntax::Type& type) {
    const auto root = [](const syntax::Type& t) {
      return t.parent.text.empty() || t.parent.text == "object";
    };
    for (syntax::Type& t : document_.types) {
      if (t.name.text != type.name.text || !t.members.empty()) continue;
      if (root(type) || t.parent.text == type.parent.text) return;
      if (!root(t)) type.name.location.fail("type '" + t.name.text + "' has two parents");
      t.parent = type.parent;
      return;
    }
    document_.types.push_back(type);
  }

  void requirement(const SExpression& e) {
    contingent_ |= e.is(":contingent");
    static constexpr std::array kSupported = {":strips",
                                              ":typing",
                                              ":equality",
                                              ":negative-preconditions",
                                              ":disjunctive-preconditions",
                                              ":existential-preconditions",
                                              ":universal-preconditions",
                                              ":quantified-preconditions",
                                              ":conditional-effects",
                                              ":adl",
                                              ":object-fluents",
                                              ":action-costs",
                                              ":derived-predicates",
                                              ":contingent"};
    if (std::none_of(kSupported.begin(), kSupported.end(), [&](const char* s) { return e.is(s); }))
      e.location.fail("unsupported requirement '" + e.word + "'");
  }

  static syntax::Signature signature(const SExpression& e) {
    syntax::Signature s;
    s.name = name(item(e, 0, "a name"), "a name");
    for (const TypedVariable& v : typed(e, 1, true)) s.parameters.push_back(v.type);
    return s;
  }

  void functions(const SExpression& e) {
    std::size_t untyped = document_.functions.size();
    for (std::size_t i = 1; i < e.items.size(); ++i) {
      if (e.items[i].is("-")) {
        const Name range = type_name(item(e, i + 1, "a type after '-'"));
        for (; untyped < document_.functions.size(); ++untyped)
          document_.functions[untyped].range = range;
        ++i;
        continue;
      }
      document_.functions.push_back(signature(e.items[i]));
    }
    // Without a type a function is a number.
    for (; untyped < document_.functions.size(); ++untyped)
      document_.functions[untyped].range = {"number", document_.functions[untyped].name.location};
    std::erase_if(document_.functions,
                  [](const syntax::Signature& s) { return s.name.text == "total-cost"; });
  }

  /// Or a sensor: an action that only observes.
  void action(const SExpression& e) {
    const bool sensor = e.headed(":sensor");
    syntax::Action a;
    a.name = name(item(e, 1, "the action's name"), "the action's name");
    a.precondition.location = e.location;
    for (std::size_t i = 2; i < e.items.size(); i += 2) {
      const std::string key = name(e.items[i], "a keyword").text;
      const SExpression& value = item(e, i + 1, "what the keyword introduces");
      if (key == ":parameters") {
        a.parameters = typed(value, 0, true);
      } else if (key == ":precondition" || (sensor && key == ":condition")) {
        a.precondition = formula(value, true);
      } else if (key == ":effect") {
        effects(value, a.effects, a);
      } else if (key == ":observe" || (sensor && key == ":sense")) {
        observe(value, a.effects);
        contingent_ = true;
      } else {
        e.items[i].location.fail("unsupported part of an action: '" + key + "'");
      }
    }
    // Costs count only where some action has them; then the others are free.
    costs_ |= !a.cost.empty();
    document_.actions.push_back(std::move(a));
  }

  void rule(const SExpression& e) {
    const SExpression& head = item(e, 1, "a predicate with its variables");
    syntax::Rule r;
    r.head = name(item(head, 0, "a predicate with its variables"), "a predicate's name");
    r.parameters = typed(head, 1, true);
    r.body = formula(item(e, 2, "a condition"), true);
    if (e.items.size() > 3) e.items[3].location.fail("a rule has one condition: use (and ...)");
    document_.rules.push_back(std::move(r));
  }

  void observe(const SExpression& e, std::vector<Effect>& out) const {
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) observe(e.items[i], out);
      return;
    }
    Effect sense;
    sense.location = e.location;
    const bool object_fluent =
        e.list && !e.items.empty() &&
        std::any_of(document_.functions.begin(), document_.functions.end(),
                    [&](const syntax::Signature& s) { return s.name.text == e.items[0].word; });
    sense.database = object_fluent ? syntax::Database::Kv : syntax::Database::Kw;
    sense.formulas.push_back(literal(e));
    out.push_back(std::move(sense));
  }

  /// The cost of an action is one increase of (total-cost).
  static void increase(const SExpression& e, bool conditional, syntax::Action& a) {
    if (!item(e, 1, "(total-cost)").headed("total-cost"))
      e.location.fail("only (total-cost) can be increased");
    if (conditional || !a.cost.empty())
      e.location.fail("the cost of an action is one unconditional increase");
    a.cost.push_back(term(item(e, 2, "the cost")));
  }

  void effects(const SExpression& e, std::vector<Effect>& out, syntax::Action& a) const {
    if (!e.list) e.location.fail("expected an effect in parentheses");
    if (e.items.empty()) return;
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) effects(e.items[i], out, a);
      return;
    }
    if (e.headed("increase")) {
      increase(e, &out != &a.effects, a);
      return;
    }
    Effect made;
    made.location = e.location;
    if (e.headed("forall")) {
      made.kind = Effect::Kind::ForAll;
      made.variables = typed(item(e, 1, "variables"), 0, true);
      effects(item(e, 2, "an effect"), made.children, a);
    } else if (e.headed("when")) {
      made.kind = Effect::Kind::When;
      made.formulas.push_back(formula(item(e, 1, "a condition"), true));
      effects(item(e, 2, "an effect"), made.children, a);
    } else if (e.headed("assign")) {
      Formula f = make(K::Equal, e.location);
      f.terms = {term(item(e, 1, "a function")), term(item(e, 2, "a value"))};
      made.formulas.push_back(std::move(f));
    } else if (e.headed("not")) {
      made.formulas.push_back(make(K::Not, e.location, {literal(item(e, 1, "an atom"))}));
    } else if (e.headed("decrease") || e.headed("scale-up") || e.headed("scale-down")) {
      e.location.fail("unsupported effect '" + e.items[0].word + "'");
    } else {
      made.formulas.push_back(literal(e));
    }
    out.push_back(std::move(made));
  }

  void initial(const SExpression& e) {
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) initial(e.items[i]);
      return;
    }
    Effect entry;
    entry.location = e.location;
    if (e.headed("unknown")) {
      unknown_.push_back(literal(item(e, 1, "an atom")));
      return;
    }
    if (e.headed("oneof")) {
      entry.database = syntax::Database::Kx;
      alternatives(e, entry);
      const bool atoms = std::none_of(entry.formulas.begin(), entry.formulas.end(),
                                      [](const Formula& f) { return f.kind == K::Not; });
      if (atoms && entry.formulas.size() != 1)
        document_.initial.push_back(std::move(entry));
      else
        clauses_of_oneof(entry);
      return;
    }
    if (e.headed("or")) return disjunction(e);
    if (e.headed("invariant")) {
      invariants_.push_back(&e);
      return;
    }
    if (e.headed("=") && item(e, 1, "a function").headed("total-cost")) return;
    if (e.headed("not")) {
      entry.formulas.push_back(make(K::Not, e.location, {literal(item(e, 1, "an atom"))}));
    } else {
      entry.formulas.push_back(literal(e));
    }
    document_.initial.push_back(std::move(entry));
    stated_.insert(text_of(e));
  }

  void disjunction(const SExpression& e) {
    Effect entry;
    entry.location = e.location;
    entry.database = syntax::Database::Or;
    alternatives(e, entry);
    document_.initial.push_back(std::move(entry));
  }

  /// What a stated literal satisfies says nothing, and opens no atoms.
  void invariant(const SExpression& e) {
    if (std::none_of(e.items.begin() + 1, e.items.end(),
                     [&](const SExpression& l) { return stated_.contains(text_of(l)); }))
      disjunction(e);
  }

  /// The literals of (oneof ...) and (or ...); their atoms are open.
  void alternatives(const SExpression& e, Effect& entry) {
    for (std::size_t i = 1; i < e.items.size(); ++i) {
      const SExpression& l = e.items[i];
      const bool negated = l.headed("not");
      if (l.headed("and") || l.headed("or") || l.headed("oneof"))
        l.location.fail("'" + l.items[0].word + "' inside (" + e.items[0].word +
                        " ...) is not supported in the initial state");
      Formula atom = literal(negated ? item(l, 1, "an atom") : l);
      if (atom.kind == K::Atom) unknown_.push_back(atom);
      entry.formulas.push_back(negated ? make(K::Not, l.location, {std::move(atom)})
                                       : std::move(atom));
    }
    if (entry.formulas.empty()) e.location.fail("expected a literal");
  }

  /// Exactly one of several literals: one holds, and no two do.
  void clauses_of_oneof(const Effect& entry) {
    Effect clause = entry;
    clause.database = syntax::Database::Or;
    document_.initial.push_back(clause);
    const auto denied = [](const Formula& f) {
      return f.kind == K::Not ? f.children.at(0) : make(K::Not, f.location, {f});
    };
    for (std::size_t i = 0; i < entry.formulas.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        clause.formulas = {denied(entry.formulas[i]), denied(entry.formulas[j])};
        document_.initial.push_back(clause);
      }
  }

  /// Each (either a b ...) that is a type becomes one with a name.
  void declare_unions(const SExpression& e) {
    for (std::size_t i = 0; i < e.items.size(); ++i) {
      const SExpression& t = e.items[i];
      if (t.list) declare_unions(t);
      if (i == 0 || !e.items[i - 1].is("-") || !t.headed("either")) continue;
      syntax::Type type{type_name(t), {}};
      for (std::size_t m = 1; m < t.items.size(); ++m)
        type.members.push_back(name(t.items[m], "a type"));
      if (std::none_of(document_.types.begin(), document_.types.end(),
                       [&](const syntax::Type& o) { return o.name.text == type.name.text; }))
        document_.types.push_back(std::move(type));
    }
  }

  /// Where a domain has no (:types ...), those that its constants and parameters name are meant.
  void declare_used_types() {
    if (typed_ || document_.actions.empty()) return;
    std::set<std::string> known = {"", "object", "number"};
    std::vector<Name> members;
    for (const syntax::Type& t : document_.types) {  // only unions so far
      known.insert(t.name.text);
      members.insert(members.end(), t.members.begin(), t.members.end());
    }
    const auto use = [&](const Name& type) {
      if (known.insert(type.text).second) document_.types.push_back({type, {}});
    };
    for (const Name& m : members) use(m);
    for (const TypedVariable& c : document_.constants) use(c.type);
    for (const syntax::Signature& s : document_.predicates)
      for (const Name& p : s.parameters) use(p);
    for (const syntax::Action& a : document_.actions)
      for (const TypedVariable& p : a.parameters) use(p.type);
    for (const syntax::Rule& r : document_.rules)
      for (const TypedVariable& p : r.parameters) use(p.type);
  }

  /// Everything not stated is false, but for what is unknown.
  void close_world() {
    document_.closed_world = true;
    document_.unknown = std::move(unknown_);
  }

  std::shared_ptr<const Source> source_;
  syntax::Document document_;
  std::vector<const SExpression*> invariants_;  ///< of the initial state
  std::set<std::string> stated_;                ///< literals of it
  std::vector<Formula> unknown_;
  bool costs_ = false;
  bool typed_ = false;  ///< it has (:types ...)
  bool contingent_ = false;
};

}  // namespace

void declare_shared_types(syntax::Document& domain, const syntax::Document& problem) {
  const auto declare = [&](const Name& type) {
    const auto is_type = [&](const auto& t) { return t.name.text == type.text; };
    const auto is_of_it = [&](const TypedVariable& o) { return o.type.text == type.text; };
    if (type.text != "object" && std::ranges::none_of(domain.types, is_type) &&
        std::ranges::any_of(problem.constants, is_of_it))
      domain.types.push_back({type, {}});
  };
  for (const syntax::Signature& p : domain.predicates)
    for (const Name& type : p.parameters) declare(type);
  for (const syntax::Action& a : domain.actions)
    for (const TypedVariable& p : a.parameters) declare(p.type);
}

syntax::Document parse_pddl(std::shared_ptr<const Source> source) {
  return PddlParser(std::move(source)).read();
}

}  // namespace kaboum::plan
