// Grounding over possible worlds: parameters are chosen one by one against what never changes.
#include "worlds/world_grounder.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <set>

#include "worlds/world_arrangement.h"

namespace kaboum::plan::worlds {
namespace {

constexpr std::size_t kMostOperators = 200'000;

/// Thrown where the model is not of the kind treated here.
struct NotTreated {};

using Kind = Condition::Kind;

Condition constant(bool truth) {
  Condition c;
  c.kind = truth ? Kind::True : Kind::False;
  return c;
}

Condition both(const Condition& a, Condition b) {
  if (a.kind == Kind::True || b.kind == Kind::False) return b;
  if (b.kind == Kind::True || a.kind == Kind::False) return a;
  Condition c;
  c.kind = Kind::And;
  c.children = {a, std::move(b)};
  return c;
}

class Grounder {
 public:
  Grounder(const Model& model, Limits& limits) : model_(model), limits_(limits) {}

  WorldTask run() {
    if (!model_.externals.empty()) throw NotTreated();
    if (std::any_of(model_.types.begin(), model_.types.end(),
                    [](const Type& t) { return t.handle; }))
      throw NotTreated();
    find_changing();
    read_initial();
    for (const Action& a : model_.actions) ground_action(a);
    std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
    task_.goal = condition(model_.goal, slots);
    arrange_worlds(task_, limits_);
    return std::move(task_);
  }

 private:
  using Key = std::vector<Index>;  ///< 0 or 1 (a function), symbol, arguments

  // Symbols that an action changes, and what is stated of the rest.

  void find_changing() {
    changing_[0].assign(model_.predicates.size(), 0);
    changing_[1].assign(model_.functions.size(), 0);
    for (const Action& a : model_.actions) mark(a.effects);
  }
  void mark(const std::vector<Effect>& effects) {
    for (const Effect& e : effects) {
      mark(e.children);
      if (e.kind != Effect::Kind::Update) continue;
      for (const Update::Literal& l : e.update.literals)
        changing_[l.function ? 1 : 0][l.symbol] = 1;
    }
  }

  static Key key(const Update::Literal& l) {
    Key k = {l.function ? Index{1} : Index{0}, l.symbol};
    for (const Argument& a : l.arguments) k.push_back(a.index);
    return k;
  }
  [[nodiscard]] Index position(Index function, Index object) const {
    const auto& range = model_.types[model_.functions[function].range].objects;
    const auto found = std::lower_bound(range.begin(), range.end(), object);
    return found == range.end() || *found != object ? kNone
                                                    : static_cast<Index>(found - range.begin());
  }

  void read_initial() {
    std::set<Key> stated;
    for (const Update& u : model_.initial) {
      const Update::Literal& l = u.literals[0];
      switch (u.database) {
        case Update::Database::Kf:
          stated.insert(key(l));
          if (l.function && l.negated)
            task_.constraints.push_back({false, {literal(l)}});
          else
            known(key(l), l.function ? position(l.symbol, l.value->index) : (l.negated ? 0U : 1U));
          break;
        case Update::Database::Kw:
        case Update::Database::Kv:
          stated.insert(key(l));
          task_.sensed.push_back(variable(key(l)));
          break;
        case Update::Database::Kx:
        case Update::Database::Or: {
          Constraint c;
          c.exactly_one = u.database == Update::Database::Kx;
          for (const Update::Literal& o : u.literals) {
            stated.insert(key(o));
            c.literals.push_back(literal(o));
          }
          task_.constraints.push_back(std::move(c));
          break;
        }
        case Update::Database::Lcw:
          limits_.work();
          if (!stated.contains(key(l))) known(key(l), 0);
          break;
      }
    }
    // A value that is known need not be searched for.
    for (Variable& v : task_.variables)
      if (const auto found = known_.find(key(v)); found != known_.end()) v.initial = found->second;
  }
  Constraint::Literal literal(const Update::Literal& l) {
    return {variable(key(l)), l.function ? position(l.symbol, l.value->index) : 1, l.negated};
  }
  static Key key(const Variable& v) {
    Key k = {v.function ? Index{1} : Index{0}, v.symbol};
    k.insert(k.end(), v.arguments.begin(), v.arguments.end());
    return k;
  }
  void known(const Key& k, Index value) {
    const auto [it, fresh] = known_.emplace(k, value);
    if (!fresh && it->second != value)
      throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
  }

