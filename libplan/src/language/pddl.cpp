#include "language/pddl.h"

#include <algorithm>
#include <array>
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

constexpr int kMaximumNesting = 200;

/// An s-expression: a word or a list. Words are lower case, as PDDL ignores case.
struct Expression {
  bool list = false;
  std::string word;
  std::vector<Expression> items;
  Place place;

  [[nodiscard]] bool is(std::string_view w) const { return !list && word == w; }
  [[nodiscard]] bool headed(std::string_view w) const {
    return list && !items.empty() && items[0].is(w);
  }
};

class Lisp {
 public:
  explicit Lisp(const Source& source) : source_(source) {}

  std::vector<Expression> read() {
    std::vector<Expression> all;
    for (skip(); at_ < source_.text.size(); skip()) all.push_back(expression(0));
    return all;
  }

 private:
  void skip() {
    const std::string& t = source_.text;
    while (at_ < t.size()) {
      if (t[at_] == ';') {
        while (at_ < t.size() && t[at_] != '\n') ++at_;
      } else if (t[at_] == ' ' || t[at_] == '\t' || t[at_] == '\n' || t[at_] == '\r') {
        ++at_;
      } else {
        return;
      }
    }
  }

  Expression expression(int depth) {
    if (depth > kMaximumNesting) source_.fail(at_, "nested too deeply");
    Expression e;
    e.place = {&source_, at_};
    const std::string& t = source_.text;
    if (t[at_] == ')') source_.fail(at_, "')' without '('");
    if (t[at_] != '(') {
      while (at_ < t.size() &&
             std::string_view("() \t\r\n;").find(t[at_]) == std::string_view::npos) {
        const char c = t[at_++];
        e.word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      }
      return e;
    }
    const std::size_t opened = at_++;
    e.list = true;
    for (skip(); at_ < t.size() && t[at_] != ')'; skip()) e.items.push_back(expression(depth + 1));
    if (at_ >= t.size()) source_.fail(opened, "'(' is never closed");
    ++at_;
    return e;
  }

  const Source& source_;
  std::size_t at_ = 0;
};

class Reader {
 public:
  explicit Reader(std::shared_ptr<const Source> source) : source_(std::move(source)) {}

  syntax::Document read() {
    document_.sources.push_back(source_);
    const std::vector<Expression> all = Lisp(*source_).read();
    if (all.empty()) source_->fail(0, "expected (define ...)");
    for (const Expression& e : all) define(e);
    if (costs_)
      for (syntax::Action& a : document_.actions)
        if (a.cost.empty()) a.cost.push_back({Term::Kind::Name, {"0", a.name.place}, {}});
    for (syntax::Action& a : document_.actions) a.effects = additions_last(a.effects);
    document_.assumes_complete = !contingent_ && !document_.actions.empty();
    if (document_.assumes_complete && !document_.unknown.empty())
      document_.unknown[0].place.fail(
          "incomplete knowledge needs the requirement ':contingent' in the domain");
    for (syntax::Action& a : document_.actions) a.effects = conditions_decided(a.effects);
    return std::move(document_);
  }

 private:
  static const Expression& item(const Expression& e, std::size_t i, const char* what) {
    if (!e.list || i >= e.items.size()) e.place.fail(std::string("expected ") + what);
    return e.items[i];
  }
  static Name name(const Expression& e, const char* what) {
    if (e.list || e.word.empty()) e.place.fail(std::string("expected ") + what);
    return {e.word, e.place};
  }

  void define(const Expression& e) {
    if (!e.headed("define")) e.place.fail("expected (define ...)");
    const Expression& head = item(e, 1, "(domain NAME) or (problem NAME)");
    const bool domain = head.headed("domain");
    if (!domain && !head.headed("problem"))
      head.place.fail("expected (domain NAME) or (problem NAME)");
    const Name n = name(item(head, 1, "a name"), "a name");
    if (domain || document_.name.text.empty()) document_.name = n;
    for (std::size_t i = 2; i < e.items.size(); ++i) section(e.items[i]);
    if (!domain) close_world(head.place);
  }

