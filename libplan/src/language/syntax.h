#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "language/source.h"

/// The syntax tree that every reader (kpl, PDDL) produces, the resolver checks, and the kpl
/// printer writes. Names are still text; nothing has been looked up.
namespace kaboum::plan::syntax {

struct Name {
  std::string text;
  SourceLocation location;
};

/// A variable (?x), a name (a constant or a nullary function), or f(t, ...).
struct Term {
  enum class Kind { Variable, Name, Call, Extern };
  Kind kind = Kind::Name;
  Name name;
  std::vector<Term> arguments;
};

struct TypedVariable {
  Name name;  ///< without the '?'
  Name type;  ///< empty text: any object
};

/// Queries and what stands inside them.
struct Formula {
  enum class Kind {
    True,
    False,
    And,
    Or,
    Xor,
    Not,
    Exists,
    ForAll,
    Known,        ///< K(child)
    KnowWhether,  ///< Kw(child)
    KnowValue,    ///< Kv(terms[0])
    ClosedWorld,  ///< LCW(atom): whether every instance is known-whether
    Atom,         ///< terms[0]; only inside K, Kw, LCW, add and del
    Equal,        ///< terms[0] = terms[1]
    NotEqual,     ///< terms[0] != terms[1]
    Extern,       ///< terms[0] of kind Extern, as a condition
    Let           ///< variables[0] names the value of terms[0], of kind Extern
  };
  Kind kind = Kind::True;
  SourceLocation location;
  std::vector<Formula> children;
  std::vector<Term> terms;
  std::vector<TypedVariable> variables;
};

enum class Database { Kf, Kw, Kv, Kx, Lcw, Or };

struct Effect {
  enum class Kind { Add, Maybe, Delete, When, ForAll };
  Kind kind = Kind::Add;
  SourceLocation location;
  Database database = Database::Kf;
  std::vector<Formula> formulas;  ///< one; for Kx and Or the alternatives; for When the condition
  bool of_world = false;          ///< of When: the condition is one of the world, known or not
  std::vector<TypedVariable> variables;
  std::vector<Effect> children;
};

struct Action {
  Name name;
  std::vector<TypedVariable> parameters;
  Formula precondition;
  std::vector<Effect> effects;
  std::vector<Term> cost;  ///< empty: 1; else one term, a number or a function of number
};

/// Of a derived predicate: it holds of the parameters where the body does.
struct Rule {
  Name head;
  std::vector<TypedVariable> parameters;
  Formula body;
};

struct Type {
  Name name;
  Name parent;  ///< empty text: a root
  bool handle = false;
  std::vector<Name> members = {};  ///< of a union: it has the objects of these
};

/// A predicate, a function or an external function.
struct Signature {
  Name name;
  std::vector<Name> parameters;  ///< type names, empty text: any object
  Name range;                    ///< functions: type of the value; empty text: any object
};

/// One row of the table that binds an external function in a file: arguments, and the value.
struct Row {
  std::vector<Name> arguments;
  Name value;  ///< empty text: true
  SourceLocation location;
};
struct Table {
  Name external;
  std::vector<Row> rows;
};

struct Document {
  Name name;
  std::vector<Type> types;
  std::vector<TypedVariable> constants;
  std::vector<Signature> predicates;
  std::vector<Signature> functions;
  std::vector<Signature> externals;
  std::vector<Table> tables;
  std::vector<Action> actions;
  std::vector<Rule> rules;
  std::vector<Effect> initial;
  std::vector<Formula> goals;    ///< conjunction
  std::vector<Name> closed;      ///< predicates closed in the initial state ("all": every one)
  bool closed_world = false;     ///< every predicate is closed, also where one is named "all"
  std::vector<Formula> unknown;  ///< atoms that closing leaves open
  /// Of a PDDL domain: its conditional effects assume that everything is known.
  bool assumes_complete = false;
  std::vector<std::shared_ptr<const Source>> sources;  ///< keep the locations alive
};

/// Whether all predicates are closed. A predicate that is named "all" is closed alone by that name.
inline bool closes_world(const Document& d) {
  const auto is_all = [](const Name& n) { return n.text == "all"; };
  return d.closed_world || (std::any_of(d.closed.begin(), d.closed.end(), is_all) &&
                            std::none_of(d.predicates.begin(), d.predicates.end(),
                                         [&](const Signature& s) { return is_all(s.name); }));
}

/// `problem` appended to `domain`: constants, initial knowledge, goal, tables, and any declaration.
Document merge(Document domain, Document problem);

}  // namespace kaboum::plan::syntax
