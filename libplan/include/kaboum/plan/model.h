#pragma once

#include <kaboum/plan/externals.h>
#include <kaboum/plan/handles.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The checked, lifted form of a domain and a problem: every name has become an index, nested terms
/// have been unfolded, nothing has been grounded. Loaders make it (load.h); the search and the
/// validator each read it on their own.
namespace kaboum::plan {

using Index = std::uint32_t;
inline constexpr Index kNone = ~Index{0};

struct Type {
  std::string name;
  Index parent = kNone;
  std::vector<Index> objects;       ///< of the type and its subtypes, ascending
  bool handle = false;              ///< further values come into being during a search
  std::vector<Index> members = {};  ///< of a union: its objects are those of these types
};

struct Object {
  std::string name;
  Index type = 0;
};

/// A predicate, a function, or an external function.
struct Symbol {
  std::string name;
  std::vector<Index> parameters;  ///< types
  Index range = kNone;            ///< type of the value; kNone: a truth value
  bool numeric = false;           ///< a function whose constant values are integers (costs)
  /// Level of a derived predicate; kNone: effects set it. Its rules read derived predicates
  /// of lower levels, and those of its own level that it depends on and that depend on it.
  Index level = kNone;
  bool recursive = false;  ///< derived, and depends on itself

  [[nodiscard]] bool derived() const { return level != kNone; }
};

struct FunctionTerm;

/// An object, the slot of a variable, or (of a handle type only) the value that a term has in the
/// state.
struct Argument {
  bool variable = false;
  Index index = 0;
  std::shared_ptr<const FunctionTerm> term = {};
};

struct FunctionTerm {
  Index function = 0;
  std::vector<Argument> arguments;  ///< objects and variables
};

/// A knowledge-level query with free variables.
struct Query {
  enum class Kind {
    True,
    False,
    And,
    Or,
    Xor,  ///< exactly one of the children holds
    Not,
    Exists,  ///< variable slot `symbol` over the objects of type `type`; one child
    ForAll,
    Known,         ///< K(p(arguments)), or K(!p(arguments)) when negated
    KnowWhether,   ///< Kw(p(arguments))
    KnownValue,    ///< K(f(arguments) = value), or != when negated
    WhetherValue,  ///< Kw(f(arguments) = value)
    KnowValue,     ///< Kv(f(arguments))
    Derived,       ///< p(arguments) holds by the rules, or does not when negated
    Same,          ///< arguments[0] and arguments[1] are the same object
    External,      ///< extern(g(arguments)), or extern(g(arguments)) = value if it has one
    Let            ///< extern(g(arguments)) has a value, and slot `value` stands for it from now on
  };
  Kind kind = Kind::True;
  Index symbol = 0;
  Index type = 0;
  bool negated = false;
  std::vector<Argument> arguments;
  std::optional<Argument> value;
  std::vector<Query> children;
};

/// One change of one database.
struct Update {
  enum class Database {
    Kf,
    Kw,
    Kv,
    Kx,
    Lcw,
    Or  ///< initial entries only: at least one of the literals holds
  };
  struct Literal {
    bool function = false;
    bool negated = false;
    Index symbol = 0;
    std::vector<Argument> arguments;
    std::optional<Argument> value;
  };
  bool add = true;
  bool maybe = false;  ///< of an addition to Kf: it may happen, and takes what it would make false
  Database database = Database::Kf;
  std::vector<Literal> literals;  ///< one; for Kx and Or the alternatives
};

struct Effect {
  enum class Kind { Update, When, ForAll };
  Kind kind = Kind::Update;
  Update update;
  Query condition;
  /// True of a condition of the world: K(p) stands for p, and it decides in each possible
  /// world what happens there, known or not. `denial` is then its negation.
  bool of_world = false;
  Query denial;
  Index slot = 0;
  Index type = 0;
  std::vector<Effect> children;
};

struct Action {
  std::string name;
  struct Parameter {
    std::string name;
    Index type = 0;
  };
  std::vector<Parameter> parameters;  ///< slots 0, 1, ...
  Index slots = 0;                    ///< parameters and quantified variables together
  Query precondition;
  std::vector<Effect> effects;
  std::int64_t cost = 1;
  Index cost_function = kNone;  ///< a numeric function of the parameters, added to nothing
  std::vector<Argument> cost_arguments;
};

/// A derived predicate holds of objects where, for these as slots 0, 1, ..., the body of one of its
/// rules does: the least set of atoms for which that is so, level by level.
struct Rule {
  Index predicate = 0;
  std::vector<Index> parameters;  ///< types: the rule is of objects of these
  Index slots = 0;                ///< parameters and quantified variables together
  Query body;
};

/// State as an external function may ask about it.
class StateReader {
 public:
  virtual ~StateReader() = default;
  virtual std::optional<Index> value(Index function, std::span<const Index> arguments) = 0;
  virtual std::optional<bool> truth(Index predicate, std::span<const Index> arguments) = 0;
};

/// Context that goes with the arguments of one call.
struct ExternalContext {
  StateReader& state;
  HandleTable& handles;
  std::uint64_t seed = 0;  ///< of the run
  unsigned attempt = 0;
  unsigned choice = 0;
  bool early = false;  ///< Question::early
};

struct ExternalResult {
  Answer::Kind kind = Answer::Kind::Impossible;
  Index value = 0;  ///< an object, or a handle; of a truth value 0
  std::string payload;
  std::string reason;
  bool chosen = false, fixed = false, listed = false;  ///< as in Answer
  unsigned choices = 0;
};

struct ExternalFunction {
  std::function<ExternalResult(std::span<const Index> arguments, ExternalContext& context)> call;
  bool reads_state = false;    ///< it may read more than its arguments
  bool takes_seed = false;     ///< it may read seed and attempt
  bool refuses_early = false;  ///< ExternalBinding::refuses_early
};

struct Model {
  std::string name;
  std::vector<Type> types;  ///< types[0] is the root of all
  std::vector<Object> objects;
  std::vector<Symbol> predicates;
  std::vector<Symbol> functions;
  std::vector<Symbol> externals;
  std::vector<ExternalFunction> external_functions;  ///< one per external
  std::vector<Action> actions;
  std::vector<Rule> rules;      ///< all is known where there are some
  std::vector<Update> initial;  ///< ground, in the order to apply; LCW entries last
  Query goal;
  Index goal_slots = 0;
  bool cut = false;  ///< more is known than `initial` says: nothing is unsolvable
  /// Values of numeric functions: by function, then arguments.
  std::vector<std::map<std::vector<Index>, std::int64_t>> numbers;

  [[nodiscard]] bool is_a(Index object, Index type) const;
  /// The name of an object, or the word of a handle.
  [[nodiscard]] std::string name_of(Index object, const HandleTable& handles) const {
    return object < objects.size() ? objects[object].name : std::string(handles.word(object));
  }
};

}  // namespace kaboum::plan
