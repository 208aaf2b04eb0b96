#include "task/task.h"

#include <kaboum/geom/error.h>

#include <algorithm>
#include <array>
#include <set>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kTabulated = 1U << 20U;       // entries of one table by arguments
constexpr std::size_t kMaximumUpdates = 1'000'000;  // of one ground action

/// "p(a, b)", for messages.
std::string ground_text(const Model& model, const std::string& name,
                        const std::vector<Index>& arguments) {
  std::string text;
  for (const Index o : arguments) text += (text.empty() ? "" : ", ") + model.objects[o].name;
  return arguments.empty() ? name : name + "(" + text + ")";
}

}  // namespace

Task::Task(const Model& model, Limits& limits)
    : model_(model), limits_(limits), layout_(model, limits), pool_(model, layout_, limits) {
  Index slots = std::max<Index>(model.goal_slots, 1);
  for (const Action& a : model.actions) slots = std::max(slots, a.slots);
  slots_.assign(slots, 0);
  schemas_.resize(model.actions.size());
  for (Index s = 0; s < schemas_.size(); ++s) prepare(s);
  goal_ = pool_.ground(model.goal, slots_);
  make_initial();
  if (layout_.sensing()) find_sensible();
}

/// Initial entries are all about the same world: each is learnt, none is a change of it.
void Task::make_initial() {
  Knowledge k(layout_);
  std::set<Index> stated;
  const auto contradiction = [](const std::string& what) {
    throw Error(ErrorCode::InvalidInput,
                "the initial knowledge contradicts itself about '" + what + "'");
  };
  for (const Update& u : model_.initial) {
    const Update::Literal& l = u.literals[0];
    std::vector<Index> arguments;
    for (const Argument& a : l.arguments) arguments.push_back(a.index);
    const std::string& name = (l.function ? model_.functions : model_.predicates)[l.symbol].name;
    const Layout::Place p = l.function ? layout_.term(l.symbol, arguments.data())
                                       : layout_.atom(l.symbol, arguments.data());
    const auto position = [&](const Update::Literal& literal) {
      return layout_.position(model_.functions[literal.symbol].range, literal.value->index);
    };
    bool consistent = true;
    switch (u.database) {
      case Update::Database::Kf:
        if (p.fluent == kNone) {
          consistent = l.function
                           ? p.value == l.value->index
                           : p.atom == (l.negated ? AtomKnowledge::False : AtomKnowledge::True);
        } else if (l.function) {
          consistent = l.negated ? k.learn_not_value(p.fluent, position(l))
                                 : k.learn_value(p.fluent, position(l));
        } else {
          consistent = k.learn_atom(p.fluent, !l.negated);
        }
        break;
      case Update::Database::Kw:
        consistent = k.apply({Change::Kind::AddWhether, p.fluent, 0, {}});
        break;
      case Update::Database::Kv:
        k.apply({Change::Kind::AddSensed, p.fluent, 0, {}});
        break;
      case Update::Database::Kx:
        if (l.function) {
          std::vector<Index> options;
          for (const Update::Literal& o : u.literals) options.push_back(position(o));
          consistent = k.learn_options(p.fluent, options);
        } else {
          std::vector<Index> members;
          for (const Update::Literal& o : u.literals) {
            std::vector<Index> objects;
            for (const Argument& a : o.arguments) objects.push_back(a.index);
            members.push_back(layout_.atom(o.symbol, objects.data()).fluent);
          }
          stated.insert(members.begin(), members.end());
          consistent = k.learn_group(layout_.group(std::move(members)));
        }
        break;
      case Update::Database::Lcw:
        // What Kw or Kx speaks of is stated, if not decided.
        if (p.fluent != kNone && k.atom(p.fluent) == AtomKnowledge::Unknown &&
            !stated.contains(p.fluent))
          consistent = k.learn_atom(p.fluent, false);
        break;
    }
    if (!consistent) contradiction(ground_text(model_, name, arguments));
  }
  initial_.assign(k.words(), k.words() + layout_.words());
}