  void section(const Expression& e) {
    const std::string key = name(item(e, 0, "a section"), "a section").text;
    if (key == ":requirements") {
      for (std::size_t i = 1; i < e.items.size(); ++i) requirement(e.items[i]);
    } else if (key == ":types") {
      for (const TypedVariable& t : typed(e, 1, false)) document_.types.push_back({t.name, t.type});
    } else if (key == ":constants" || key == ":objects") {
      for (TypedVariable& c : typed(e, 1, false)) document_.constants.push_back(std::move(c));
    } else if (key == ":predicates") {
      for (std::size_t i = 1; i < e.items.size(); ++i)
        document_.predicates.push_back(signature(e.items[i]));
    } else if (key == ":functions") {
      functions(e);
    } else if (key == ":action") {
      action(e);
    } else if (key == ":init") {
      for (std::size_t i = 1; i < e.items.size(); ++i) initial(e.items[i]);
    } else if (key == ":goal") {
      document_.goals.push_back(formula(item(e, 1, "a goal"), true));
    } else if (key == ":metric") {
      const Expression& what = item(e, 2, "what to minimise");
      if (!item(e, 1, "minimize").is("minimize") ||
          !(what.is("total-cost") || what.headed("total-cost")))
        e.place.fail("only the metric 'minimize (total-cost)' is supported");
    } else if (key != ":domain") {
      e.place.fail("unsupported section '" + key + "'");
    }
  }

