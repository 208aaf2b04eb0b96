#include "language/kpl_parser.h"

#include <array>
#include <optional>

#include "language/lexer.h"

namespace kaboum::plan {
namespace {

using syntax::Effect;
using syntax::Formula;
using syntax::Name;
using syntax::Term;
using syntax::TypedVariable;

constexpr int kMaximumNesting = 200;  // recursion stays far from the stack's end

class Parser {
 public:
  explicit Parser(const Source& source) : source_(&source), tokens_(tokenize(source)) {}

  syntax::Document document() {
    while (!at_end()) section();
    return std::move(document_);
  }

  /// Reads one piece, which must be the whole text.
  template <class Read>
  auto piece(Read read) {
    auto result = read(*this);
    if (!at_end()) place().fail("unexpected " + found());
    return result;
  }

  // Public to the pieces below; the class itself is private to this file.
  // ---- tokens ------------------------------------------------------------------------------
  [[nodiscard]] const Token& peek(std::size_t ahead = 0) const {
    return tokens_[std::min(next_ + ahead, tokens_.size() - 1)];
  }
  [[nodiscard]] bool at_end() const { return peek().kind == Token::Kind::End; }
  [[nodiscard]] bool is(std::string_view symbol, std::size_t ahead = 0) const {
    return peek(ahead).is(symbol);
  }
  [[nodiscard]] Place place() const { return {source_, peek().offset}; }
  bool accept(std::string_view symbol) {
    if (!is(symbol)) return false;
    ++next_;
    return true;
  }
  [[nodiscard]] std::string found() const {
    return at_end() ? "the end of the file" : "'" + peek().text + "'";
  }
  void expect(std::string_view symbol, std::string_view where) {
    if (!accept(symbol))
      place().fail("expected '" + std::string(symbol) + "' " + std::string(where) + ", found " +
                   found());
  }
  Name name(std::string_view what) {
    if (peek().kind != Token::Kind::Name)
      place().fail("expected " + std::string(what) + ", found " + found());
    Name result{peek().text, place()};
    ++next_;
    return result;
  }
  /// Depth of nesting, limited.
  class Level {
   public:
    explicit Level(Parser& parser) : parser_(parser) {
      if (++parser_.depth_ > kMaximumNesting) parser_.place().fail("nested too deeply");
    }
    ~Level() { --parser_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    Parser& parser_;
  };

  // ---- sections ----------------------------------------------------------------------------
  [[nodiscard]] bool at_section() const {
    static constexpr std::array kWithColon = {
        "types",  "constants", "objects", "predicates", "functions", "externals", "init",
        "closed", "unknown",   "goal",    "preconds",   "effects",   "cost"};
    static constexpr std::array kOthers = {"action", "table", "domain", "problem", "symbols"};
    if (at_end()) return true;
    if (peek().kind != Token::Kind::Name) return false;
    for (const char* keyword : kWithColon)
      if (is(keyword) && is(":", 1)) return true;
    if (is("symbols")) return true;
    for (const char* keyword : kOthers)
      if (is(keyword) && peek(1).kind == Token::Kind::Name)
        return !is("table") || is(":", 2);  // an object may be called table
    return false;
  }

  void section() {
    const Place at = place();
    if (accept("symbols")) {
      accept(":");
    } else if (is("domain") || is("problem")) {
      const bool domain = accept("domain");
      if (!domain) ++next_;
      const Name n = name("a name");
      if (domain || document_.name.text.empty()) document_.name = n;
    } else if (is("action")) {
      action();
    } else if (is("table")) {
      table();
    } else if (heading("types")) {
      list([&] { types(); });
    } else if (heading("constants") || heading("objects")) {
      constants();
    } else if (heading("predicates")) {
      list([&] { document_.predicates.push_back(signature(false)); });
    } else if (heading("functions")) {
      list([&] { document_.functions.push_back(signature(true)); });
    } else if (heading("externals")) {
      list([&] { document_.externals.push_back(external()); });
    } else if (heading("closed")) {
      list([&] { document_.closed.push_back(name("a predicate")); });
    } else if (heading("unknown")) {
      list([&] { document_.unknown.push_back(literal()); });
    } else if (heading("init")) {
      initial();
    } else if (heading("goal")) {
      document_.goals.push_back(formula());
      if (!at_section()) place().fail("expected the end of the goal, found " + found());
    } else {
      at.fail(
          "expected a section such as 'types:', 'predicates:', 'action', 'init:' or 'goal:', "
          "found " +
          found());
    }
    while (accept(";")) {
    }
  }