void Task::prepare(Index schema) {
  const Action& a = model_.actions[schema];
  Schema& s = schemas_[schema];
  s.levels.resize(a.parameters.size());
  // A conjunct that calls an external function is tested after all before it.
  std::size_t latest = 0;
  std::vector<std::vector<const Query*>> singles(a.parameters.size());
  const auto calls = [](const auto& self, const Query& q) -> bool {
    if (q.kind == Query::Kind::External) return true;
    return std::any_of(q.children.begin(), q.children.end(),
                       [&](const Query& c) { return self(self, c); });
  };
  for (const Query* q : conjuncts(a.precondition)) {
    Check c;
    c.query = q;
    c.slots = free_slots(*q);
    std::size_t depth = c.slots.empty() ? 0 : c.slots.back() + 1;
    const bool external = calls(calls, *q);
    if (external) depth = std::max(depth, latest);
    latest = std::max(latest, depth);
    if (depth == 0) {
      s.constant.push_back(std::move(c));
    } else if (c.slots.size() == 1 && !external) {
      singles[depth - 1].push_back(q);
    } else {
      std::size_t entries = 1;
      for (const Index slot : c.slots) {
        entries *= model_.types[a.parameters[slot].type].objects.size();
        if (entries > kTabulated) break;
      }
      if (entries <= kTabulated) c.grounded.assign(entries, ~Formula{0});
      s.levels[depth - 1].checks.push_back(std::move(c));
    }
  }
  std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
  std::size_t instances = 1;
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const std::vector<Index>& objects = model_.types[a.parameters[i].type].objects;
    for (const Index o : objects) {
      Candidate c;
      c.object = o;
      slots[i] = o;
      std::vector<Formula> all;
      for (const Query* q : singles[i]) all.push_back(pool_.ground(*q, slots));
      c.full = pool_.all(all);
      if (c.full == kFalse) continue;
      pool_.as_bits(c.full, c.word, c.mask, c.value);
      s.levels[i].candidates.push_back(c);
    }
    if (instances <= kTabulated) instances *= objects.size();
  }
  if (instances <= kTabulated) s.steps.assign(instances, ~Step{0});
}

Formula Task::grounded(Index schema, Check& check, const Index* slots) {
  const Action& a = model_.actions[schema];
  if (!check.grounded.empty()) {
    std::size_t n = 0;
    for (const Index slot : check.slots) {
      const Index type = a.parameters[slot].type;
      n = n * model_.types[type].objects.size() + layout_.position(type, slots[slot]);
    }
    Formula& f = check.grounded[n];
    if (f == ~Formula{0}) {
      std::vector<Index> copy(slots, slots + std::max<Index>(a.slots, 1));
      f = pool_.ground(*check.query, copy);
    }
    return f;
  }
  std::vector<Index> copy(slots, slots + std::max<Index>(a.slots, 1));
  return pool_.ground(*check.query, copy);
}

Step Task::action_step(Index schema, const std::vector<Index>& arguments) {
  Schema& s = schemas_[schema];
  const Action& a = model_.actions[schema];
  std::size_t n = 0;
  std::string key;
  Step* known = nullptr;
  if (!s.steps.empty()) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const Index type = a.parameters[i].type;
      n = n * model_.types[type].objects.size() + layout_.position(type, arguments[i]);
    }
    known = &s.steps[n];
  } else {
    for (const Index o : arguments) key.append(reinterpret_cast<const char*>(&o), sizeof o);
    known = &s.step_index.emplace(key, ~Step{0}).first->second;
  }
  if (*known != ~Step{0}) return *known;
  if (actions_.size() >= kOutcome - 1)
    throw Error(ErrorCode::LimitReached, "too many ground actions");
  auto ground = std::make_unique<GroundAction>();
  ground->schema = schema;
  ground->arguments = arguments;
  std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
  std::copy(arguments.begin(), arguments.end(), slots.begin());
  ground->precondition = pool_.ground(a.precondition, slots);
  ground->cost = a.cost;
  if (a.cost_function != kNone) {
    std::vector<Index> objects;
    for (const Argument& c : a.cost_arguments) objects.push_back(value_of(c, slots.data()));
    const auto& table = model_.numbers[a.cost_function];
    const auto value = table.find(objects);
    if (value == table.end())
      throw Error(ErrorCode::InvalidInput,
                  "no initial value of '" +
                      ground_text(model_, model_.functions[a.cost_function].name, objects) +
                      "' for the cost of an action '" + a.name + "'");
    ground->cost = value->second;
  }
  grounded_updates_ = 0;
  ground_effects(a.effects, kTrue, slots, *ground);
  limits_.work(sizeof(GroundAction) + ground->effects.size() * sizeof(Conditional));
  *known = static_cast<Step>(actions_.size());
  actions_.push_back(std::move(ground));
  return *known;
}

