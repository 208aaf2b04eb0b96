#include "language/resolve.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <unordered_map>

namespace kaboum::plan {

bool Model::is_a(Index object, Index type) const {
  const auto& all = types[type].objects;
  return std::binary_search(all.begin(), all.end(), object);
}

namespace {

namespace sx = syntax;
using sx::Name;

constexpr std::size_t kMaximumArity = 12;
constexpr std::size_t kMaximumSlots = 64;
constexpr std::size_t kMaximumTypes = 10'000;
constexpr std::size_t kMaximumInitial = 5'000'000;

using Table = std::unordered_map<std::string, Index>;

/// Variables in scope: name, slot, type.
struct Scope {
  struct Variable {
    std::string name;
    Index slot;
    Index type;
  };
  std::vector<Variable> variables;
  Index slots = 0;
  Place place;  ///< of the action or goal, for messages

  Index fresh() {
    if (slots >= kMaximumSlots) place.fail("too many variables");
    return slots++;
  }
  [[nodiscard]] const Variable* find(const std::string& name) const {
    for (auto v = variables.rbegin(); v != variables.rend(); ++v)
      if (v->name == name) return &*v;
    return nullptr;
  }
};

/// An argument that is itself a term: slot `slot` stands for its value, `condition` says so.
struct Unfolded {
  Index slot;
  Index type;
  Query condition;
};

Query wrap(std::vector<Unfolded> unfolded, Query inner) {
  for (auto u = unfolded.rbegin(); u != unfolded.rend(); ++u) {
    Query both;
    both.kind = Query::Kind::And;
    both.children = {std::move(u->condition), std::move(inner)};
    Query exists;
    exists.kind = Query::Kind::Exists;
    exists.symbol = u->slot;
    exists.type = u->type;
    exists.children.push_back(std::move(both));
    inner = std::move(exists);
  }
  return inner;
}

Query negation(Query q) {
  Query n;
  n.kind = Query::Kind::Not;
  n.children.push_back(std::move(q));
  return n;
}

Effect when(Query condition, const Effect& happens) {
  Effect e;
  e.kind = Effect::Kind::When;
  e.condition = std::move(condition);
  e.children.push_back(happens);
  return e;
}

/// What an update does if it only may happen: additions become possible ones, and what says nothing
/// of the world (sensing, observations) is left out.
std::optional<Effect> possibly(Effect e) {
  if (e.kind == Effect::Kind::Update) {
    if (e.update.add && e.update.database != Update::Database::Kf) return std::nullopt;
    e.update.maybe = e.update.add;
    return e;
  }
  std::vector<Effect> children;
  for (Effect& c : e.children)
    if (auto p = possibly(std::move(c))) children.push_back(std::move(*p));
  if (children.empty()) return std::nullopt;
  e.children = std::move(children);
  return e;
}

/// `inner` for the value that each unfolded term has. Where a term's value is not known, `inner`
/// may happen for any value that it may have, and takes the knowledge that would be wrong then.
Effect wrap(std::vector<Unfolded> unfolded, Effect inner) {
  std::optional<Effect> maybe = possibly(inner);
  for (auto u = unfolded.rbegin(); u != unfolded.rend(); ++u) {
    const auto all = [&](std::vector<Effect> children) {
      Effect e;
      e.kind = Effect::Kind::ForAll;
      e.slot = u->slot;
      e.type = u->type;
      e.children = std::move(children);
      return e;
    };
    std::vector<Effect> certain = {when(u->condition, inner)};
    if (u->condition.kind != Query::Kind::KnownValue) {  // an external value is there, or is none
      if (maybe) maybe = all({when(u->condition, *maybe)});
    } else if (maybe) {
      Query whether = u->condition;
      whether.kind = Query::Kind::WhetherValue;
      certain.push_back(when(negation(std::move(whether)), *maybe));
      Query differs = u->condition;
      differs.negated = true;
      maybe = all({when(negation(std::move(differs)), *maybe)});
    }
    inner = all(std::move(certain));
  }
  return inner;
}

std::string plural(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

class Resolver {
 public:
  Resolver(const sx::Document& document, const ExternalBindings& bindings)
      : document_(document), bindings_(bindings) {}

  Model run() {
    model_.name = document_.name.text;
    declare_types();
    declare_constants();
    declare_symbols();
    bind_externals();
    for (const sx::Action& a : document_.actions) declare_action(a);
    declare_initial();
    declare_goal();
    return std::move(model_);
  }

 private:
  // ---- declarations ------------------------------------------------------------------------
  void unique(Table& table, const Name& name, Index index, const char* what) const {
    if (!table.emplace(name.text, index).second)
      name.place.fail(std::string(what) + " '" + name.text + "' is declared twice");
  }

  /// The root of the types is "object", unless the text declares that as one type among others, as
  /// the thesis does ("types: object, robot"): then the root has no name.
  void declare_types() {
    const auto is_object = [](const sx::Type& t) { return t.name.text == "object"; };
    const bool object_is_a_type =
        std::any_of(document_.types.begin(), document_.types.end(), is_object) &&
        std::none_of(document_.types.begin(), document_.types.end(),
                     [](const sx::Type& t) { return t.parent.text == "object"; });
    model_.types.push_back({object_is_a_type ? "any type" : "object", kNone, {}});
    types_.emplace(model_.types[0].name, 0);
    for (const sx::Type& t : document_.types) {
      if (t.name.text == "number" || (t.name.text == "object" && !object_is_a_type)) {
        if (!t.parent.text.empty())
          t.name.place.fail("type '" + t.name.text + "' cannot have a parent");
        continue;
      }
      if (model_.types.size() >= kMaximumTypes) t.name.place.fail("too many types");
      unique(types_, t.name, static_cast<Index>(model_.types.size()), "type");
      model_.types.push_back({t.name.text, 0, {}});
    }
    for (const sx::Type& t : document_.types)
      if (!t.parent.text.empty()) model_.types[types_.at(t.name.text)].parent = type(t.parent);
    for (const sx::Type& t : document_.types) {
      const auto found = types_.find(t.name.text);
      Index up = found == types_.end() ? kNone : found->second;
      for (std::size_t steps = 0; up != kNone; up = model_.types[up].parent)
        if (++steps > model_.types.size())
          t.name.place.fail("type '" + t.name.text + "' is its own ancestor");
    }
  }

  [[nodiscard]] Index type(const Name& name) const {
    if (name.text.empty()) return 0;
    const auto found = types_.find(name.text);
    if (found == types_.end()) name.place.fail("unknown type '" + name.text + "'");
    return found->second;
  }

  void declare_constants() {
    for (const sx::TypedVariable& c : document_.constants) {
      const auto index = static_cast<Index>(model_.objects.size());
      unique(objects_, c.name, index, "constant");
      const Index t = type(c.type);
      model_.objects.push_back({c.name.text, t});
      for (Index up = t; up != kNone; up = model_.types[up].parent)
        model_.types[up].objects.push_back(index);
    }
  }

  Symbol symbol(const sx::Signature& s) const {
    if (s.parameters.size() > kMaximumArity) s.name.place.fail("more than 12 arguments");
    Symbol result;
    result.name = s.name.text;
    for (const Name& p : s.parameters) result.parameters.push_back(type(p));
    return result;
  }

  void declare_symbols() {
    for (const sx::Signature& s : document_.predicates) {
      unique(predicates_, s.name, static_cast<Index>(model_.predicates.size()), "predicate");
      model_.predicates.push_back(symbol(s));
    }
    for (const sx::Signature& s : document_.functions) {
      unique(functions_, s.name, static_cast<Index>(model_.functions.size()), "function");
      if (predicates_.contains(s.name.text))
        s.name.place.fail("'" + s.name.text + "' is a predicate already");
      Symbol f = symbol(s);
      f.numeric = s.range.text == "number";
      f.range = f.numeric ? kNone : type(s.range);
      model_.functions.push_back(f);
    }
    for (const sx::Signature& s : document_.externals) {
      unique(externals_, s.name, static_cast<Index>(model_.externals.size()), "external function");
      Symbol g = symbol(s);
      g.is_volatile = s.is_volatile;
      if (!s.range.text.empty()) g.range = type(s.range);
      model_.externals.push_back(g);
    }
    model_.numbers.resize(model_.functions.size());
  }

  [[nodiscard]] Index object(const Name& name, Index type_wanted) const {
    const auto found = objects_.find(name.text);
    if (found == objects_.end()) name.place.fail("unknown constant '" + name.text + "'");
    if (!model_.is_a(found->second, type_wanted))
      name.place.fail("'" + name.text + "' is of type " +
                      type_name(model_.objects[found->second].type) + ", expected " +
                      type_name(type_wanted));
    return found->second;
  }
  [[nodiscard]] const std::string& type_name(Index t) const { return model_.types[t].name; }

  void bind_externals() {
    std::vector<std::map<std::vector<Index>, Index>> rows(model_.externals.size());
    std::vector<bool> bound(model_.externals.size(), false);
    for (const sx::Table& t : document_.tables) {
      const auto found = externals_.find(t.external.text);
      if (found == externals_.end())
        t.external.place.fail("unknown external function '" + t.external.text + "'");
      const Symbol& g = model_.externals[found->second];
      bound[found->second] = true;
      for (const sx::Row& row : t.rows) {
        if (row.arguments.size() != g.parameters.size())
          row.place.fail("'" + g.name + "' takes " + plural(g.parameters.size(), "argument") +
                         ", not " + std::to_string(row.arguments.size()));
        std::vector<Index> key;
        for (std::size_t i = 0; i < row.arguments.size(); ++i)
          key.push_back(object(row.arguments[i], g.parameters[i]));
        if (row.value.text.empty() != (g.range == kNone))
          row.place.fail(g.range == kNone ? "'" + g.name + "' is a truth value: a row has no '='"
                                          : "expected '=' and the value of '" + g.name + "'");
        const Index value = g.range == kNone ? 0 : object(row.value, g.range);
        if (!rows[found->second].emplace(std::move(key), value).second)
          row.place.fail("a second row for the same arguments");
      }
    }
    for (std::size_t i = 0; i < model_.externals.size(); ++i) {
      const Symbol& g = model_.externals[i];
      const Place& place = document_.externals[i].name.place;
      const auto host = bindings_.find(g.name);
      if (host != bindings_.end()) {
        model_.external_functions.push_back(host_function(host->second, g));
      } else if (bound[i]) {
        model_.external_functions.push_back(
            [table = std::move(rows[i])](std::span<const Index> arguments) -> std::optional<Index> {
              const auto row = table.find({arguments.begin(), arguments.end()});
              if (row == table.end()) return std::nullopt;
              return row->second;
            });
      } else {
        place.fail("external function '" + g.name + "' is bound to nothing: give a 'table " +
                   g.name + ":' or bind it in the host program");
      }
    }
  }

  [[nodiscard]] ExternalFunction host_function(
      const std::function<std::string(std::span<const std::string>)>& function,
      const Symbol& g) const {
    std::vector<std::string> names;
    for (const Object& o : model_.objects) names.push_back(o.name);
    return [=, table = objects_, range = g.range, name = g.name, root = range_objects(g.range)](
               std::span<const Index> arguments) -> std::optional<Index> {
      std::vector<std::string> texts;
      for (const Index a : arguments) texts.push_back(names[a]);
      const std::string value = function(texts);
      if (value.empty()) return std::nullopt;
      if (range == kNone) return 0;
      const auto found = table.find(value);
      if (found == table.end() || !std::binary_search(root.begin(), root.end(), found->second))
        throw Error(ErrorCode::InvalidInput, "external function '" + name + "' returned '" + value +
                                                 "', no constant of its type");
      return found->second;
    };
  }
  [[nodiscard]] std::vector<Index> range_objects(Index range) const {
    return range == kNone ? std::vector<Index>{} : model_.types[range].objects;
  }

  // ---- terms -------------------------------------------------------------------------------
  [[nodiscard]] const Index* function_of(const sx::Term& t) const {
    if (t.kind != sx::Term::Kind::Call && t.kind != sx::Term::Kind::Name) return nullptr;
    if (t.kind == sx::Term::Kind::Name && objects_.contains(t.name.text)) return nullptr;
    const auto found = functions_.find(t.name.text);
    return found == functions_.end() ? nullptr : &found->second;
  }
  [[nodiscard]] const Index* predicate_of(const sx::Term& t) const {
    if (t.kind != sx::Term::Kind::Call && t.kind != sx::Term::Kind::Name) return nullptr;
    const auto found = predicates_.find(t.name.text);
    return found == predicates_.end() ? nullptr : &found->second;
  }

  void check_type(const Name& name, Index found, Index wanted) const {
    for (Index up = found; up != kNone; up = model_.types[up].parent)
      if (up == wanted) return;
    name.place.fail("'" + name.text + "' is of type " + type_name(found) + ", expected " +
                    type_name(wanted));
  }
  [[nodiscard]] bool related(Index a, Index b) const {
    for (Index up = a; up != kNone; up = model_.types[up].parent)
      if (up == b) return true;
    for (Index up = b; up != kNone; up = model_.types[up].parent)
      if (up == a) return true;
    return false;
  }

  /// A variable, a constant, or (unfolded) a function term in an argument place.
  Argument argument(const sx::Term& t, Index wanted, Scope& scope, std::vector<Unfolded>& unfolded,
                    bool strict = true) {
    if (t.kind == sx::Term::Kind::Variable) {
      const Scope::Variable* v = scope.find(t.name.text);
      if (v == nullptr) t.name.place.fail("unknown variable '?" + t.name.text + "'");
      if (strict) {
        check_type(t.name, v->type, wanted);
      } else if (!related(v->type, wanted)) {
        check_type(t.name, v->type, wanted);
      }
      return {true, v->slot};
    }
    if (t.kind == sx::Term::Kind::Name && !function_of(t)) {
      if (predicate_of(t) && !objects_.contains(t.name.text))
        t.name.place.fail("'" + t.name.text + "' is a predicate, not a value");
      return {false, object(t.name, wanted)};
    }
    Query condition;
    Index range = kNone;
    std::vector<Unfolded> inner;
    if (t.kind == sx::Term::Kind::Extern) {
      const Index g = external(t);
      range = model_.externals[g].range;
      if (range == kNone)
        t.name.place.fail("'" + t.name.text + "' is a truth value, not an object");
      condition.kind = Query::Kind::External;
      condition.symbol = g;
      condition.arguments = arguments(t, model_.externals[g], scope, inner);
    } else {
      const Index* f = function_of(t);
      if (f == nullptr) t.name.place.fail("unknown function '" + t.name.text + "'");
      range = model_.functions[*f].range;
      if (model_.functions[*f].numeric)
        t.name.place.fail("'" + t.name.text + "' is a number, not an object");
      condition.kind = Query::Kind::KnownValue;
      condition.symbol = *f;
      condition.arguments = arguments(t, model_.functions[*f], scope, inner);
    }
    if (!related(range, wanted)) check_type(t.name, range, wanted);
    const Index slot = scope.fresh();
    condition.value = Argument{true, slot};
    for (Unfolded& u : inner) unfolded.push_back(std::move(u));
    unfolded.push_back({slot, is_subtype(wanted, range) ? wanted : range, std::move(condition)});
    return {true, slot};
  }
  [[nodiscard]] bool is_subtype(Index a, Index b) const {
    for (Index up = a; up != kNone; up = model_.types[up].parent)
      if (up == b) return true;
    return false;
  }

  [[nodiscard]] Index external(const sx::Term& t) const {
    const auto found = externals_.find(t.name.text);
    if (found == externals_.end())
      t.name.place.fail("unknown external function '" + t.name.text + "'");
    return found->second;
  }

  std::vector<Argument> arguments(const sx::Term& t, const Symbol& s, Scope& scope,
                                  std::vector<Unfolded>& unfolded) {
    if (t.arguments.size() != s.parameters.size())
      t.name.place.fail("'" + s.name + "' takes " + plural(s.parameters.size(), "argument") +
                        ", not " + std::to_string(t.arguments.size()));
    std::vector<Argument> result;
    for (std::size_t i = 0; i < t.arguments.size(); ++i)
      result.push_back(argument(t.arguments[i], s.parameters[i], scope, unfolded));
    return result;
  }

  // ---- queries -----------------------------------------------------------------------------
  Query query(const sx::Formula& f, Scope& scope) {
    using K = sx::Formula::Kind;
    Query q;
    switch (f.kind) {
      case K::True:
        return q;
      case K::False:
        q.kind = Query::Kind::False;
        return q;
      case K::And:
      case K::Or:
      case K::Xor:
      case K::Not:
        q.kind = f.kind == K::And   ? Query::Kind::And
                 : f.kind == K::Or  ? Query::Kind::Or
                 : f.kind == K::Xor ? Query::Kind::Xor
                                    : Query::Kind::Not;
        for (const sx::Formula& child : f.children) q.children.push_back(query(child, scope));
        return q;
      case K::Exists:
      case K::ForAll:
        return quantified(f, f.kind == K::Exists ? Query::Kind::Exists : Query::Kind::ForAll,
                          scope);
      case K::Known:
        return known(f.children.at(0), false, scope);
      case K::KnowWhether:
        return know_whether(f.children.at(0), scope);
      case K::KnowValue:
        return know_value(f, scope);
      case K::ClosedWorld:
        return closed_world(f, scope);
      case K::Extern:
        return external_condition(f.terms.at(0), scope);
      case K::Equal:
      case K::NotEqual:
        return equality(f, f.kind == K::NotEqual, scope);
      case K::Atom:
        f.place.fail("a query needs its operator: K(...), Kw(...) or Kv(...)");
    }
    f.place.fail("unexpected formula");
  }

  Query quantified(const sx::Formula& f, Query::Kind kind, Scope& scope) {
    const std::size_t outer = scope.variables.size();
    std::vector<std::pair<Index, Index>> slots;
    for (const sx::TypedVariable& v : f.variables) {
      const Index slot = scope.fresh();
      slots.emplace_back(slot, type(v.type));
      scope.variables.push_back({v.name.text, slot, slots.back().second});
    }
    Query inner = query(f.children.at(0), scope);
    scope.variables.resize(outer);
    for (auto s = slots.rbegin(); s != slots.rend(); ++s) {
      Query q;
      q.kind = kind;
      q.symbol = s->first;
      q.type = s->second;
      q.children.push_back(std::move(inner));
      inner = std::move(q);
    }
    return inner;
  }

  /// K(f), or K(!f) when negated.
  Query known(const sx::Formula& f, bool negated, Scope& scope) {
    using K = sx::Formula::Kind;
    switch (f.kind) {
      case K::Not:
        return known(f.children.at(0), !negated, scope);
      case K::Equal:
      case K::NotEqual:
        return equality(f, (f.kind == K::NotEqual) != negated, scope);
      case K::Extern: {
        Query q = external_condition(f.terms.at(0), scope);
        return negated ? negation(std::move(q)) : q;
      }
      case K::Atom: {
        std::vector<Unfolded> unfolded;
        Query q = atom(f.terms.at(0), scope, unfolded);
        q.negated = negated;
        return wrap(std::move(unfolded), std::move(q));
      }
      default:
        f.place.fail("K(...) holds an atom, an equality, an extern(...), or the negation of one");
    }
  }

  Query atom(const sx::Term& t, Scope& scope, std::vector<Unfolded>& unfolded) {
    const Index* p = predicate_of(t);
    if (p == nullptr)
      t.name.place.fail(function_of(t) ? "'" + t.name.text + "' is a function: compare it with '='"
                                       : "unknown predicate '" + t.name.text + "'");
    Query q;
    q.kind = Query::Kind::Known;
    q.symbol = *p;
    q.arguments = arguments(t, model_.predicates[*p], scope, unfolded);
    return q;
  }

  Query external_condition(const sx::Term& t, Scope& scope) {
    const Index g = external(t);
    if (model_.externals[g].range != kNone)
      t.name.place.fail("'" + t.name.text + "' has a value: compare it with '='");
    std::vector<Unfolded> unfolded;
    Query q;
    q.kind = Query::Kind::External;
    q.symbol = g;
    q.arguments = arguments(t, model_.externals[g], scope, unfolded);
    return wrap(std::move(unfolded), std::move(q));
  }

  [[nodiscard]] bool is_plain(const sx::Term& t) const {
    return t.kind == sx::Term::Kind::Variable ||
           (t.kind == sx::Term::Kind::Name && !function_of(t));
  }

  /// K(a = b) and K(a != b) in all their forms; the known side is looked up before an extern is
  /// called.
  Query equality(const sx::Formula& f, bool negated, Scope& scope) {
    const sx::Term* left = &f.terms.at(0);
    const sx::Term* right = &f.terms.at(1);
    // K(phi = extern(g(x))) with a predicate phi.
    if (right->kind != sx::Term::Kind::Extern && left->kind == sx::Term::Kind::Extern)
      std::swap(left, right);
    if (right->kind == sx::Term::Kind::Extern && predicate_of(*left) && !function_of(*left)) {
      std::vector<Unfolded> unfolded;
      Query p = atom(*left, scope, unfolded);
      Query g = external_condition(*right, scope);
      Query both, neither, either;
      both.kind = neither.kind = Query::Kind::And;
      either.kind = Query::Kind::Or;
      p.negated = negated;
      both.children = {g, p};
      p.negated = !negated;
      neither.children = {negation(std::move(g)), std::move(p)};
      either.children = {std::move(both), std::move(neither)};
      return wrap(std::move(unfolded), std::move(either));
    }
    if (right->kind != sx::Term::Kind::Extern && !is_plain(*right) && is_plain(*left))
      std::swap(left, right);
    std::vector<Unfolded> unfolded;
    Query q;
    if (is_plain(*left) && is_plain(*right)) {
      q.kind = Query::Kind::Same;
      q.arguments = {argument(*left, 0, scope, unfolded), argument(*right, 0, scope, unfolded)};
      return negated ? negation(std::move(q)) : q;
    }
    if (left->kind == sx::Term::Kind::Extern || is_plain(*left)) {
      const sx::Term& call = is_plain(*left) ? *right : *left;
      const sx::Term& other = is_plain(*left) ? *left : *right;
      const Index g = external(call);
      const Index range = model_.externals[g].range;
      if (range == kNone)
        call.name.place.fail("'" + call.name.text + "' is a truth value, not an object");
      q.kind = Query::Kind::External;
      q.symbol = g;
      q.arguments = arguments(call, model_.externals[g], scope, unfolded);
      q.value = argument(other, range, scope, unfolded, false);
      if (negated) q = negation(std::move(q));
      return wrap(std::move(unfolded), std::move(q));
    }
    // A function on the left: its negation is "known to differ".
    const Index* function = function_of(*left);
    if (function == nullptr) left->name.place.fail("unknown function '" + left->name.text + "'");
    if (model_.functions[*function].numeric)
      left->name.place.fail("'" + left->name.text + "' is a number; numbers only serve as costs");
    q.kind = Query::Kind::KnownValue;
    q.symbol = *function;
    q.negated = negated;
    q.arguments = arguments(*left, model_.functions[*function], scope, unfolded);
    q.value = argument(*right, model_.functions[*function].range, scope, unfolded, false);
    return wrap(std::move(unfolded), std::move(q));
  }

  Query know_whether(const sx::Formula& f, Scope& scope) {
    using K = sx::Formula::Kind;
    if (f.kind == K::Not) return know_whether(f.children.at(0), scope);
    std::vector<Unfolded> unfolded;
    if (f.kind == K::Equal || f.kind == K::NotEqual) {
      Query q = equality(f, false, scope);
      Query* leaf = &q;
      while (leaf->kind == Query::Kind::Exists) leaf = &leaf->children.at(0).children.at(1);
      if (leaf->kind != Query::Kind::KnownValue)
        f.place.fail("Kw(...) of an equality needs a function of the state");
      leaf->kind = Query::Kind::WhetherValue;
      return q;
    }
    if (f.kind != K::Atom) f.place.fail("Kw(...) holds an atom or an equality");
    Query q = atom(f.terms.at(0), scope, unfolded);
    q.kind = Query::Kind::KnowWhether;
    return wrap(std::move(unfolded), std::move(q));
  }

  Query know_value(const sx::Formula& f, Scope& scope) {
    const sx::Term& t = f.terms.at(0);
    const Index* function = function_of(t);
    if (function == nullptr)
      t.name.place.fail("Kv(...) needs a function; '" + t.name.text + "' is none");
    std::vector<Unfolded> unfolded;
    Query q;
    q.kind = Query::Kind::KnowValue;
    q.symbol = *function;
    q.arguments = arguments(t, model_.functions[*function], scope, unfolded);
    return wrap(std::move(unfolded), std::move(q));
  }

  /// Variables of an LCW pattern that nothing binds stand for every object.
  std::vector<std::pair<Index, Index>> bind_wildcards(const sx::Term& t, Scope& scope) {
    const Index* p = predicate_of(t);
    if (p == nullptr) t.name.place.fail("unknown predicate '" + t.name.text + "'");
    std::vector<std::pair<Index, Index>> slots;
    const Symbol& s = model_.predicates[*p];
    for (std::size_t i = 0; i < t.arguments.size() && i < s.parameters.size(); ++i) {
      const sx::Term& a = t.arguments[i];
      if (a.kind != sx::Term::Kind::Variable || scope.find(a.name.text) != nullptr) continue;
      const Index slot = scope.fresh();
      scope.variables.push_back({a.name.text, slot, s.parameters[i]});
      slots.emplace_back(slot, s.parameters[i]);
    }
    return slots;
  }

  Query closed_world(const sx::Formula& f, Scope& scope) {
    const sx::Formula& pattern = f.children.at(0);
    if (pattern.kind != sx::Formula::Kind::Atom) pattern.place.fail("LCW(...) holds an atom");
    const std::size_t outer = scope.variables.size();
    const auto slots = bind_wildcards(pattern.terms.at(0), scope);
    Query inner = know_whether(pattern, scope);
    scope.variables.resize(outer);
    for (const auto& [slot, t] : slots) {
      Query all;
      all.kind = Query::Kind::ForAll;
      all.symbol = slot;
      all.type = t;
      all.children.push_back(std::move(inner));
      inner = std::move(all);
    }
    return inner;
  }

  // ---- effects -----------------------------------------------------------------------------
  Update::Literal literal(const sx::Formula& f, bool negated, Scope& scope,
                          std::vector<Unfolded>& unfolded) {
    using K = sx::Formula::Kind;
    if (f.kind == K::Not) return literal(f.children.at(0), !negated, scope, unfolded);
    Update::Literal l;
    if (f.kind == K::Atom) {
      const sx::Term& t = f.terms.at(0);
      Query q = atom(t, scope, unfolded);
      l.symbol = q.symbol;
      l.arguments = std::move(q.arguments);
      l.negated = negated;
      return l;
    }
    if (f.kind != K::Equal && f.kind != K::NotEqual)
      f.place.fail("a database holds atoms, equalities of a function, and their negations");
    const bool swapped = !function_of(f.terms.at(0));
    const sx::Term& left = f.terms.at(swapped ? 1 : 0);
    const sx::Term& right = f.terms.at(swapped ? 0 : 1);
    const Index* function = function_of(left);
    if (function == nullptr) left.name.place.fail("unknown function '" + left.name.text + "'");
    const Symbol& s = model_.functions[*function];
    if (s.numeric)
      left.name.place.fail("'" + left.name.text +
                           "' is a number; only the initial state gives its value");
    l.function = true;
    l.symbol = *function;
    l.arguments = arguments(left, s, scope, unfolded);
    l.value = argument(right, s.range, scope, unfolded);
    l.negated = (f.kind == K::NotEqual) != negated;
    return l;
  }

  Update update(const sx::Effect& e, Scope& scope, std::vector<Unfolded>& unfolded) {
    Update u;
    u.add = e.kind != sx::Effect::Kind::Delete;
    u.maybe = e.kind == sx::Effect::Kind::Maybe;
    u.database = static_cast<Update::Database>(e.database);
    const sx::Formula& first = e.formulas.at(0);
    switch (e.database) {
      case sx::Database::Kf:
      case sx::Database::Lcw:
        u.literals.push_back(literal(first, false, scope, unfolded));
        break;
      case sx::Database::Kw:
        u.literals.push_back(literal(first, false, scope, unfolded));
        u.literals[0].negated = false;
        if (u.literals[0].function)
          first.place.fail("Kw holds atoms; the value of a function belongs to Kv");
        break;
      case sx::Database::Kv: {
        if (first.kind != sx::Formula::Kind::Atom || !function_of(first.terms.at(0)))
          first.place.fail("Kv holds a function term");
        const sx::Term& t = first.terms.at(0);
        Update::Literal l;
        l.function = true;
        l.symbol = *function_of(t);
        if (model_.functions[l.symbol].numeric)
          t.name.place.fail("'" + t.name.text + "' is a number, never sensed");
        l.arguments = arguments(t, model_.functions[l.symbol], scope, unfolded);
        u.literals.push_back(std::move(l));
        break;
      }
      case sx::Database::Kx:
        exclusive(e, u, scope, unfolded);
        break;
    }
    return u;
  }

  void exclusive(const sx::Effect& e, Update& u, Scope& scope, std::vector<Unfolded>& unfolded) {
    if (e.formulas.size() < 2) e.place.fail("Kx needs two or more alternatives: Kx, a | b");
    if (e.formulas.size() > 64) e.place.fail("Kx takes at most 64 alternatives");
    for (const sx::Formula& f : e.formulas) {
      u.literals.push_back(literal(f, false, scope, unfolded));
      const Update::Literal& l = u.literals.back();
      if (l.negated) f.place.fail("an alternative of Kx is an atom or f(x) = c, not a negation");
      if (l.function != u.literals[0].function)
        f.place.fail(
            "the alternatives of one Kx entry are all atoms or all values of one function");
      if (l.function && l.symbol != u.literals[0].symbol)
        f.place.fail("the alternatives of one Kx entry are values of one function term");
      if (l.function)
        for (std::size_t i = 0; i < l.arguments.size(); ++i)
          if (l.arguments[i].variable != u.literals[0].arguments[i].variable ||
              l.arguments[i].index != u.literals[0].arguments[i].index)
            f.place.fail("the alternatives of one Kx entry are values of one function term");
    }
  }

  Effect effect(const sx::Effect& e, Scope& scope) {
    Effect result;
    switch (e.kind) {
      case sx::Effect::Kind::Add:
      case sx::Effect::Kind::Maybe:
      case sx::Effect::Kind::Delete: {
        const std::size_t outer = scope.variables.size();
        std::vector<std::pair<Index, Index>> wildcards;
        if (e.database == sx::Database::Lcw) {
          if (e.formulas.at(0).kind != sx::Formula::Kind::Atom)
            e.formulas[0].place.fail("LCW(...) holds an atom");
          wildcards = bind_wildcards(e.formulas[0].terms.at(0), scope);
        }
        std::vector<Unfolded> unfolded;
        result.update = update(e, scope, unfolded);
        scope.variables.resize(outer);
        for (const auto& [slot, t] : wildcards) {
          Effect all;
          all.kind = Effect::Kind::ForAll;
          all.slot = slot;
          all.type = t;
          all.children.push_back(std::move(result));
          result = std::move(all);
        }
        return wrap(std::move(unfolded), std::move(result));
      }
      case sx::Effect::Kind::When:
        result.kind = Effect::Kind::When;
        result.condition = query(e.formulas.at(0), scope);
        for (const sx::Effect& child : e.children) result.children.push_back(effect(child, scope));
        return result;
      case sx::Effect::Kind::ForAll: {
        const std::size_t outer = scope.variables.size();
        std::vector<std::pair<Index, Index>> slots;
        for (const sx::TypedVariable& v : e.variables) {
          const Index slot = scope.fresh();
          slots.emplace_back(slot, type(v.type));
          scope.variables.push_back({v.name.text, slot, slots.back().second});
        }
        std::vector<Effect> children;
        for (const sx::Effect& child : e.children) children.push_back(effect(child, scope));
        scope.variables.resize(outer);
        for (auto s = slots.rbegin(); s != slots.rend(); ++s) {
          Effect all;
          all.kind = Effect::Kind::ForAll;
          all.slot = s->first;
          all.type = s->second;
          all.children = std::move(children);
          children.clear();
          children.push_back(std::move(all));
        }
        return std::move(children.at(0));
      }
    }
    e.place.fail("unexpected effect");
  }

  void declare_action(const sx::Action& a) {
    unique(actions_, a.name, static_cast<Index>(model_.actions.size()), "action");
    if (a.parameters.size() > kMaximumArity) a.name.place.fail("more than 12 parameters");
    Action action;
    action.name = a.name.text;
    Scope scope;
    scope.place = a.name.place;
    for (const sx::TypedVariable& p : a.parameters) {
      if (scope.find(p.name.text) != nullptr)
        p.name.place.fail("parameter '?" + p.name.text + "' is declared twice");
      const Index t = type(p.type);
      scope.variables.push_back({p.name.text, scope.fresh(), t});
      action.parameters.push_back({p.name.text, t});
    }
    action.precondition = query(a.precondition, scope);
    for (const sx::Effect& e : a.effects) action.effects.push_back(effect(e, scope));
    if (!a.cost.empty()) cost(a.cost.at(0), action, scope);
    action.slots = scope.slots;
    model_.actions.push_back(std::move(action));
  }

  static std::optional<std::int64_t> integer(const std::string& text) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0 ||
        value > 1'000'000'000)
      return std::nullopt;
    return value;
  }

  void cost(const sx::Term& t, Action& action, Scope& scope) {
    if (const auto value = integer(t.name.text)) {
      action.cost = *value;
      return;
    }
    const Index* function = function_of(t);
    if (function == nullptr || !model_.functions[*function].numeric)
      t.name.place.fail(
          "a cost is a whole number from 0 to 1000000000 or a function of type number");
    std::vector<Unfolded> unfolded;
    action.cost_function = *function;
    action.cost_arguments = arguments(t, model_.functions[*function], scope, unfolded);
    if (!unfolded.empty()) t.name.place.fail("a cost's arguments are parameters and constants");
  }

  // ---- problem -----------------------------------------------------------------------------
  bool number_entry(const sx::Effect& e) {
    const sx::Formula& f = e.formulas.at(0);
    if (f.kind != sx::Formula::Kind::Equal) return false;
    const Index* function = function_of(f.terms.at(0));
    if (function == nullptr || !model_.functions[*function].numeric) return false;
    Scope none;
    std::vector<Unfolded> unfolded;
    std::vector<Index> key;
    for (const Argument& a : arguments(f.terms[0], model_.functions[*function], none, unfolded))
      key.push_back(a.index);
    if (!unfolded.empty()) f.place.fail("an initial value's arguments are constants");
    const auto value = integer(f.terms.at(1).name.text);
    if (!value) f.terms[1].name.place.fail("expected a whole number from 0 to 1000000000");
    model_.numbers[*function][key] = *value;
    return true;
  }

  void declare_initial() {
    std::vector<Update> closed;
    for (const sx::Effect& e : document_.initial) {
      if (number_entry(e)) continue;
      Scope scope;
      scope.place = e.place;
      Effect r = effect(e, scope);
      std::vector<Index> values(scope.slots, 0);
      expand(r, values, e.place, e.database == sx::Database::Lcw ? closed : model_.initial);
    }
    for (const sx::Formula& f : document_.unknown) {
      Scope none;
      std::vector<Unfolded> unfolded;
      Update::Literal l = literal(f, false, none, unfolded);
      if (l.function || l.negated || !unfolded.empty())
        f.place.fail("'unknown' takes atoms of constants");
      std::vector<Index> key = {l.symbol};
      for (const Argument& a : l.arguments) key.push_back(a.index);
      unknown_.insert(std::move(key));
    }
    for (const Name& name : document_.closed) {
      if (name.text == "all" && !predicates_.contains("all")) {
        for (Index p = 0; p < model_.predicates.size(); ++p) close(p, {}, closed);
        continue;
      }
      const auto found = predicates_.find(name.text);
      if (found == predicates_.end()) name.place.fail("unknown predicate '" + name.text + "'");
      close(found->second, {}, closed);
    }
    for (Update& u : closed) model_.initial.push_back(std::move(u));
  }

  void close(Index predicate, std::vector<Argument> prefix, std::vector<Update>& out) {
    const Symbol& s = model_.predicates[predicate];
    if (prefix.size() == s.parameters.size()) {
      std::vector<Index> key = {predicate};
      for (const Argument& a : prefix) key.push_back(a.index);
      if (unknown_.contains(key)) return;
      if (out.size() > kMaximumInitial)
        throw Error(ErrorCode::LimitReached, "too many atoms of closed predicates");
      Update u;
      u.database = Update::Database::Lcw;
      u.literals.push_back({false, false, predicate, prefix, {}});
      out.push_back(std::move(u));
      return;
    }
    for (const Index o : model_.types[s.parameters[prefix.size()]].objects) {
      prefix.push_back({false, o});
      close(predicate, prefix, out);
      prefix.pop_back();
    }
  }

  /// Ground updates of an initial entry: only the quantification of LCW patterns may remain.
  void expand(const Effect& e, std::vector<Index>& values, const Place& place,
              std::vector<Update>& out) const {
    if (e.kind == Effect::Kind::When) place.fail("an initial entry's arguments are constants");
    if (e.kind == Effect::Kind::ForAll) {
      for (const Index o : model_.types[e.type].objects) {
        values[e.slot] = o;
        for (const Effect& child : e.children) expand(child, values, place, out);
      }
      return;
    }
    if (out.size() > kMaximumInitial) place.fail("too many instances");
    Update u = e.update;
    for (Update::Literal& l : u.literals) {
      for (Argument& a : l.arguments)
        if (a.variable) a = {false, values[a.index]};
      if (l.value && l.value->variable) l.value = Argument{false, values[l.value->index]};
    }
    out.push_back(std::move(u));
  }

  void declare_goal() {
    Scope scope;
    model_.goal.kind = Query::Kind::And;
    for (const sx::Formula& g : document_.goals) {
      scope.place = g.place;
      Query q = query(g, scope);
      if (q.kind == Query::Kind::And) {
        for (Query& child : q.children) model_.goal.children.push_back(std::move(child));
      } else {
        model_.goal.children.push_back(std::move(q));
      }
    }
    model_.goal_slots = scope.slots;
    if (document_.goals.empty())
      throw Error(
          ErrorCode::InvalidInput,
          (document_.sources.empty() ? "" : document_.sources.back()->name + ": ") +
              std::string("no goal: give the problem's file after the domain's, or a 'goal:' "
                          "section"));
  }

  const sx::Document& document_;
  const ExternalBindings& bindings_;
  Model model_;
  std::set<std::vector<Index>> unknown_;
  Table types_, objects_, predicates_, functions_, externals_, actions_;
};

}  // namespace

Model resolve(const syntax::Document& document, const ExternalBindings& bindings) {
  return Resolver(document, bindings).run();
}

}  // namespace kaboum::plan