  bool heading(std::string_view keyword) {
    if (!is(keyword) || !is(":", 1)) return false;
    next_ += 2;
    return true;
  }

  /// Items up to the next section; ',' and ';' between them are optional.
  template <class Item>
  void list(Item item) {
    while (!at_section()) {
      item();
      while (accept(",") || accept(";")) {
      }
    }
  }

  void types() {
    syntax::Type type{name("a type"), {}};
    if (accept(":")) type.parent = name("the type's parent");
    document_.types.push_back(type);
  }

  void constants() {
    Name type;
    list([&] {
      const Name first = name("a constant");
      if (peek().kind == Token::Kind::Name && !at_section()) {
        type = first;
        document_.constants.push_back({name("a constant"), type});
      } else {
        document_.constants.push_back({first, type});
      }
    });
  }

  syntax::Signature signature(bool with_range) {
    syntax::Signature s;
    s.name = name("a name");
    if (accept("/")) {
      if (peek().kind != Token::Kind::Number) place().fail("expected the number of arguments");
      if (peek().text.size() > 2) place().fail("too many arguments");
      s.parameters.resize(static_cast<std::size_t>(std::stoi(peek().text)));
      ++next_;
    } else if (accept("(")) {
      while (!is(")")) {
        if (peek().kind == Token::Kind::Variable) {
          ++next_;
          if (accept(":")) {
            s.parameters.push_back(name("a type"));
          } else {
            s.parameters.push_back({});
          }
        } else {
          s.parameters.push_back(name("a type"));
        }
        if (!accept(",")) break;
      }
      expect(")", "after the types of the arguments");
    }
    if (with_range && accept(":")) s.range = name("the type of the value");
    return s;
  }

  syntax::Signature external() {
    syntax::Signature s = signature(true);
    if (is("volatile")) {
      ++next_;
      s.is_volatile = true;
    }
    return s;
  }

  void table() {
    ++next_;
    syntax::Table t;
    t.external = name("an external function");
    expect(":", "after the name of the external function");
    list([&] {
      syntax::Row row;
      row.place = place();
      expect("(", "before the arguments of a row");
      while (!is(")")) {
        row.arguments.push_back(name("a constant"));
        if (!accept(",")) break;
      }
      expect(")", "after the arguments of a row");
      if (accept("=")) row.value = name("a value");
      t.rows.push_back(std::move(row));
    });
    document_.tables.push_back(std::move(t));
  }

  void action() {
    ++next_;
    syntax::Action a;
    a.name = name("the action's name");
    if (accept("(")) {
      if (!is(")")) a.parameters = parameters();
      expect(")", "after the action's parameters");
    }
    a.precondition.kind = Formula::Kind::True;
    a.precondition.place = place();
    bool preconds = false;
    bool effects_seen = false;
    while (true) {
      const Place at = place();
      if (heading("preconds")) {
        if (preconds) at.fail("a second 'preconds:' in one action");
        preconds = true;
        a.precondition = formula();
      } else if (heading("effects")) {
        if (effects_seen) at.fail("a second 'effects:' in one action");
        effects_seen = true;
        a.effects = effects();
      } else if (heading("cost")) {
        if (!a.cost.empty()) at.fail("a second 'cost:' in one action");
        a.cost.push_back(cost());
      } else if (!accept(";")) {
        break;
      }
    }
    if (!at_section())
      place().fail("expected 'preconds:', 'effects:' or the next section, found " + found() +
                   (is("and") || is("or") ? " ('&' means and, '|' means or)" : ""));
    document_.actions.push_back(std::move(a));
  }

  Term cost() { return peek().kind == Token::Kind::Number ? number() : term(); }