bool Task::is_plain(const Change& c) const {
  if (c.kind != Change::Kind::AddTrue && c.kind != Change::Kind::AddFalse &&
      c.kind != Change::Kind::AddValue)
    return false;
  const Fluent& f = layout_.fluents()[c.fluent];
  return f.groups.empty() && f.exclusions == kNone;
}

void Task::add_change(const Update& u, const std::vector<Index>& slots, Conditional& out) {
  using D = Update::Database;
  const auto place = [&](const Update::Literal& l) {
    std::vector<Index> objects;
    for (const Argument& a : l.arguments) objects.push_back(value_of(a, slots.data()));
    return l.function ? layout_.term(l.symbol, objects.data())
                      : layout_.atom(l.symbol, objects.data());
  };
  const auto position = [&](const Update::Literal& l) {
    return layout_.position(model_.functions[l.symbol].range, value_of(*l.value, slots.data()));
  };
  const Update::Literal& l = u.literals[0];
  const Layout::Place p = place(l);
  if (!p.exists) return;  // an argument outside its type: no such atom
  ensure(p.fluent != kNone, "an effect changes what was taken for constant");
  if (l.value && position(l) == kNone) return;
  Change c;
  c.fluent = p.fluent;
  using K = Change::Kind;
  switch (u.database) {
    case D::Kf:
      if (l.function) c.value = position(l);
      if (u.add && !u.maybe) {
        c.kind = l.function ? (l.negated ? K::Exclude : K::AddValue)
                            : (l.negated ? K::AddFalse : K::AddTrue);
      } else {
        // What may happen takes the knowledge that it would make false: the negation.
        const bool takes_negation = l.negated != u.maybe;
        c.kind = l.function ? (takes_negation ? K::DeleteExclude : K::DeleteValue)
                            : (takes_negation ? K::DeleteFalse : K::DeleteTrue);
      }
      break;
    case D::Kw:
      c.kind = u.add ? K::AddWhether : K::Forget;
      break;
    case D::Kv:
      c.kind = u.add ? K::AddSensed : K::Forget;
      break;
    case D::Lcw:
      c.kind = u.add ? K::AddClosed : K::DeleteClosed;
      break;
    case D::Kx:
      if (l.function) {
        c.kind = u.add ? K::AddOptions : K::Forget;
        for (const Update::Literal& o : u.literals)
          if (position(o) != kNone) c.options.push_back(position(o));
      } else {
        std::vector<Index> members;
        for (const Update::Literal& o : u.literals) members.push_back(place(o).fluent);
        c.kind = u.add ? K::AddGroup : K::DeleteGroup;
        c.fluent = layout_.group(std::move(members));
        ensure(c.fluent != kNone, "an effect names an unknown group");
      }
      break;
  }
  if (!u.add) {
    out.deletions.push_back(std::move(c));
    return;
  }
  if (c.kind == K::AddWhether || c.kind == K::AddSensed || c.kind == K::AddClosed) {
    out.sensing.push_back(std::move(c));
    return;
  }
  // A plain write after additions that are none would come before them: keep the text's order then.
  if (out.additions.empty() && is_plain(c)) {
    const Fluent& f = layout_.fluents()[c.fluent];
    const Word content =
        c.kind == K::AddValue
            ? kFirstValue + c.value
            : static_cast<Word>(c.kind == K::AddTrue ? AtomKnowledge::True : AtomKnowledge::False);
    const Conditional::Write w{f.word, f.mask, content << f.shift};
    out.plain.push_back(c);
    for (Conditional::Write& old : out.writes)
      if (old.word == w.word) {
        old.bits = (old.bits & ~w.mask) | w.bits;
        old.mask |= w.mask;
        return;
      }
    out.writes.push_back(w);
  } else {
    out.additions.push_back(std::move(c));
  }
}