  void requirement(const Expression& e) {
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
                                              ":contingent"};
    if (std::none_of(kSupported.begin(), kSupported.end(), [&](const char* s) { return e.is(s); }))
      e.place.fail("unsupported requirement '" + e.word + "'");
  }

  /// "a b - t c": items from `from` on.
  static std::vector<TypedVariable> typed(const Expression& e, std::size_t from, bool variables) {
    std::vector<TypedVariable> result;
    std::size_t untyped = 0;
    for (std::size_t i = from; i < e.items.size(); ++i) {
      if (e.items[i].is("-")) {
        const Expression& t = item(e, i + 1, "a type after '-'");
        if (t.list) t.place.fail("(either ...) is not supported");
        for (; untyped < result.size(); ++untyped) result[untyped].type = {t.word, t.place};
        ++i;
        continue;
      }
      Name n = name(e.items[i], "a name");
      if (variables != (n.text[0] == '?'))
        n.place.fail(variables ? "expected a variable such as ?x"
                               : "expected a name, found a variable");
      if (variables) n.text.erase(0, 1);
      if (variables && n.text.empty()) n.place.fail("a variable's name must follow '?'");
      result.push_back({n, {}});
    }
    return result;
  }

  static syntax::Signature signature(const Expression& e) {
    syntax::Signature s;
    s.name = name(item(e, 0, "a name"), "a name");
    for (const TypedVariable& v : typed(e, 1, true)) s.parameters.push_back(v.type);
    return s;
  }

  void functions(const Expression& e) {
    std::size_t untyped = document_.functions.size();
    for (std::size_t i = 1; i < e.items.size(); ++i) {
      if (e.items[i].is("-")) {
        const Name range = name(item(e, i + 1, "a type after '-'"), "a type");
        for (; untyped < document_.functions.size(); ++untyped)
          document_.functions[untyped].range = range;
        ++i;
        continue;
      }
      document_.functions.push_back(signature(e.items[i]));
    }
    // Without a type a function is a number.
    for (; untyped < document_.functions.size(); ++untyped)
      document_.functions[untyped].range = {"number", document_.functions[untyped].name.place};
    std::erase_if(document_.functions,
                  [](const syntax::Signature& s) { return s.name.text == "total-cost"; });
  }

  // ---- formulas: a closed-world condition p becomes K(p), (not p) becomes K(!p) -----------------
  Term term(const Expression& e) const {
    Term t;
    if (!e.list) {
      t.name = {e.word, e.place};
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

  static Formula make(K kind, const Place& place, std::vector<Formula> children = {}) {
    Formula f;
    f.kind = kind;
    f.place = place;
    f.children = std::move(children);
    return f;
  }

  /// Inside K: an atom or an equality.
  Formula literal(const Expression& e) const {
    if (e.headed("=")) {
      Formula f = make(K::Equal, e.place);
      f.terms = {term(item(e, 1, "a term")), term(item(e, 2, "a term"))};
      return f;
    }
    Formula f = make(K::Atom, e.place);
    f.terms.push_back(term(e));
    return f;
  }

  Formula formula(const Expression& e, bool positive) const {
    if (!e.list) e.place.fail("expected a condition in parentheses");
    if (e.items.empty()) return make(positive ? K::True : K::False, e.place);
    const auto children = [&](std::size_t from, bool sign) {
      std::vector<Formula> all;
      for (std::size_t i = from; i < e.items.size(); ++i) all.push_back(formula(e.items[i], sign));
      return all;
    };
    if (e.headed("and")) return make(positive ? K::And : K::Or, e.place, children(1, positive));
    if (e.headed("or")) return make(positive ? K::Or : K::And, e.place, children(1, positive));
    if (e.headed("not")) return formula(item(e, 1, "a condition"), !positive);
    if (e.headed("imply"))
      return make(positive ? K::Or : K::And, e.place,
                  {formula(item(e, 1, "a condition"), !positive),
                   formula(item(e, 2, "a condition"), positive)});
    if (e.headed("exists") || e.headed("forall")) {
      Formula f = make(e.headed("exists") == positive ? K::Exists : K::ForAll, e.place,
                       {formula(item(e, 2, "a condition"), positive)});
      f.variables = typed(item(e, 1, "variables"), 0, true);
      return f;
    }
    Formula inner = literal(e);
    if (!positive) inner = make(K::Not, e.place, {std::move(inner)});
    return make(K::Known, e.place, {std::move(inner)});
  }

  // ---- actions -------------------------------------------------------------------------------
  void action(const Expression& e) {
    syntax::Action a;
    a.name = name(item(e, 1, "the action's name"), "the action's name");
    a.precondition.place = e.place;
    for (std::size_t i = 2; i < e.items.size(); i += 2) {
      const std::string key = name(e.items[i], "a keyword").text;
      const Expression& value = item(e, i + 1, "what the keyword introduces");
      if (key == ":parameters") {
        a.parameters = typed(value, 0, true);
      } else if (key == ":precondition") {
        a.precondition = formula(value, true);
      } else if (key == ":effect") {
        effects(value, a.effects, a);
      } else if (key == ":observe") {
        observe(value, a.effects);
        contingent_ = true;
      } else {
        e.items[i].place.fail("unsupported part of an action: '" + key + "'");
      }
    }
    // Costs count only where some action has them; then the others are free.
    costs_ |= !a.cost.empty();
    document_.actions.push_back(std::move(a));
  }

  void observe(const Expression& e, std::vector<Effect>& out) const {
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) observe(e.items[i], out);
      return;
    }
    Effect sense;
    sense.place = e.place;
    const bool object_fluent =
        e.list && !e.items.empty() &&
        std::any_of(document_.functions.begin(), document_.functions.end(),
                    [&](const syntax::Signature& s) { return s.name.text == e.items[0].word; });
    sense.database = object_fluent ? syntax::Database::Kv : syntax::Database::Kw;
    sense.formulas.push_back(literal(e));
    out.push_back(std::move(sense));
  }

  void effects(const Expression& e, std::vector<Effect>& out, syntax::Action& a) const {
    if (!e.list) e.place.fail("expected an effect in parentheses");
    if (e.items.empty()) return;
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) effects(e.items[i], out, a);
      return;
    }
    if (e.headed("increase")) {
      if (!item(e, 1, "(total-cost)").headed("total-cost"))
        e.place.fail("only (total-cost) can be increased");
      if (&out != &a.effects || !a.cost.empty())
        e.place.fail("the cost of an action is one unconditional increase");
      a.cost.push_back(term(item(e, 2, "the cost")));
      return;
    }
    Effect made;
    made.place = e.place;
    if (e.headed("forall")) {
      made.kind = Effect::Kind::ForAll;
      made.variables = typed(item(e, 1, "variables"), 0, true);
      effects(item(e, 2, "an effect"), made.children, a);
    } else if (e.headed("when")) {
      made.kind = Effect::Kind::When;
      made.formulas.push_back(formula(item(e, 1, "a condition"), true));
      made.formulas.push_back(formula(item(e, 1, "a condition"), false));  // for the unknown case
      effects(item(e, 2, "an effect"), made.children, a);
    } else if (e.headed("assign")) {
      Formula f = make(K::Equal, e.place);
      f.terms = {term(item(e, 1, "a function")), term(item(e, 2, "a value"))};
      made.formulas.push_back(std::move(f));
    } else if (e.headed("not")) {
      made.formulas.push_back(make(K::Not, e.place, {literal(item(e, 1, "an atom"))}));
    } else if (e.headed("decrease") || e.headed("scale-up") || e.headed("scale-down")) {
      e.place.fail("unsupported effect '" + e.items[0].word + "'");
    } else {
      made.formulas.push_back(literal(e));
    }
    out.push_back(std::move(made));
  }

  /// PDDL: what one action both adds and deletes holds afterwards. Here the later update wins.
  static std::vector<Effect> additions_last(const std::vector<Effect>& effects) {
    const auto part = [](const auto& self, const std::vector<Effect>& list,
                         bool deletions) -> std::vector<Effect> {
      std::vector<Effect> out;
      for (const Effect& e : list) {
        if (e.kind == Effect::Kind::When || e.kind == Effect::Kind::ForAll) {
          Effect copy = e;
          copy.children = self(self, e.children, deletions);
          if (!copy.children.empty()) out.push_back(std::move(copy));
        } else if ((e.formulas.at(0).kind == K::Not) == deletions) {
          out.push_back(e);
        }
      }
      return out;
    };
    std::vector<Effect> all = part(part, effects, true);
    for (Effect& e : part(part, effects, false)) all.push_back(std::move(e));
    return all;
  }

  /// A conditional effect happens or not in the world, known or not: with incomplete knowledge, it
  /// may happen where its condition is not known to fail. So far a When has two formulas: that its
  /// condition is known to hold, and that it is known to fail.
  std::vector<Effect> conditions_decided(const std::vector<Effect>& effects) const {
    std::vector<Effect> all;
    for (const Effect& e : effects) {
      Effect known = e;
      known.children = conditions_decided(e.children);
      if (e.kind != Effect::Kind::When) {
        all.push_back(std::move(known));
        continue;
      }
      Effect unknown = known;
      known.formulas.resize(1);
      all.push_back(std::move(known));
      if (!contingent_) continue;
      unknown.children = possibly(std::move(unknown.children));
      if (unknown.children.empty()) continue;
      unknown.formulas = {make(
          K::And, e.place,
          {make(K::Not, e.place, {e.formulas.at(0)}), make(K::Not, e.place, {e.formulas.at(1)})})};
      all.push_back(std::move(unknown));
    }
    return all;
  }

  static std::vector<Effect> possibly(std::vector<Effect> effects) {
    std::vector<Effect> all;
    for (Effect& e : effects) {
      if (e.kind == Effect::Kind::When || e.kind == Effect::Kind::ForAll) {
        e.children = possibly(std::move(e.children));
        if (e.children.empty()) continue;
      } else if (e.database != syntax::Database::Kf) {
        continue;
      } else {
        e.kind = Effect::Kind::Maybe;
      }
      all.push_back(std::move(e));
    }
    return all;
  }

  // ---- initial state ---------------------------------------------------------------------------
  void initial(const Expression& e) {
    if (e.headed("and")) {
      for (std::size_t i = 1; i < e.items.size(); ++i) initial(e.items[i]);
      return;
    }
    Effect entry;
    entry.place = e.place;
    if (e.headed("unknown")) {
      unknown_.push_back(literal(item(e, 1, "an atom")));
      return;
    }
    if (e.headed("oneof")) {
      entry.database = syntax::Database::Kx;
      for (std::size_t i = 1; i < e.items.size(); ++i) {
        entry.formulas.push_back(literal(e.items[i]));
        unknown_.push_back(entry.formulas.back());
      }
      document_.initial.push_back(std::move(entry));
      return;
    }
    if (e.headed("or"))
      e.place.fail(
          "(or ...) is not supported in the initial state; (oneof ...) and (unknown ...) are");
    if (e.headed("=") && item(e, 1, "a function").headed("total-cost")) return;
    if (e.headed("not")) {
      entry.formulas.push_back(make(K::Not, e.place, {literal(item(e, 1, "an atom"))}));
    } else {
      entry.formulas.push_back(literal(e));
    }
    document_.initial.push_back(std::move(entry));
  }

  /// Everything not stated is false, but for what is unknown.
  void close_world(const Place& place) {
    document_.closed.push_back({"all", place});
    document_.unknown = std::move(unknown_);
  }

  std::shared_ptr<const Source> source_;
  syntax::Document document_;
  std::vector<Formula> unknown_;
  bool costs_ = false;
  bool contingent_ = false;
};