  Index variable(const Key& k) {
    const auto [it, fresh] = numbers_.emplace(k, static_cast<Index>(task_.variables.size()));
    if (!fresh) return it->second;
    Variable v;
    v.function = k[0] == 1;
    v.symbol = k[1];
    v.arguments.assign(k.begin() + 2, k.end());
    if (v.function)
      v.size = static_cast<Index>(model_.types[model_.functions[v.symbol].range].objects.size());
    if (const auto found = known_.find(k); found != known_.end()) v.initial = found->second;
    task_.variables.push_back(std::move(v));
    limits_.work(sizeof(Variable) + k.size() * sizeof(Index) * 2);
    return it->second;
  }

  // Queries.

  static Index of(const Argument& a, const std::vector<Index>& slots) {
    if (a.term) throw NotTreated();
    return a.variable ? slots.at(a.index) : a.index;
  }
  static Key key(bool function, const Query& q, const std::vector<Index>& slots) {
    Key k = {function ? Index{1} : Index{0}, q.symbol};
    for (const Argument& a : q.arguments) k.push_back(of(a, slots));
    return k;
  }
  [[nodiscard]] bool in_types(bool function, const Key& k) const {
    const Symbol& s = (function ? model_.functions : model_.predicates)[k[1]];
    for (std::size_t i = 0; i < s.parameters.size(); ++i)
      if (!model_.is_a(k[i + 2], s.parameters[i])) return false;
    return true;
  }

  /// What nothing changes and is known is decided here.
  Condition leaf(Kind kind, bool function, const Query& q, const std::vector<Index>& slots) {
    Key k = key(function, q, slots);
    Condition c;
    c.kind = kind;
    if (q.value) {
      c.value = position(q.symbol, of(*q.value, slots));
      if (c.value == kNone) {
        // No such value in the range: known to differ.
        return constant(kind != Kind::Is);
      }
    } else {
      c.value = 1;
    }
    if (!in_types(function, k)) return constant(false);
    if (changing_[k[0]][k[1]] == 0) {
      const auto found = known_.find(k);
      if (found != known_.end())
        return constant(kind == Kind::Decided || kind == Kind::Whether ||
                        (found->second == c.value) == (kind == Kind::Is));
    }
    c.variable = variable(k);
    return c;
  }