void Task::ground_effects(const std::vector<Effect>& effects, Formula condition,
                          std::vector<Index>& slots, GroundAction& action) {
  for (const Effect& e : effects) {
    switch (e.kind) {
      case Effect::Kind::Update: {
        limits_.work(sizeof(Change));
        if (++grounded_updates_ > kMaximumUpdates)
          throw Error(
              ErrorCode::LimitReached,
              "the effects of an action '" + model_.actions[action.schema].name + "' are too many");
        if (action.effects.empty() || action.effects.back().condition != condition) {
          Conditional c;
          c.condition = condition;
          pool_.as_bits(condition, c.word, c.mask, c.value);
          action.effects.push_back(std::move(c));
        }
        add_change(e.update, slots, action.effects.back());
        break;
      }
      case Effect::Kind::When: {
        limits_.work();
        const Formula f = pool_.all({condition, pool_.ground(e.condition, slots)});
        if (f != kFalse) ground_effects(e.children, f, slots, action);
        break;
      }
      case Effect::Kind::ForAll:
        for (const Index o : model_.types[e.type].objects) {
          slots[e.slot] = o;
          ground_effects(e.children, condition, slots, action);
        }
        break;
    }
  }
}

Step Task::outcome_step(Index fluent, Index value) {
  const auto [it, fresh] = outcome_index_.emplace(std::pair(fluent, value),
                                                  static_cast<Step>(outcomes_.size()) | kOutcome);
  if (fresh) outcomes_.push_back({fluent, value});
  return it->second;
}

std::vector<Index> Task::outcomes(Index fluent, const Word* state) const {
  const Fluent& f = layout_.fluents()[fluent];
  if (!f.function) return {1, 0};
  Knowledge k(layout_);
  k.assign(state);
  return k.possible_values(fluent, layout_.range_size(f));
}

bool Task::apply(Step step, Knowledge& state) {
  if (is_outcome(step)) {
    const Outcome o = outcomes_[step & ~kOutcome];
    return layout_.fluents()[o.fluent].function ? state.learn_value(o.fluent, o.value)
                                                : state.learn_atom(o.fluent, o.value != 0);
  }
  const GroundAction& a = *actions_[step];
  // All conditions look at the state before the action; then come deletions, additions, sensing.
  std::array<const Conditional*, 16> few;
  std::vector<const Conditional*> many;
  std::size_t count = 0;
  bool deletions = false;
  for (const Conditional& c : a.effects) {
    if (c.condition != kTrue) {
      if (c.mask != 0) {
        if ((state.words()[c.word] & c.mask) != c.value) continue;
      } else if (!pool_.holds(c.condition, state.words())) {
        continue;
      }
    }
    deletions |= !c.deletions.empty();
    if (count < few.size()) {
      few[count] = &c;
    } else {
      if (many.empty()) many.assign(few.begin(), few.end());
      many.push_back(&c);
    }
    ++count;
  }
  const Conditional* const* fired = many.empty() ? few.data() : many.data();
  if (deletions)
    for (std::size_t i = 0; i < count; ++i)
      for (const Change& c : fired[i]->deletions)
        if (!state.apply(c)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    for (const Conditional::Write& w : fired[i]->writes) state.write(w.word, w.mask, w.bits);
    for (const Change& c : fired[i]->additions)
      if (!state.apply(c)) return false;
  }
  // What is sensed is the world after the action.
  for (std::size_t i = 0; i < count; ++i)
    for (const Change& c : fired[i]->sensing)
      if (!state.apply(c)) return false;
  return true;
}

