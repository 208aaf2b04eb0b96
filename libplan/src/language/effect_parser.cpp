// Grammar of effects, conditional and quantified ones, and of the entries of an initial state.
#include "language/effect_parser.h"

namespace kaboum::plan {

using syntax::Effect;
using syntax::Formula;

std::vector<Effect> EffectParser::effects() {
  std::vector<Effect> result;
  while (!in_.at_section() && !in_.is(")")) {
    result.push_back(effect());
    in_.skip_separators();
  }
  return result;
}

Effect EffectParser::effect() {
  const TokenStream::Level level(in_);
  Effect e;
  e.location = in_.location();
  if ((in_.is("add") || in_.is("del") || in_.is("maybe")) && in_.is("(", 1)) return update();
  if ((in_.is("forall") || in_.is("forallK")) && in_.is("(", 1)) {
    in_.skip(2);
    e.kind = Effect::Kind::ForAll;
    e.variables = formulas_.parameters();
    in_.expect(")", "after the variables of forall");
    e.children = body();
    return e;
  }
  e.kind = Effect::Kind::When;
  e.of_world = in_.accept("whenever");
  e.formulas.push_back(formulas_.formula());
  in_.expect("=>", "between an effect's condition and its updates");
  e.children = body();
  return e;
}

/// One effect, several joined by '&', or several in parentheses.
std::vector<Effect> EffectParser::body() {
  std::vector<Effect> result;
  if (in_.accept("{")) {
    while (!in_.is("}") && !in_.at_section()) {
      result.push_back(effect());
      in_.skip_separators();
    }
    in_.expect("}", "to close the group of effects");
    return result;
  }
  if (in_.is("(") && in_.parenthesis_holds_effect()) {
    in_.skip();
    result = effects();
    in_.expect(")", "to close the group of effects");
    return result;
  }
  do result.push_back(effect());
  while (in_.is("&") && (in_.is("add", 1) || in_.is("del", 1) || in_.is("maybe", 1)) &&
         in_.accept("&"));
  return result;
}

std::optional<syntax::Database> EffectParser::database() {
  if (in_.accept("Kf")) return syntax::Database::Kf;
  if (in_.accept("Kw")) return syntax::Database::Kw;
  if (in_.accept("Kv")) return syntax::Database::Kv;
  if (in_.accept("Kx")) return syntax::Database::Kx;
  if (in_.accept("LCW")) return syntax::Database::Lcw;
  if (in_.accept("Or")) return syntax::Database::Or;
  return std::nullopt;
}

Effect EffectParser::update() {
  Effect e;
  e.location = in_.location();
  e.kind = in_.is("add")   ? Effect::Kind::Add
           : in_.is("del") ? Effect::Kind::Delete
                           : Effect::Kind::Maybe;
  in_.skip();
  in_.expect("(", "after add, del or maybe");
  if (const auto d = database()) {
    e.database = *d;
  } else {
    in_.location().fail("expected a database (Kf, Kw, Kv, Kx or LCW), found " + in_.found());
  }
  if (e.kind == Effect::Kind::Maybe && e.database != syntax::Database::Kf)
    e.location.fail("maybe(...) is about the world: its database is Kf");
  in_.expect(",", "after the database");
  if (e.database == syntax::Database::Or)
    e.location.fail("Or(...) is an initial entry; it is no database");
  e.formulas = contents(e.database);
  in_.expect(")", "to close the update");
  return e;
}

/// The formulas of a database entry: one, or for Kx the alternatives.
std::vector<Formula> EffectParser::contents(syntax::Database database) {
  std::vector<Formula> result;
  result.push_back(formulas_.literal());
  if (database == syntax::Database::Kx || database == syntax::Database::Or)
    while (in_.accept("|") || in_.accept("xor") || in_.accept(","))
      result.push_back(formulas_.literal());
  return result;
}

std::vector<Effect> EffectParser::initial() {
  std::vector<Effect> result;
  while (!in_.at_section()) {
    Effect e;
    e.location = in_.location();
    if (in_.is("add") && in_.is("(", 1)) {
      e = update();
    } else if (in_.is("(", 1) && (in_.is("K") || in_.is("Kf") || in_.is("Kw") || in_.is("Kv") ||
                                  in_.is("Kx") || in_.is("LCW") || in_.is("Or"))) {
      if (in_.accept("K")) {
        e.database = syntax::Database::Kf;
      } else {
        e.database = *database();
      }
      in_.expect("(", "after the database");
      e.formulas = contents(e.database);
      in_.expect(")", "to close the entry");
    } else {
      e.formulas.push_back(formulas_.literal());
    }
    result.push_back(std::move(e));
    in_.skip_separators();
  }
  return result;
}

}  // namespace kaboum::plan
