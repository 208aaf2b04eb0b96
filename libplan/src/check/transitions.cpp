// What actions and sensing make of run-time knowledge: docs/planning/knowledge-states.md,
// "Updates", written a second time, on the lifted model.
#include "check/transitions.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <utility>

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumSplit = 1U << 16U;  // outcomes of one action

}  // namespace

const std::vector<Index>& Transitions::range(Index function) const {
  return model_.types[model_.functions[function].range].objects;
}

/// The states that the sensing of one fact may lead to.
void Transitions::sense(RuntimeKnowledge state, const Fact& f,
                        std::vector<RuntimeKnowledge>& next) const {
  // It was sensed before, and stays open until something looks at it.
  if (state.is_open(f)) {
    next.push_back(std::move(state));
    return;
  }
  if (f[0] == 1 ? state.value(f) != nullptr : state.knows_whether(f)) {
    next.push_back(std::move(state));
    return;
  }
  if (f[0] == 1) {
    for (const Index v : range(f[1])) {
      RuntimeKnowledge copy = state;
      if (!state.rules_out(f, v) && copy.learn_value(f, v, range(f[1])))
        next.push_back(std::move(copy));
    }
    return;
  }
  for (const bool truth : {true, false}) {
    RuntimeKnowledge copy = state;
    if (copy.learn(f, truth)) next.push_back(std::move(copy));
  }
}

/// Whether either outcome may come, and tells nothing of other facts.
bool Transitions::may_leave_open(const RuntimeKnowledge& k, const Fact& f) const {
  if (outcomes_ == Outcomes::Apart) return false;
  if (f[0] == 0) return !k.knows_whether(f) && !k.tied().contains(f);
  return k.value(f) == nullptr &&
         std::ranges::count_if(range(f[1]), [&](Index v) { return !k.rules_out(f, v); }) > 1;
}

std::vector<RuntimeKnowledge> Transitions::look_at(RuntimeKnowledge k, const Fact& f) const {
  std::vector<RuntimeKnowledge> next;
  k.look_at(f);
  sense(std::move(k), f, next);
  return next;
}

/// The states that the sensing of these facts may lead to.
std::vector<RuntimeKnowledge> Transitions::split(RuntimeKnowledge k,
                                                 const std::vector<Fact>& sensed) const {
  std::vector<RuntimeKnowledge> all;
  all.push_back(std::move(k));
  for (const Fact& f : sensed) {
    if (all.size() == 1 && (all[0].is_open(f) || may_leave_open(all[0], f))) {
      all[0].leave_open(f);
      continue;
    }
    std::vector<RuntimeKnowledge> next;
    for (RuntimeKnowledge& state : all) sense(std::move(state), f, next);
    if (next.size() > kMaximumSplit)
      throw Error(ErrorCode::LimitReached, "too many outcomes of one action to replay");
    all = std::move(next);
  }
  return all;
}

std::vector<RuntimeKnowledge> Transitions::initial_states() const {
  RuntimeKnowledge k;
  std::vector<Fact> sensed;
  std::set<Fact> stated;
  const std::vector<Index> none;
  for (const Update& u : model_.initial) {
    const Update::Literal& l = u.literals[0];
    const Fact f = fact(l.function, l.symbol, l.arguments, none);
    bool ok = true;
    switch (u.database) {
      case Update::Database::Kf:
        ok = learn_literal(k, f, l);
        break;
      case Update::Database::Kw:
      case Update::Database::Kv:
        sensed.push_back(f);
        stated.insert(f);
        break;
      case Update::Database::Kx:
        for (const Update::Literal& o : u.literals)
          stated.insert(fact(o.function, o.symbol, o.arguments, none));
        ok = learn_exclusive(k, u, none);
        break;
      case Update::Database::Lcw:
        // Closed last: what is sensed or in a disjunction stays open.
        if (!k.knows_whether(f) && !stated.contains(f)) ok = k.learn(f, false);
        break;
      case Update::Database::Or: {
        std::set<FactLiteral> literals;
        for (const Update::Literal& o : u.literals) {
          const Fact atom = fact(false, o.symbol, o.arguments, none);
          stated.insert(atom);
          literals.emplace(atom, !o.negated);
        }
        if (disjunctions_ == Disjunctions::Kept) ok = k.learn_some(std::move(literals));
        break;
      }
    }
    if (!ok) throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
  }
  return split(std::move(k), sensed);
}