Index Task::undecided(const Change& c, const Word* state) const {
  using K = Change::Kind;
  if (c.kind == K::DeleteGroup) {
    // What the entry would tell once sensed values are at hand must be concluded before it goes.
    const Group& g = layout_.groups()[c.fluent];
    for (std::size_t i = 0; i < g.members.size(); ++i) {
      if (((state[g.word] >> i) & 1U) == 0) continue;
      const Index m = g.members[i];
      if (layout_.fluents()[m].get(state) == static_cast<Word>(AtomKnowledge::Whether)) return m;
      if (const Index tie = layout_.sensed_tie(m, state); tie != kNone) return tie;
    }
    return kNone;
  }
  if (c.kind == K::AddGroup || c.kind == K::AddWhether || c.kind == K::AddClosed ||
      c.kind == K::AddSensed)
    return kNone;
  const Fluent& f = layout_.fluents()[c.fluent];
  const Word content = f.get(state);
  switch (c.kind) {
    case K::DeleteTrue:
    case K::DeleteFalse:
    case K::DeleteClosed:
      if (content == static_cast<Word>(AtomKnowledge::Whether)) return c.fluent;
      break;
    case K::DeleteValue:
    case K::DeleteExclude:
    case K::Exclude:
    case K::AddOptions:
      return content == kValueSensed ? c.fluent : kNone;
    default:
      break;
  }
  // What Kx would conclude from the value must be concluded before the atom changes.
  if (f.groups.empty()) return kNone;
  if (content == static_cast<Word>(AtomKnowledge::Whether))
    return std::any_of(f.groups.begin(), f.groups.end(),
                       [&](const auto& g) {
                         return ((state[layout_.groups()[g.first].word] >> g.second) & 1U) != 0;
                       })
               ? c.fluent
               : kNone;
  return content == static_cast<Word>(AtomKnowledge::Unknown) ? layout_.sensed_tie(c.fluent, state)
                                                              : kNone;
}

template <bool Sensing>
void Task::expand_schema(Index schema, const Word* state, std::vector<Step>& steps,
                         std::vector<Index>& needs) {
  Schema& s = schemas_[schema];
  Index* slots = slots_.data();
  std::array<Formula, 64> open;  // open formulas on the way down
  std::size_t open_count = 0;
  // No: prune. Open formulas are remembered and the descent goes on.
  const auto test = [&](Formula f) {
    if (f == kTrue) return true;
    if (f == kFalse) return false;
    if constexpr (!Sensing) return pool_.holds(f, state);
    if (open_count > 0 && pool_.node(f).calls)
      return true;  // not called before the rest is decided
    const Truth t = pool_.evaluate(f, state);
    if (t == Truth::Open && open_count < open.size()) open[open_count++] = f;
    return t != Truth::No;
  };
  for (Check& c : s.constant)
    if (!test(grounded(schema, c, slots))) return;
  std::vector<Index> arguments(s.levels.size());
  const auto descend = [&](const auto& self, std::size_t depth) -> void {
    if (depth == s.levels.size()) {
      ++tests_;
      if constexpr (Sensing) {
        if (open_count > 0) {
          for (std::size_t i = 0; i < open_count; ++i) pool_.open_fluents(open[i], state, needs);
          return;
        }
      }
      const Step step = action_step(schema, arguments);
      if constexpr (Sensing) {
        bool decided = true;
        for (const Conditional& c : actions_[step]->effects) {
          const Truth t = c.condition == kTrue ? Truth::Yes : pool_.evaluate(c.condition, state);
          if (t == Truth::Open) {
            pool_.open_fluents(c.condition, state, needs);
            decided = false;
          }
          if (t != Truth::Yes) continue;
          for (const auto* list : {&c.deletions, &c.additions})
            for (const Change& change : *list) {
              const Index fluent = undecided(change, state);
              if (fluent == kNone) continue;
              needs.push_back(fluent);
              decided = false;
            }
        }
        if (!decided) return;
      }
      steps.push_back(step);
      return;
    }
    Level& level = s.levels[depth];
    for (const Candidate& c : level.candidates) {
      limits_.work();
      const std::size_t before = open_count;
      if (c.mask != 0 && (state[c.word] & c.mask) == c.value) {
        // holds
      } else if (c.mask != 0 && !Sensing) {
        continue;
      } else if (!test(c.full)) {
        continue;
      }
      slots[depth] = c.object;
      arguments[depth] = c.object;
      bool ok = true;
      for (Check& check : level.checks)
        if (!test(grounded(schema, check, slots))) {
          ok = false;
          break;
        }
      if (ok) self(self, depth + 1);
      open_count = before;
    }
  };
  descend(descend, 0);
}