/// Writes the classical part of the language, and sensing.
class Writer {
 public:
  std::string write(const syntax::Document& d) {
    document_ = &d;
    // PDDL's "object" is the root of all types; as one type among others it needs another name.
    const auto is_object = [](const syntax::Type& t) { return t.name.text == "object"; };
    rename_object_ = std::any_of(d.types.begin(), d.types.end(), is_object) && d.types.size() > 1 &&
                     std::none_of(d.types.begin(), d.types.end(),
                                  [](const syntax::Type& t) { return t.parent.text == "object"; });
    incomplete_ = !d.unknown.empty() ||
                  std::any_of(d.initial.begin(), d.initial.end(),
                              [](const Effect& e) { return e.database == syntax::Database::Kx; });
    check_names(d);
    if (!d.externals.empty()) refuse("external function '" + d.externals[0].name.text + "'");
    const std::string title = d.name.text.empty() ? "unnamed" : d.name.text;
    std::string out =
        "(define (domain " + title +
        ")\n (:requirements :typing :adl :object-fluents :action-costs :contingent)\n";
    out += " (:types";
    for (const syntax::Type& t : d.types)
      if (t.name.text != "number" && (t.name.text != "object" || rename_object_))
        out += " " + type(t.name) + " - " + (t.parent.text.empty() ? "object" : t.parent.text);
    out += ")\n (:constants";
    for (const TypedVariable& c : d.constants) out += " " + c.name.text + " - " + type(c.type);
    out += ")\n (:predicates";
    for (const syntax::Signature& s : d.predicates) out += " " + signature(s);
    out += ")\n (:functions";
    for (const syntax::Signature& s : d.functions)
      out += " " + signature(s) + " - " + type(s.range);
    const bool costs = std::any_of(d.actions.begin(), d.actions.end(),
                                   [](const auto& a) { return !a.cost.empty(); });
    out += std::string(costs ? " (total-cost) - number" : "") + ")\n";
    for (const syntax::Action& a : d.actions) out += action(a, costs);
    out += ")\n\n(define (problem " + title + "-problem)\n (:domain " + title + ")\n (:init";
    for (const Effect& e : d.initial) out += "\n  " + initial(e);
    for (const Formula& f : d.unknown) out += "\n  (unknown " + literal(f) + ")";
    const bool closed = std::any_of(d.closed.begin(), d.closed.end(),
                                    [](const Name& n) { return n.text == "all"; });
    if (!closed)
      refuse(
          "an open world: PDDL takes what is not stated for false; state 'closed: all' if that is "
          "meant");
    out += ")\n (:goal (and";
    for (const Formula& g : d.goals) out += " " + condition(g);
    out += "))\n";
    if (costs) out += " (:metric minimize (total-cost))\n";
    return out + ")\n";
  }