  Term number() {
    Term t;
    t.name = {peek().text, place()};
    ++next_;
    return t;
  }

  std::vector<TypedVariable> parameters() {
    std::vector<TypedVariable> result;
    do {
      TypedVariable v;
      if (peek().kind == Token::Kind::Name) v.type = name("a type");  // the thesis's "object o"
      if (peek().kind == Token::Kind::Variable) {
        v.name = {peek().text, place()};
        ++next_;
      } else {
        place().fail("expected a parameter such as ?x, found " + found());
      }
      if (accept(":")) v.type = name("a type");
      result.push_back(std::move(v));
    } while (accept(","));
    return result;
  }

  // ---- formulas ----------------------------------------------------------------------------
  Formula make(Formula::Kind kind) const {
    Formula f;
    f.kind = kind;
    f.place = place();
    return f;
  }

  Formula joined(Formula::Kind kind, std::string_view symbol, Formula (Parser::*operand)()) {
    Formula first = (this->*operand)();
    if (!is(symbol)) return first;
    Formula all = make(kind);
    all.children.push_back(std::move(first));
    while (accept(symbol)) all.children.push_back((this->*operand)());
    return all;
  }

  Formula formula() {
    const Level level(*this);
    return joined(Formula::Kind::Or, "|", &Parser::exclusive);
  }
  Formula exclusive() { return joined(Formula::Kind::Xor, "xor", &Parser::conjunction); }
  Formula conjunction() { return joined(Formula::Kind::And, "&", &Parser::unary); }

  Formula unary() {
    const Level level(*this);
    Formula f = make(Formula::Kind::Not);
    if (accept("!")) {
      f.children.push_back(unary());
      return f;
    }
    if (accept("(")) {
      f = formula();
      expect(")", "to close the parenthesis");
      return f;
    }
    if (is("(", 1)) {
      if (accept("K")) return modal(std::move(f), Formula::Kind::Known);
      if (accept("Kw")) return modal(std::move(f), Formula::Kind::KnowWhether);
      if (accept("LCW")) return modal(std::move(f), Formula::Kind::ClosedWorld);
      if (accept("Kv")) {
        f.kind = Formula::Kind::KnowValue;
        expect("(", "after Kv");
        f.terms.push_back(term());
        expect(")", "after the function term of Kv");
        return f;
      }
      if (accept("forallK") || accept("forall"))
        return quantified(std::move(f), Formula::Kind::ForAll);
      if (accept("existsK") || accept("exists"))
        return quantified(std::move(f), Formula::Kind::Exists);
      if (is("extern")) {
        f.terms.push_back(term());
        return comparison(std::move(f), Formula::Kind::Extern);
      }
    }
    if (accept("true")) {
      f.kind = Formula::Kind::True;
      return f;
    }
    if (accept("false")) {
      f.kind = Formula::Kind::False;
      return f;
    }
    std::string hint;
    if (peek().kind == Token::Kind::Name)
      hint = peek(1).kind == Token::Kind::Name && !is(":", 2)
                 ? " (a section begins with 'action', 'init:', 'goal:' and the like)"
                 : ": write K(" + peek().text + (is("(", 1) ? "(...)" : "") + ") for what is known";
    place().fail(
        "expected a query such as K(...), !K(...), Kw(...), Kv(...), forallK or extern(...), "
        "found " +
        found() + hint);
  }

  Formula modal(Formula f, Formula::Kind kind) {
    f.kind = kind;
    expect("(", "after the operator");
    f.children.push_back(literal());
    expect(")", "after the formula");
    return f;
  }

  Formula quantified(Formula f, Formula::Kind kind) {
    f.kind = kind;
    expect("(", "after the quantifier");
    f.variables = parameters();
    expect(")", "after the quantifier's variables");
    f.children.push_back(unary());
    return f;
  }