/// An initial entry of Kf. @return false if it contradicts what is known.
bool Transitions::learn_literal(RuntimeKnowledge& k, const Fact& f,
                                const Update::Literal& l) const {
  if (!l.function) return k.learn(f, !l.negated);
  if (is_handle(l)) {
    const Index* known = k.value(f);
    if (known != nullptr) return *known == l.value->index;
    k.become_value(f, l.value->index);
    return true;
  }
  return l.negated ? k.learn_not_value(f, l.value->index, range(l.symbol))
                   : k.learn_value(f, l.value->index, range(l.symbol));
}

bool Transitions::learn_exclusive(RuntimeKnowledge& k, const Update& u,
                                  const std::vector<Index>& slots) const {
  if (!u.literals[0].function) {
    std::set<Fact> atoms;
    for (const Update::Literal& l : u.literals)
      atoms.insert(fact(false, l.symbol, l.arguments, slots));
    return k.learn_exclusive(atoms);
  }
  const Index symbol = u.literals[0].symbol;
  const Fact f = fact(true, symbol, u.literals[0].arguments, slots);
  std::set<Index> options;
  for (const Update::Literal& l : u.literals) options.insert(object(*l.value, slots));
  for (const Index v : range(symbol))
    if (!options.contains(v) && !k.learn_not_value(f, v, range(symbol))) return false;
  return true;
}

/// Updates whose conditions hold before the action, and those whose conditions may hold in the
/// world. Of the latter, sensing and observations say nothing.
void Transitions::fire(const std::vector<Effect>& effects, std::vector<Index>& slots,
                       const RuntimeKnowledge& k, bool possibly, Happening& out) const {
  using Extent = QueryEvaluator::Extent;
  using Subject = QueryEvaluator::Subject;
  for (const Effect& e : effects) {
    if (e.kind == Effect::Kind::Update) {
      const bool changes_world = !e.update.add || e.update.database == Update::Database::Kf;
      if (changes_world || !possibly) out.updates.push_back({&e.update, slots, possibly});
    } else if (e.kind == Effect::Kind::When && e.of_world) {
      const Extent where = evaluator_.extent(e.condition, Subject::World, slots, k);
      if (where == Extent::NoWorld) continue;
      out.tied |= where == Extent::SomeWorlds;
      fire(e.children, slots, k, possibly || where == Extent::SomeWorlds, out);
    } else if (e.kind == Effect::Kind::When) {
      out.tied |= evaluator_.extent(e.condition, Subject::Agent, slots, k) == Extent::SomeWorlds;
      const std::optional<bool> happens = evaluator_.truth(e.condition, slots, k);
      if (!happens)
        throw Error(ErrorCode::LimitReached,
                    "an effect's condition rests on an external function that finds nothing");
      if (*happens) fire(e.children, slots, k, possibly, out);
    } else {
      for (const Index o : model_.types[e.type].objects) {
        slots.at(e.slot) = o;
        fire(e.children, slots, k, possibly, out);
      }
    }
  }
}

bool Transitions::in_range(const Update::Literal& l, const std::vector<Index>& slots) const {
  const Symbol& s = (l.function ? model_.functions : model_.predicates)[l.symbol];
  for (std::size_t i = 0; i < l.arguments.size(); ++i)
    if (!model_.is_a(object(l.arguments[i], slots), s.parameters[i])) return false;
  return !l.value || is_handle(l) || model_.is_a(object(*l.value, slots), s.range);
}

void Transitions::delete_literal(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                                 const std::vector<Index>& slots) const {
  if (!l.function) {
    if (!k.knows(f, l.negated)) k.forget(f);
  } else if (l.negated) {
    const Index* v = k.value(f);
    if (v == nullptr || *v != object(*l.value, slots)) k.forget_value(f);
  } else if (!k.rules_out(f, object(*l.value, slots))) {
    k.forget_value(f);
  }
}