  Condition condition(const Query& q, std::vector<Index>& slots) {
    switch (q.kind) {
      case Query::Kind::True:
      case Query::Kind::False:
        return constant(q.kind == Query::Kind::True);
      case Query::Kind::And:
      case Query::Kind::Or: {
        const bool conjunction = q.kind == Query::Kind::And;
        std::vector<Condition> children;
        for (const Query& child : q.children) {
          Condition c = condition(child, slots);
          if (c.kind == (conjunction ? Kind::False : Kind::True)) return c;
          if (c.kind != (conjunction ? Kind::True : Kind::False)) children.push_back(std::move(c));
        }
        return joined(conjunction ? Kind::And : Kind::Or, std::move(children));
      }
      case Query::Kind::Xor: {
        Condition c;
        c.kind = Kind::Xor;
        for (const Query& child : q.children) c.children.push_back(condition(child, slots));
        return c;
      }
      case Query::Kind::Not: {
        Condition c;
        c.kind = Kind::Not;
        c.children.push_back(condition(q.children[0], slots));
        if (c.children[0].kind == Kind::True || c.children[0].kind == Kind::False)
          return constant(c.children[0].kind == Kind::False);
        return c;
      }
      case Query::Kind::Exists:
      case Query::Kind::ForAll: {
        const bool all = q.kind == Query::Kind::ForAll;
        std::vector<Condition> children;
        for (const Index o : model_.types[q.type].objects) {
          slots.at(q.symbol) = o;
          Condition c = condition(q.children[0], slots);
          if (c.kind == (all ? Kind::False : Kind::True)) return c;
          if (c.kind != (all ? Kind::True : Kind::False)) children.push_back(std::move(c));
        }
        return joined(all ? Kind::And : Kind::Or, std::move(children));
      }
      case Query::Kind::Known:
        return leaf(q.negated ? Kind::IsNot : Kind::Is, false, q, slots);
      case Query::Kind::KnowWhether:
        return leaf(Kind::Decided, false, q, slots);
      case Query::Kind::KnownValue:
        return leaf(q.negated ? Kind::IsNot : Kind::Is, true, q, slots);
      case Query::Kind::WhetherValue:
        return leaf(Kind::Whether, true, q, slots);
      case Query::Kind::KnowValue:
        return leaf(Kind::Decided, true, q, slots);
      case Query::Kind::Same:
        return constant(of(q.arguments[0], slots) == of(q.arguments[1], slots));
      case Query::Kind::Derived:
      case Query::Kind::External:
      case Query::Kind::Let:
        break;
    }
    throw NotTreated();
  }
  static Condition joined(Kind kind, std::vector<Condition> children) {
    if (children.empty()) return constant(kind == Kind::And);
    if (children.size() == 1) return std::move(children[0]);
    Condition c;
    c.kind = kind;
    c.children = std::move(children);
    return c;
  }

  // Actions.

  /// The highest slot that a conjunct reads, as a number of parameters that must be there; kNone:
  /// it quantifies or reads what changes.
  Index needs(const Query& q) const {
    Index most = 0;
    const auto see = [&](const Argument& a) {
      if (a.variable) most = std::max(most, a.index + 1);
    };
    if (q.kind == Query::Kind::Known || q.kind == Query::Kind::KnownValue) {
      const bool function = q.kind == Query::Kind::KnownValue;
      if (changing_[function ? 1 : 0][q.symbol] != 0) return kNone;
    } else if (q.kind == Query::Kind::Not && q.children[0].kind == Query::Kind::Same) {
      for (const Argument& a : q.children[0].arguments) see(a);
      return most;
    } else if (q.kind != Query::Kind::Same) {
      return kNone;
    }
    for (const Argument& a : q.arguments) see(a);
    if (q.value) see(*q.value);
    return most;
  }

  void ground_action(const Action& a) {
    // Conjuncts over what never changes, by the parameter that completes them.
    std::vector<std::vector<const Query*>> tests(a.parameters.size() + 1);
    const auto collect = [&](const auto& self, const Query& q) -> void {
      if (q.kind == Query::Kind::And) {
        for (const Query& c : q.children) self(self, c);
        return;
      }
      const Index n = needs(q);
      if (n != kNone && n <= a.parameters.size()) tests[n].push_back(&q);
    };
    collect(collect, a.precondition);
    std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
    const auto choose = [&](const auto& self, std::size_t n) -> void {
      limits_.work();
      for (const Query* q : tests[n])
        if (condition(*q, slots).kind == Kind::False) return;
      if (n == a.parameters.size()) {
        instance(a, slots);
        return;
      }
      for (const Index o : model_.types[a.parameters[n].type].objects) {
        slots[n] = o;
        self(self, n + 1);
      }
    };
    choose(choose, 0);
  }

  void instance(const Action& a, std::vector<Index>& slots) {
    Operator o;
    o.schema = static_cast<Index>(&a - model_.actions.data());
    o.arguments.assign(slots.begin(), slots.begin() + static_cast<long>(a.parameters.size()));
    o.precondition = condition(a.precondition, slots);
    if (o.precondition.kind == Kind::False) return;
    std::vector<Step> all;
    steps(a.effects, slots, constant(true), constant(true), all);
    const auto phase = [](const Step& s) {
      return s.kind == Step::Kind::Sense ? 2 : s.deletion ? 0 : 1;
    };
    for (const int now : {0, 1, 2})
      for (const Step& s : all)
        if (phase(s) == now) o.steps.push_back(s);
    if (task_.operators.size() >= kMostOperators) throw NotTreated();
    limits_.work(sizeof(Operator) + o.steps.size() * sizeof(Step));
    task_.operators.push_back(std::move(o));
  }