  /// What stands inside K(...): an atom, an (in)equality, an extern, or its negation.
  Formula literal() {
    const Level level(*this);
    Formula f = make(Formula::Kind::Atom);
    if (accept("!")) {
      f.kind = Formula::Kind::Not;
      f.children.push_back(literal());
      return f;
    }
    if (accept("(")) {
      f = literal();
      expect(")", "to close the parenthesis");
      return f;
    }
    f.terms.push_back(term());
    const bool external = f.terms[0].kind == Term::Kind::Extern;
    return comparison(std::move(f), external ? Formula::Kind::Extern : Formula::Kind::Atom);
  }

  Formula comparison(Formula f, Formula::Kind alone) {
    f.kind = alone;
    if (is("=") || is("!=")) {
      f.kind = is("=") ? Formula::Kind::Equal : Formula::Kind::NotEqual;
      ++next_;
      f.terms.push_back(term());
    }
    return f;
  }

  Term term() {
    const Level level(*this);
    Term t;
    if (peek().kind == Token::Kind::Variable) {
      t.kind = Term::Kind::Variable;
      t.name = {peek().text, place()};
      ++next_;
      return t;
    }
    if (peek().kind == Token::Kind::Number) return number();
    t.name = name("a variable, a constant or a function");
    if (t.name.text == "extern" && accept("(")) {
      t = term();
      if (t.kind == Term::Kind::Variable)
        t.name.place.fail("expected an external function after extern(");
      t.kind = Term::Kind::Extern;
      expect(")", "to close extern(");
      return t;
    }
    if (accept("(")) {
      t.kind = Term::Kind::Call;
      while (!is(")")) {
        t.arguments.push_back(term());
        if (!accept(",")) break;
      }
      expect(")", "after the arguments");
    }
    return t;
  }

  // ---- effects -----------------------------------------------------------------------------
  std::vector<Effect> effects() {
    std::vector<Effect> result;
    while (!at_section() && !is(")")) {
      result.push_back(effect());
      while (accept(",") || accept(";") || accept("&")) {
      }
    }
    return result;
  }

  Effect effect() {
    const Level level(*this);
    Effect e;
    e.place = place();
    if ((is("add") || is("del") || is("maybe")) && is("(", 1)) return update();
    if ((is("forall") || is("forallK")) && is("(", 1)) {
      next_ += 2;
      e.kind = Effect::Kind::ForAll;
      e.variables = parameters();
      expect(")", "after the variables of forall");
      e.children = body();
      return e;
    }
    e.kind = Effect::Kind::When;
    e.formulas.push_back(formula());
    expect("=>", "between an effect's condition and its updates");
    e.children = body();
    return e;
  }

  /// One effect, several joined by '&', or several in parentheses.
  std::vector<Effect> body() {
    std::vector<Effect> result;
    if (accept("{")) {
      while (!is("}") && !at_section()) {
        result.push_back(effect());
        while (accept(",") || accept(";") || accept("&")) {
        }
      }
      expect("}", "to close the group of effects");
      return result;
    }
    if (is("(") && parenthesis_holds_effect()) {
      ++next_;
      result = effects();
      expect(")", "to close the group of effects");
      return result;
    }
    do result.push_back(effect());
    while (is("&") && (is("add", 1) || is("del", 1) || is("maybe", 1)) && accept("&"));
    return result;
  }

  /// Whether the parenthesis at hand groups effects, not a formula: "=>" or an update inside it.
  [[nodiscard]] bool parenthesis_holds_effect() const {
    int depth = 0;
    for (std::size_t i = next_; i < tokens_.size(); ++i) {
      if (tokens_[i].is("(")) ++depth;
      if (tokens_[i].is(")") && --depth == 0) return false;
      if (tokens_[i].is("=>")) return true;
      if ((tokens_[i].is("add") || tokens_[i].is("del") || tokens_[i].is("maybe")) &&
          i + 1 < tokens_.size() && tokens_[i + 1].is("("))
        return true;
    }
    return false;
  }

  std::optional<syntax::Database> database() {
    if (accept("Kf")) return syntax::Database::Kf;
    if (accept("Kw")) return syntax::Database::Kw;
    if (accept("Kv")) return syntax::Database::Kv;
    if (accept("Kx")) return syntax::Database::Kx;
    if (accept("LCW")) return syntax::Database::Lcw;
    return std::nullopt;
  }

