// Grammar of a .kpl document: its sections, symbols, tables and actions.
#include "language/kpl_parser.h"

#include "language/effect_parser.h"
#include "language/formula_parser.h"
#include "language/token_stream.h"

namespace kaboum::plan {
namespace {

using syntax::Effect;
using syntax::Formula;
using syntax::Name;
using syntax::TypedVariable;

class DocumentParser {
 public:
  explicit DocumentParser(TokenStream& in) : in_(in) {}

  syntax::Document document() {
    while (!in_.at_end()) section();
    return std::move(document_);
  }

  std::vector<TypedVariable> constants() {
    std::vector<TypedVariable> result;
    Name type;
    list([&] {
      const Name first = in_.name("a constant");
      if (in_.peek().kind == Token::Kind::Name && !in_.at_section()) {
        type = first;
        result.push_back({in_.name("a constant"), type});
      } else {
        result.push_back({first, type});
      }
    });
    return result;
  }

  std::vector<syntax::Signature> signatures() {
    std::vector<syntax::Signature> all;
    list([&] { all.push_back(signature(true)); });
    return all;
  }

 private:
  void section() {
    const SourceLocation at = in_.location();
    if (in_.accept("symbols")) {
      in_.accept(":");
    } else if (in_.is("domain") || in_.is("problem")) {
      const bool domain = in_.accept("domain");
      if (!domain) in_.skip();
      const Name n = in_.name("a name");
      if (domain || document_.name.text.empty()) document_.name = n;
    } else if (in_.is("action")) {
      action();
    } else if (in_.is("table")) {
      table();
    } else if (in_.heading("types")) {
      list([&] { types(); });
    } else if (in_.heading("constants") || in_.heading("objects")) {
      for (TypedVariable& c : constants()) document_.constants.push_back(std::move(c));
    } else if (in_.heading("predicates")) {
      list([&] { document_.predicates.push_back(signature(false)); });
    } else if (in_.heading("functions")) {
      list([&] { document_.functions.push_back(signature(true)); });
    } else if (in_.heading("externals")) {
      list([&] { document_.externals.push_back(external()); });
    } else if (in_.heading("closed")) {
      list([&] { document_.closed.push_back(in_.name("a predicate")); });
    } else if (in_.heading("unknown")) {
      list([&] { document_.unknown.push_back(formulas_.literal()); });
    } else if (in_.heading("init")) {
      for (Effect& e : effects_.initial()) document_.initial.push_back(std::move(e));
    } else if (in_.heading("goal")) {
      document_.goals.push_back(formulas_.formula());
      if (!in_.at_section())
        in_.location().fail("expected the end of the goal, found " + in_.found());
    } else {
      at.fail(
          "expected a section such as 'types:', 'predicates:', 'action', 'init:' or 'goal:', "
          "found " +
          in_.found());
    }
    while (in_.accept(";")) {
    }
  }

  /// Items up to the next section; ',' and ';' between them are optional.
  template <class Item>
  void list(Item item) {
    while (!in_.at_section()) {
      item();
      while (in_.accept(",") || in_.accept(";")) {
      }
    }
  }

  void types() {
    syntax::Type type{in_.name("a type"), {}};
    if (in_.accept(":")) type.parent = in_.name("the type's parent");
    if (in_.accept("handle")) {
      if (!type.parent.text.empty()) type.name.location.fail("a handle type has no parent");
      type.handle = true;
    }
    if (in_.accept("=")) {
      if (!type.parent.text.empty() || type.handle)
        type.name.location.fail("a union of types has no parent and is no handle type");
      do type.members.push_back(in_.name("a type"));
      while (in_.accept("|"));
    }
    document_.types.push_back(type);
  }

  syntax::Signature signature(bool with_range) {
    syntax::Signature s;
    s.name = in_.name("a name");
    if (in_.accept("/")) {
      if (in_.peek().kind != Token::Kind::Number)
        in_.location().fail("expected the number of arguments");
      if (in_.peek().text.size() > 2) in_.location().fail("too many arguments");
      s.parameters.resize(static_cast<std::size_t>(std::stoi(in_.peek().text)));
      in_.skip();
    } else if (in_.accept("(")) {
      while (!in_.is(")")) {
        if (in_.peek().kind == Token::Kind::Variable) {
          in_.skip();
          if (in_.accept(":")) {
            s.parameters.push_back(in_.name("a type"));
          } else {
            s.parameters.push_back({});
          }
        } else {
          s.parameters.push_back(in_.name("a type"));
        }
        if (!in_.accept(",")) break;
      }
      in_.expect(")", "after the types of the arguments");
    }
    if (with_range && in_.accept(":")) s.range = in_.name("the type of the value");
    return s;
  }

  syntax::Signature external() {
    syntax::Signature s = signature(true);
    if (in_.is("volatile"))
      in_.location().fail(
          "'volatile' functions depend on calls made before, and the search makes calls in an "
          "order "
          "of its own: let '" +
          s.name.text +
          "' depend on its arguments and the state alone (docs/planning/language.md)");
    return s;
  }

  void table() {
    in_.skip();
    syntax::Table t;
    t.external = in_.name("an external function");
    in_.expect(":", "after the name of the external function");
    list([&] {
      syntax::Row row;
      row.location = in_.location();
      in_.expect("(", "before the arguments of a row");
      while (!in_.is(")")) {
        row.arguments.push_back(in_.name("a constant"));
        if (!in_.accept(",")) break;
      }
      in_.expect(")", "after the arguments of a row");
      if (in_.accept("=")) row.value = in_.name("a value");
      t.rows.push_back(std::move(row));
    });
    document_.tables.push_back(std::move(t));
  }

  void action() {
    in_.skip();
    syntax::Action a;
    a.name = in_.name("the action's name");
    if (in_.accept("(")) {
      if (!in_.is(")")) a.parameters = formulas_.parameters();
      in_.expect(")", "after the action's parameters");
    }
    a.precondition.kind = Formula::Kind::True;
    a.precondition.location = in_.location();
    bool preconds = false;
    bool effects_seen = false;
    while (true) {
      const SourceLocation at = in_.location();
      if (in_.heading("preconds")) {
        if (preconds) at.fail("a second 'preconds:' in one action");
        preconds = true;
        a.precondition = formulas_.formula();
      } else if (in_.heading("effects")) {
        if (effects_seen) at.fail("a second 'effects:' in one action");
        effects_seen = true;
        a.effects = effects_.effects();
      } else if (in_.heading("cost")) {
        if (!a.cost.empty()) at.fail("a second 'cost:' in one action");
        a.cost.push_back(formulas_.cost());
      } else if (!in_.accept(";")) {
        break;
      }
    }
    if (!in_.at_section())
      in_.location().fail("expected 'preconds:', 'effects:' or the next section, found " +
                          in_.found() +
                          (in_.is("and") || in_.is("or") ? " ('&' means and, '|' means or)" : ""));
    document_.actions.push_back(std::move(a));
  }

  TokenStream& in_;
  FormulaParser formulas_{in_};
  EffectParser effects_{in_, formulas_};
  syntax::Document document_;
};

}  // namespace

syntax::Document parse_kpl(std::shared_ptr<const Source> source) {
  TokenStream in(*source);
  syntax::Document document = DocumentParser(in).document();
  document.sources.push_back(std::move(source));
  return document;
}

}  // namespace kaboum::plan