void Task::expand(const Word* state, std::vector<Step>& steps) {
  steps.clear();
  if (!layout_.sensing()) {
    for (Index s = 0; s < schemas_.size(); ++s) expand_schema<false>(s, state, steps, needs_);
    return;
  }
  needs_.clear();
  for (Index s = 0; s < schemas_.size(); ++s) expand_schema<true>(s, state, steps, needs_);
  if (pool_.evaluate(goal_, state) == Truth::Open) pool_.open_fluents(goal_, state, needs_);
  std::sort(needs_.begin(), needs_.end());
  needs_.erase(std::unique(needs_.begin(), needs_.end()), needs_.end());
  for (const Index fluent : needs_)
    for (const Index value : outcomes(fluent, state)) steps.push_back(outcome_step(fluent, value));
  if (held_back_ && branching_ == Branching::OnNeed) return;
  for (const Index fluent : sensible_) {
    const Fluent& f = layout_.fluents()[fluent];
    const Word sensed = f.function ? kValueSensed : static_cast<Word>(AtomKnowledge::Whether);
    if (f.get(state) != sensed || std::binary_search(needs_.begin(), needs_.end(), fluent))
      continue;
    held_back_ = true;
    if (branching_ == Branching::OnNeed) return;
    for (const Index value : outcomes(fluent, state)) steps.push_back(outcome_step(fluent, value));
  }
}

void Task::find_sensible() {
  std::vector<char> read(model_.predicates.size() + model_.functions.size(), 0);
  const auto collect = [&](const auto& self, const Query& q) -> void {
    switch (q.kind) {
      case Query::Kind::Known:
      case Query::Kind::KnowWhether:
        read[q.symbol] = 1;
        break;
      case Query::Kind::KnownValue:
      case Query::Kind::WhetherValue:
      case Query::Kind::KnowValue:
        read[model_.predicates.size() + q.symbol] = 1;
        break;
      default:
        break;
    }
    for (const Query& c : q.children) self(self, c);
  };
  const auto effects = [&](const auto& self, const std::vector<Effect>& list) -> void {
    for (const Effect& e : list) {
      if (e.kind == Effect::Kind::When) collect(collect, e.condition);
      self(self, e.children);
    }
  };
  collect(collect, model_.goal);
  for (const Action& a : model_.actions) {
    collect(collect, a.precondition);
    effects(effects, a.effects);
  }
  for (Index i = 0; i < layout_.fluents().size(); ++i) {
    const Fluent& f = layout_.fluents()[i];
    // An atom in a disjunction may tell something of another that is read.
    if (!f.groups.empty() || read[(f.function ? model_.predicates.size() : 0) + f.symbol] != 0)
      sensible_.push_back(i);
  }
}

}  // namespace kaboum::plan
