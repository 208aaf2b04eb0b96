// Relaxed reachability by joins, one fact after the other ("semi-naive").
#include "search/reachability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>

#include "task/bindings.h"

namespace kaboum::plan {

using Kind = FormulaPool::Kind;

namespace {

constexpr std::size_t kMostPositions = 64;
constexpr std::size_t kMostJoined = 64;  // atoms of a precondition: rules grow with their cube

bool is_atom(const Query& q) {
  return q.kind == Query::Kind::Known && !q.negated && q.arguments.size() <= kMostPositions &&
         std::none_of(q.arguments.begin(), q.arguments.end(),
                      [](const Argument& a) { return a.term != nullptr; });
}

bool has_variables(const Query* q) {
  return std::any_of(q->arguments.begin(), q->arguments.end(),
                     [](const Argument& a) { return a.variable; });
}

}  // namespace

Reachability::Reachability(Task& task, Limits& limits, const FactTable& facts, Answers answers,
                           Index without)
    : task_(task), limits_(limits), facts_(facts), answers_(answers), without_(without) {
  const Model& model = task.model();
  reached_.assign(facts.size(), 0);
  taken_.assign(task.layout().fluents().size(), 0);
  Index slots = 1;
  for (const Action& a : model.actions) slots = std::max(slots, a.slots);
  slots_.assign(slots, 0);
  bound_.assign(slots, 0);
  triggered_.resize(model.predicates.size());
  make_relations();
  schemas_.resize(model.actions.size());
  for (Index s = 0; s < schemas_.size(); ++s) {
    make_schema(s);
    make_rule(s, nullptr);
    for (const Query* atom : schemas_[s].atoms)
      if (sizes_at_most_[atom->symbol] > relations_[atom->symbol].size()) make_rule(s, atom);
  }
  start();
  run();
  std::sort(actions_.begin(), actions_.end(), [&](OperatorId a, OperatorId b) {
    const GroundAction& x = task.action(a);
    const GroundAction& y = task.action(b);
    return std::tie(layer_of_[a], x.schema, x.arguments) <
           std::tie(layer_of_[b], y.schema, y.arguments);
  });
}

/// What is true for good, and how many atoms may be at most.
void Reachability::make_relations() {
  const Model& model = task_.model();
  for (Index p = 0; p < model.predicates.size(); ++p) {
    Relation& r = relations_.emplace_back(model.predicates[p].parameters.size());
    task_.layout().true_constants(p,
                                  [&](const std::vector<Index>& arguments) { r.add(arguments); });
    sizes_at_most_.push_back(r.size());
  }
  for (const Fluent& f : task_.layout().fluents())
    if (!f.function) ++sizes_at_most_[f.symbol];
}

void Reachability::make_schema(Index schema) {
  const Action& action = task_.model().actions[schema];
  ActionSchema& of = task_.schema(schema);
  JoinedAction& s = schemas_[schema];
  for (const Query* q : conjuncts(action.precondition))
    if (is_atom(*q)) s.atoms.push_back(q);
  if (s.atoms.size() > kMostJoined) {  // those with variables, the others are tested
    std::stable_partition(s.atoms.begin(), s.atoms.end(), has_variables);
    s.atoms.resize(kMostJoined);
  }
  const std::set<const Query*> joined(s.atoms.begin(), s.atoms.end());
  for (const ActionSchema::Level& level : of.levels()) {
    s.candidate_of.emplace_back(task_.model().objects.size(), kNone);
    for (Index c = 0; c < level.candidates.size(); ++c)
      s.candidate_of.back()[level.candidates[c].object] = c;
  }
  const auto sort = [&](std::vector<ActionSchema::Check>& checks) {
    for (ActionSchema::Check& c : checks) {
      if (joined.contains(c.query)) continue;
      s.ordered.push_back(&c);
      if (!c.calls) s.rest.push_back(&c);
    }
  };
  sort(of.constant());
  for (ActionSchema::Level& level : of.levels()) sort(level.checks);
}

/// About how many atoms match, where these parameters are bound.
double Reachability::matches(const Query& atom, const std::vector<char>& bound) const {
  const Relation& r = relations_[atom.symbol];
  std::size_t free = 0;
  for (const Argument& a : atom.arguments) free += a.variable && !bound[a.index] ? 1 : 0;
  if (r.arity() == 0) return 1;
  return std::pow(static_cast<double>(sizes_at_most_[atom.symbol]),
                  static_cast<double>(free) / static_cast<double>(r.arity()));
}

/// Orders the atoms of a precondition: next comes what likely matches least.
void Reachability::make_rule(Index schema, const Query* trigger) {
  const JoinedAction& s = schemas_[schema];
  const std::size_t parameters = s.candidate_of.size();
  std::vector<char> bound(slots_.size(), 0);
  std::vector<ActionSchema::Check*> left = s.rest;
  std::vector<const Query*> atoms = s.atoms;
  JoinRule rule;
  rule.schema = schema;
  rule.trigger = trigger;
  const auto use = [&](const Query& atom) {
    for (const Argument& a : atom.arguments)
      if (a.variable) bound[a.index] = 1;
    atoms.erase(std::find(atoms.begin(), atoms.end(), &atom));
  };
  const auto checks = [&] {
    std::vector<ActionSchema::Check*> ready;
    std::erase_if(left, [&](ActionSchema::Check* c) {
      if (!std::all_of(c->slots.begin(), c->slots.end(), [&](Index i) { return bound[i] != 0; }))
        return false;
      ready.push_back(c);
      return true;
    });
    return ready;
  };
  if (trigger != nullptr) use(*trigger);
  rule.checks = checks();
  while (true) {
    const auto best =
        std::min_element(atoms.begin(), atoms.end(), [&](const Query* a, const Query* b) {
          // A rule without trigger joins constants alone: what has none comes first.
          const auto rank = [&](const Query* q) {
            const bool none = trigger == nullptr && relations_[q->symbol].size() == 0;
            return std::pair(none ? 0 : 1, matches(*q, bound));
          };
          return rank(a) < rank(b);
        });
    Join j;
    if (best != atoms.end()) {
      j.atom = *best;
      std::uint64_t positions = 0;
      bool all = true;
      for (std::size_t i = 0; i < j.atom->arguments.size(); ++i) {
        const Argument& a = j.atom->arguments[i];
        const bool known = !a.variable || bound[a.index];
        all &= known;
        if (known) positions |= std::uint64_t{1} << i;
      }
      if (!all) j.lookup = relations_[j.atom->symbol].lookup(positions);
      use(*j.atom);
    } else {
      const auto free = static_cast<std::size_t>(
          std::find(bound.begin(), bound.begin() + static_cast<std::ptrdiff_t>(parameters), 0) -
          bound.begin());
      if (free == parameters) break;
      j.parameter = static_cast<Index>(free);
      bound[free] = 1;
    }
    j.checks = checks();
    rule.joins.push_back(std::move(j));
  }
  if (trigger != nullptr) triggered_[trigger->symbol].push_back(static_cast<Index>(rules_.size()));
  rules_.push_back(std::move(rule));
}

void Reachability::mark(FactId f) {
  if (reached_[f]) return;
  reached_[f] = 1;
  queue_.push_back(f);
}

void Reachability::start() {
  const Layout& layout = task_.layout();
  for (Index i = 0; i < layout.fluents().size(); ++i) {
    const Fluent& f = layout.fluents()[i];
    mark(facts_.fact(i, f.get(task_.initial().data())));
    // What Kx or exclusions may reveal is taken for reachable.
    if (!f.groups.empty())
      for (Word c = 0; c < 4; ++c) mark(facts_.fact(i, c));
    if (f.exclusions != kNone)
      for (Word c = 0; c < layout.range_size(f) + kFirstValue; ++c) mark(facts_.fact(i, c));
  }
}

void Reachability::run() {
  for (const JoinRule& r : rules_)
    if (r.trigger == nullptr) apply(r, {});
  std::size_t next = 0, layer_end = queue_.size();
  do {
    while (next < queue_.size()) {
      if (next == layer_end) {
        layer_end = queue_.size();
        ++layer_;
      }
      take(queue_[next++]);
    }
  } while (again());
}

/// A fact joins those that were reached before.
void Reachability::take(FactId fact) {
  const Index fluent = facts_.fluent_of(fact);
  const Fluent& f = task_.layout().fluents()[fluent];
  const Word content = facts_.content_of(fact);
  if (content == (f.function ? kValueSensed : static_cast<Word>(AtomKnowledge::Whether))) {
    const Word count = f.function ? task_.layout().range_size(f) + kFirstValue : 3;
    for (Word c = f.function ? kFirstValue : 1; c < count; ++c) mark(facts_.fact(fluent, c));
  }
  if (f.function || content != static_cast<Word>(AtomKnowledge::True)) return;
  taken_[fluent] = 1;
  relations_[f.symbol].add(f.arguments);
  for (const Index r : triggered_[f.symbol]) apply(rules_[r], f.arguments);
}

void Reachability::apply(const JoinRule& rule, const std::vector<Index>& arguments) {
  if ((rule.trigger == nullptr || match(schemas_[rule.schema], *rule.trigger, arguments.data())) &&
      consistent(rule.schema, rule.checks))
    join(rule, 0);
  unbind(0);
}

void Reachability::join(const JoinRule& rule, std::size_t depth) {
  if (depth == rule.joins.size()) {
    instance(rule.schema);
    return;
  }
  const Join& j = rule.joins[depth];
  const JoinedAction& schema = schemas_[rule.schema];
  const std::size_t mark = trail_.size();
  if (j.atom == nullptr) {
    for (const ActionSchema::Candidate& c :
         task_.schema(rule.schema).levels()[j.parameter].candidates) {
      limits_.work();
      if (bind(schema, j.parameter, c.object) && consistent(rule.schema, j.checks))
        join(rule, depth + 1);
      unbind(mark);
    }
    return;
  }
  if (j.lookup == kNone) {
    if (holds(*j.atom) && consistent(rule.schema, j.checks)) join(rule, depth + 1);
    return;
  }
  std::vector<Index> wanted;  // what is not bound is not looked up by
  for (const Argument& a : j.atom->arguments) wanted.push_back(value_of(a, slots_.data()));
  const Relation& relation = relations_[j.atom->symbol];
  const std::vector<Index>* const found = relation.find(j.lookup, wanted.data());
  if (found == nullptr) return;
  for (const Index i : *found) {
    limits_.work();
    if (match(schema, *j.atom, relation.atom(i)) && consistent(rule.schema, j.checks))
      join(rule, depth + 1);
    unbind(mark);
  }
}

bool Reachability::bind(const JoinedAction& schema, Index parameter, Index object) {
  if (schema.candidate_of[parameter][object] == kNone) return false;
  slots_[parameter] = object;
  bound_[parameter] = 1;
  trail_.push_back(parameter);
  return true;
}

void Reachability::unbind(std::size_t mark) {
  for (; trail_.size() > mark; trail_.pop_back()) bound_[trail_.back()] = 0;
}

/// Binds the atom's variables. @return whether these can be its arguments.
bool Reachability::match(const JoinedAction& schema, const Query& atom, const Index* arguments) {
  for (std::size_t i = 0; i < atom.arguments.size(); ++i) {
    const Argument& a = atom.arguments[i];
    if (a.variable && !bound_[a.index]) {
      if (!bind(schema, a.index, arguments[i])) return false;
    } else if (value_of(a, slots_.data()) != arguments[i]) {
      return false;
    }
  }
  return true;
}

bool Reachability::holds(const Query& atom) const {
  std::vector<Index> arguments;
  for (const Argument& a : atom.arguments) arguments.push_back(value_of(a, slots_.data()));
  const Layout::Field field = task_.layout().atom(atom.symbol, arguments.data());
  if (!field.exists) return false;
  if (field.fluent == kNone) return field.atom == AtomKnowledge::True;
  return taken_[field.fluent] != 0;
}

/// false: one of them never holds.
bool Reachability::consistent(Index schema, const std::vector<ActionSchema::Check*>& checks) {
  return std::none_of(checks.begin(), checks.end(), [&](ActionSchema::Check* c) {
    return task_.schema(schema).grounded(*c, slots_.data()) == kFalse;
  });
}

/// What is no atom. External functions come last: those of instances that nothing else rules out.
Reachability::Verdict Reachability::test(Index schema) {
  ActionSchema& of = task_.schema(schema);
  const JoinedAction& s = schemas_[schema];
  for (std::size_t p = 0; p < s.candidate_of.size(); ++p)
    if (!possible(of.levels()[p].candidates[s.candidate_of[p][slots_[p]]].full, true))
      return Verdict::NotYet;
  for (ActionSchema::Check* c : s.ordered) {
    const Formula f = of.grounded(*c, slots_.data());
    if (f == kFalse) return Verdict::Never;
    if (!possible(f, true)) return Verdict::NotYet;
  }
  return Verdict::Reached;
}

/// All parameters are bound.
void Reachability::instance(Index schema) {
  const std::vector<Index> arguments(
      slots_.begin(),
      slots_.begin() + static_cast<std::ptrdiff_t>(schemas_[schema].candidate_of.size()));
  const Verdict v = test(schema);
  if (v == Verdict::Reached) act(task_.action_id(schema, arguments));
  if (v != Verdict::NotYet) return;
  limits_.work(sizeof(Pending) + arguments.size() * sizeof(Index));
  pending_.push_back({schema, arguments});
}

void Reachability::act(OperatorId step) {
  if (step >= acted_.size()) {
    acted_.resize(step + 1, 0);
    layer_of_.resize(step + 1, 0);
  }
  if (acted_[step]) return;
  acted_[step] = 1;
  layer_of_[step] = layer_;
  actions_.push_back(step);
  for (Index e = 0; e < task_.action(step).effects.size(); ++e)
    if (!act(step, e)) pending_effects_.emplace_back(step, e);
}

bool Reachability::act(OperatorId step, Index effect) {
  const ConditionalEffect& e = task_.action(step).effects[effect];
  if (!possible(e.condition, true)) return false;
  for (const FactId f : facts_.added(e)) mark(f);
  return true;
}

/// What has become possible since. @return whether more facts are reached so.
bool Reachability::again() {
  const std::size_t before = queue_.size();
  std::erase_if(pending_effects_, [&](const auto& e) { return act(e.first, e.second); });
  std::vector<Pending> left;
  for (Pending& p : std::exchange(pending_, {})) {
    limits_.work();
    std::copy(p.arguments.begin(), p.arguments.end(), slots_.begin());
    const Verdict v = test(p.schema);
    if (v == Verdict::Reached) act(task_.action_id(p.schema, p.arguments));
    if (v == Verdict::NotYet) left.push_back(std::move(p));
  }
  pending_ = std::move(left);
  return queue_.size() > before;
}

/// Whether what was answered leaves a value possible, where fluents have contents that are reached:
/// from a node of the answers on.
bool Reachability::may_answer(Index node) const {
  const AnswerTree& answers = task_.calls().answers();
  if (node == kNone) return true;
  if (AnswerTree::is_leaf(node)) {
    const AnswerTree::Leaf leaf = answers.leaf(AnswerTree::leaf_number(node));
    return leaf.kind == Answer::Kind::Value ||
           (leaf.kind == Answer::Kind::NotFound &&
            (answers_ != Answers::AsFound || leaf.attempts < task_.calls().attempts()));
  }
  const Index item = answers.reads(node);
  if (is_call(item)) return true;
  const Fluent& f = task_.layout().fluents()[item];
  const Word sensed = f.function ? kValueSensed : static_cast<Word>(AtomKnowledge::Whether);
  for (Word c = 0; c < facts_.contents(item); ++c) {
    // What is sensed is decided before it is read; so decided, it is reached as well.
    if (c == sensed || !reached(facts_.fact(item, c))) continue;
    const bool any_handle = f.handle && c + 1 == facts_.contents(item);
    if (any_handle || may_answer(answers.child(node, static_cast<Index>(c)))) return true;
  }
  return false;
}

bool Reachability::may_have_value(Index call) const {
  if (asked_.insert(call).second) task_.calls().ask_early(call, task_.initial().data());
  return may_answer(task_.calls().answers_of(call));
}

bool Reachability::possible(Formula f, bool positive) const {
  const FormulaPool& pool = task_.pool();
  const FormulaPool::Node& n = pool.node(f);
  switch (n.kind) {
    case Kind::False:
      return !positive;
    case Kind::True:
      return positive;
    case Kind::Xor:
    case Kind::Bits:
    case Kind::Derived:
      return true;
    case Kind::External:
      return !positive || (n.a != without_ && (answers_ == Answers::Any || may_have_value(n.a)));
    case Kind::Not:
      return possible(*pool.begin(f), !positive);
    case Kind::And:
    case Kind::Or:
      if ((n.kind == Kind::And) == positive)
        return std::all_of(pool.begin(f), pool.end(f),
                           [&](Formula c) { return possible(c, positive); });
      return std::any_of(pool.begin(f), pool.end(f),
                         [&](Formula c) { return possible(c, positive); });
    default: {
      bool always = false;
      const std::vector<FactId> any = facts_.leaf_contents(n, positive, always);
      return always || std::any_of(any.begin(), any.end(), [&](FactId x) { return reached(x); });
    }
  }
}

}  // namespace kaboum::plan