 private:
  [[noreturn]] static void refuse(const std::string& what) {
    throw Error(ErrorCode::InvalidInput, "PDDL cannot say: " + what);
  }
  /// PDDL ignores case: names that differ in nothing else would be one.
  static void check_names(const syntax::Document& d) {
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
  [[nodiscard]] std::string type(const Name& n) const {
    if (n.text.empty()) return "object";
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
        refuse("a query of Kw, Kv, LCW or extern");
    }
  }
  std::string effects(const std::vector<Effect>& list, std::string& observed) const {
    std::string out = "(and";
    for (const Effect& e : list) {
      switch (e.kind) {
        case Effect::Kind::Add:
          if (e.database == syntax::Database::Kw || e.database == syntax::Database::Kv) {
            if (!observed.empty()) refuse("two observations of one action");
            observed = literal(e.formulas.at(0));
          } else if (e.database != syntax::Database::Kf) {
            refuse("an effect on Kx or LCW");
          } else if (rules_out(e.formulas.at(0))) {
            refuse("the observation that a term has not some value");
          } else if (e.formulas.at(0).kind == K::Equal) {
            const bool swapped = !is_function(e.formulas[0].terms.at(0));
            out += " (assign " + term(e.formulas[0].terms.at(swapped ? 1 : 0), true) + " " +
                   term(e.formulas[0].terms.at(swapped ? 0 : 1), false) + ")";
          } else {
            out += " " + literal(e.formulas.at(0));
          }
          break;
        case Effect::Kind::Maybe:
        case Effect::Kind::Delete:
          refuse("loss of knowledge, del(...) or maybe(...)");
        case Effect::Kind::When: {
          std::string inner;
          if (incomplete_)
            refuse(
                "a conditional effect where knowledge is incomplete: that of PDDL may happen while "
                "its condition is not known");
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
  /// In PDDL an addition wins over a deletion, wherever it stands; here the later update does.
  static void refuse_late_deletions(const std::vector<Effect>& list, std::set<std::string>& added,
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
      default:
        refuse("initial entries of Kw, Kv and LCW");
    }
  }

  const syntax::Document* document_ = nullptr;
  bool rename_object_ = false;
  bool incomplete_ = false;  ///< not all is known at the start
};

}  // namespace

std::string print_pddl(const syntax::Document& document) { return Writer().write(document); }

syntax::Document parse_pddl(std::shared_ptr<const Source> source) {
  return Reader(std::move(source)).read();
}

}  // namespace kaboum::plan