void Transitions::delete_from(RuntimeKnowledge& k, const GroundUpdate& g) const {
  const Update& u = *g.update;
  const Update::Literal& l = u.literals[0];
  const Fact f = fact(l.function, l.symbol, l.arguments, g.slots);
  switch (u.database) {
    case Update::Database::Kf:
      delete_literal(k, f, l, g.slots);
      return;
    case Update::Database::Kw:
      k.forget(f);
      return;
    case Update::Database::Kv:
      k.forget_value(f);
      return;
    case Update::Database::Kx:
      if (l.function) {
        k.forget_value(f);
      } else {
        std::set<Fact> atoms;
        for (const Update::Literal& o : u.literals)
          atoms.insert(fact(false, o.symbol, o.arguments, g.slots));
        k.drop_exclusive(atoms);
      }
      return;
    case Update::Database::Lcw:
      if (!k.knows(f, true)) k.forget(f);
      return;
    case Update::Database::Or:
      return;
  }
}

bool Transitions::add_literal(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                              const std::vector<Index>& slots) const {
  if (!l.function) {
    k.become(f, !l.negated);
    return true;
  }
  const Index v = object(*l.value, slots);
  if (!l.negated) {
    k.become_value(f, v);
    return true;
  }
  if (const Index* known = k.value(f); known != nullptr && *known == v) k.forget_value(f);
  return k.learn_not_value(f, v, range(l.symbol));
}

/// @return false if it is an observation that contradicts what is known.
bool Transitions::add_to(RuntimeKnowledge& k, const GroundUpdate& g, const RuntimeKnowledge& before,
                         std::vector<Fact>& sensed) const {
  const Update& u = *g.update;
  const Update::Literal& l = u.literals[0];
  const Fact f = fact(l.function, l.symbol, l.arguments, g.slots);
  if (l.value && is_handle(l)) {
    const auto v = evaluator_.value(*l.value, g.slots, before);
    const Index* known = k.value(f);
    if (v && (!g.possibly || (known != nullptr && *known == *v))) {
      k.become_value(f, *v);
    } else {
      k.forget_value(f);
    }
    return true;
  }
  switch (u.database) {
    case Update::Database::Kf:
      if (!u.maybe && !g.possibly) return add_literal(k, f, l, g.slots);
      may_become(k, f, l, g.slots);
      return true;
    case Update::Database::Kw:
    case Update::Database::Kv:
    case Update::Database::Lcw:
      sensed.push_back(f);
      return true;
    case Update::Database::Kx:
      if (!l.function) k.keep_less();  // of several disjunctions not all that follows is concluded
      if (l.function) {
        const Index* known = k.value(f);
        const bool kept = known == nullptr ||
                          std::any_of(u.literals.begin(), u.literals.end(), [&](const auto& o) {
                            return object(*o.value, g.slots) == *known;
                          });
        if (!kept) k.forget_value(f);
      }
      return learn_exclusive(k, u, g.slots);
    case Update::Database::Or:
      break;
  }
  return true;
}

/// The literal may have come true: it stays known if it was, and its negation does not.
void Transitions::may_become(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                             const std::vector<Index>& slots) const {
  const Index* value = l.function ? k.value(f) : nullptr;
  if (!l.function ? k.knows(f, !l.negated)
      : l.negated ? k.rules_out(f, object(*l.value, slots))
                  : value != nullptr && *value == object(*l.value, slots))
    return;
  k.keep_less();  // which of such changes happened together
  if (l.function)
    k.forget_value(f);
  else
    k.forget(f);
}

std::vector<RuntimeKnowledge> Transitions::after(const Action& action, std::vector<Index>& slots,
                                                 const RuntimeKnowledge& before,
                                                 std::vector<Fact>* sensed) const {
  Happening happening;
  fire(action.effects, slots, before, false, happening);
  const std::vector<GroundUpdate>& fired = happening.updates;
  std::erase_if(happening.updates, [&](const GroundUpdate& g) {
    return !std::all_of(g.update->literals.begin(), g.update->literals.end(),
                        [&](const Update::Literal& l) { return in_range(l, g.slots); });
  });
  RuntimeKnowledge k = before;
  if (happening.tied) k.keep_less();
  std::vector<Fact> all;
  for (const GroundUpdate& g : fired)
    if (!g.update->add) delete_from(k, g);
  for (const GroundUpdate& g : fired)
    if (g.update->add && !add_to(k, g, before, all)) return {};
  std::vector<RuntimeKnowledge> out = split(std::move(k), all);
  if (sensed != nullptr) *sensed = std::move(all);
  return out;
}

}  // namespace kaboum::plan