  void steps(const std::vector<Effect>& effects, std::vector<Index>& slots, const Condition& known,
             const Condition& world, std::vector<Step>& out) {
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::Update) {
        update(e.update, slots, known, world, out);
      } else if (e.kind == Effect::Kind::When) {
        Condition c = condition(e.condition, slots);
        if (c.kind == Kind::False) continue;
        if (e.of_world)
          steps(e.children, slots, known, both(world, std::move(c)), out);
        else
          steps(e.children, slots, both(known, std::move(c)), world, out);
      } else {
        for (const Index o : model_.types[e.type].objects) {
          slots.at(e.slot) = o;
          steps(e.children, slots, known, world, out);
        }
      }
    }
  }

  void update(const Update& u, const std::vector<Index>& slots, const Condition& known,
              const Condition& world, std::vector<Step>& out) {
    std::vector<Key> keys;
    std::vector<Index> values;
    for (const Update::Literal& l : u.literals) {
      Key k = {l.function ? Index{1} : Index{0}, l.symbol};
      for (const Argument& a : l.arguments) k.push_back(of(a, slots));
      if (!in_types(l.function, k)) return;
      Index value = 1;
      if (l.function && l.value) {
        value = position(l.symbol, of(*l.value, slots));
        if (value == kNone) return;
      }
      keys.push_back(std::move(k));
      values.push_back(value);
    }
    const Update::Literal& l = u.literals[0];
    Step s;
    s.variable = variable(keys[0]);
    s.value = values[0];
    s.known = known;
    s.world = world;
    switch (u.database) {
      case Update::Database::Kf:
        if (u.maybe) {
          s.kind = Step::Kind::Free;
          s.differs = !l.negated;
        } else if (!u.add) {
          s.kind = Step::Kind::Free;
          s.differs = l.negated;
        } else if (l.function && l.negated) {
          s.kind = Step::Kind::Rule;
        } else if (!l.function) {
          s.value = l.negated ? 0 : 1;
        }
        break;
      case Update::Database::Kw:
      case Update::Database::Kv:
        s.kind = u.add ? Step::Kind::Sense : Step::Kind::Free;
        s.any = true;
        break;
      case Update::Database::Lcw:
        s.kind = u.add ? Step::Kind::Sense : Step::Kind::Free;
        s.differs = true;
        break;
      case Update::Database::Kx:
        if (!u.add) {
          if (!l.function) return;
          s.kind = Step::Kind::Free;
          s.any = true;
          break;
        }
        s.kind = Step::Kind::OneOf;
        for (std::size_t i = 0; i < keys.size(); ++i)
          s.options.emplace_back(variable(keys[i]), values[i]);
        std::sort(s.options.begin(), s.options.end());
        s.options.erase(std::unique(s.options.begin(), s.options.end()), s.options.end());
        break;
      case Update::Database::Or:
        throw NotTreated();
    }
    if (s.kind == Step::Kind::Sense && world.kind != Kind::True) throw NotTreated();
    // An observation rules out runs, not only worlds of a belief.
    if (s.kind == Step::Kind::Rule || s.kind == Step::Kind::OneOf) throw NotTreated();
    s.deletion = !u.add;
    out.push_back(std::move(s));
  }

  const Model& model_;
  Limits& limits_;
  WorldTask task_;
  std::vector<char> changing_[2];  ///< by symbol: predicates, functions
  std::map<Key, Index> known_;     ///< what is stated of values
  std::map<Key, Index> numbers_;
};

}  // namespace

std::optional<WorldTask> ground_worlds(const Model& model, Limits& limits) {
  try {
    return Grounder(model, limits).run();
  } catch (const NotTreated&) {
    return std::nullopt;
  }
}

}  // namespace kaboum::plan::worlds