  Effect update() {
    Effect e;
    e.place = place();
    e.kind = is("add") ? Effect::Kind::Add : is("del") ? Effect::Kind::Delete : Effect::Kind::Maybe;
    ++next_;
    expect("(", "after add, del or maybe");
    if (const auto d = database()) {
      e.database = *d;
    } else {
      place().fail("expected a database (Kf, Kw, Kv, Kx or LCW), found " + found());
    }
    if (e.kind == Effect::Kind::Maybe && e.database != syntax::Database::Kf)
      e.place.fail("maybe(...) is about the world: its database is Kf");
    expect(",", "after the database");
    e.formulas = contents(e.database);
    expect(")", "to close the update");
    return e;
  }

  /// The formulas of a database entry: one, or for Kx the alternatives.
  std::vector<Formula> contents(syntax::Database database) {
    std::vector<Formula> result;
    result.push_back(literal());
    if (database == syntax::Database::Kx)
      while (accept("|") || accept("xor") || accept(",")) result.push_back(literal());
    return result;
  }

  /// init: add(Kf, ...) or the short forms K(...), Kw(...), Kv(...), Kx(a | b), LCW(...), or a bare
  /// literal.
  void initial() {
    while (!at_section()) {
      Effect e;
      e.place = place();
      if (is("add") && is("(", 1)) {
        e = update();
      } else if (is("(", 1) &&
                 (is("K") || is("Kf") || is("Kw") || is("Kv") || is("Kx") || is("LCW"))) {
        if (accept("K")) {
          e.database = syntax::Database::Kf;
        } else {
          e.database = *database();
        }
        expect("(", "after the database");
        e.formulas = contents(e.database);
        expect(")", "to close the entry");
      } else {
        e.formulas.push_back(literal());
      }
      document_.initial.push_back(std::move(e));
      while (accept(",") || accept(";") || accept("&")) {
      }
    }
  }

  const Source* source_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int depth_ = 0;
  syntax::Document document_;
};

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

syntax::Document parse_kpl(std::shared_ptr<const Source> source) {
  syntax::Document document = Parser(*source).document();
  document.sources.push_back(std::move(source));
  return document;
}

syntax::Formula kpl_piece::formula(const Source& source) {
  return Parser(source).piece([](Parser& p) { return p.formula(); });
}
std::vector<Effect> kpl_piece::effects(const Source& source) {
  return Parser(source).piece([](Parser& p) { return p.effects(); });
}
std::vector<Effect> kpl_piece::initial(const Source& source) {
  return Parser(source).piece([](Parser& p) {
    p.initial();
    return std::move(p.document_.initial);
  });
}
std::vector<TypedVariable> kpl_piece::parameters(const Source& source) {
  return Parser(source).piece(
      [](Parser& p) { return p.at_end() ? std::vector<TypedVariable>{} : p.parameters(); });
}
std::vector<syntax::Signature> kpl_piece::signatures(const Source& source) {
  return Parser(source).piece([](Parser& p) {
    std::vector<syntax::Signature> all;
    p.list([&] { all.push_back(p.signature(true)); });
    return all;
  });
}
std::vector<TypedVariable> kpl_piece::constants(const Source& source) {
  return Parser(source).piece([](Parser& p) {
    p.constants();
    return std::move(p.document_.constants);
  });
}

syntax::Document syntax::merge(Document domain, Document problem) {
  if (domain.assumes_complete && !problem.unknown.empty())
    problem.unknown[0].place.fail(
        "incomplete knowledge needs the requirement ':contingent' in the domain");
  if (domain.name.text.empty()) domain.name = problem.name;
  append(domain.types, problem.types);
  append(domain.constants, problem.constants);
  append(domain.predicates, problem.predicates);
  append(domain.functions, problem.functions);
  append(domain.externals, problem.externals);
  append(domain.tables, problem.tables);
  append(domain.actions, problem.actions);
  append(domain.initial, problem.initial);
  append(domain.goals, problem.goals);
  append(domain.closed, problem.closed);
  append(domain.unknown, problem.unknown);
  append(domain.sources, problem.sources);
  return domain;
}

}  // namespace kaboum::plan
