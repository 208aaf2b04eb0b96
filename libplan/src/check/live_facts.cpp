// Liveness of facts, from the ends of the plan back to its root.
#include "check/live_facts.h"

#include <algorithm>
#include <cstddef>

namespace kaboum::plan {
namespace {

/// A set of small numbers.
class BitSet {
 public:
  explicit BitSet(std::size_t size = 0) : words_((size + kBits - 1) / kBits, 0) {}
  void insert(std::size_t i) { words_[i / kBits] |= bit(i); }
  [[nodiscard]] bool contains(std::size_t i) const { return (words_[i / kBits] & bit(i)) != 0; }
  void insert(const BitSet& other) {
    for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.words_[w];
  }

 private:
  static constexpr std::size_t kBits = 64;
  static std::uint64_t bit(std::size_t i) { return std::uint64_t{1} << (i % kBits); }
  std::vector<std::uint64_t> words_;
};

/// Facts of a plan, numbered.
class FactNumbers {
 public:
  std::size_t add(const Fact& f) {
    const auto [at, fresh] = numbers_.try_emplace(f, facts_.size());
    if (fresh) facts_.push_back(&at->first);
    return at->second;
  }
  void add(const std::set<Fact>& facts) {
    for (const Fact& f : facts) add(f);
  }
  [[nodiscard]] std::size_t size() const { return facts_.size(); }
  void insert(const std::set<Fact>& facts, BitSet& into) {
    for (const Fact& f : facts) into.insert(add(f));
  }
  [[nodiscard]] bool meets(const std::set<Fact>& facts, const BitSet& set) {
    return std::ranges::any_of(facts, [&](const Fact& f) { return set.contains(add(f)); });
  }
  void list(const BitSet& set, std::set<Fact>& into) const {
    for (std::size_t i = 0; i < facts_.size(); ++i)
      if (set.contains(i)) into.insert(*facts_[i]);
  }

 private:
  std::map<Fact, std::size_t> numbers_;
  std::vector<const Fact*> facts_;
};

bool asks_external(const Query& q) {
  return q.kind == Query::Kind::External || q.kind == Query::Kind::Let ||
         std::ranges::any_of(q.children, asks_external);
}

void add_bound(const Query& q, std::set<Index>& slots) {
  if (q.kind == Query::Kind::Let) slots.insert(q.value->index);
  for (const Query& c : q.children) add_bound(c, slots);
}

bool names(const Argument& a, const std::set<Index>& slots) {
  if (a.term)
    return std::ranges::any_of(a.term->arguments,
                               [&](const Argument& b) { return names(b, slots); });
  return a.variable && slots.contains(a.index);
}

bool names(const Query& q, const std::set<Index>& slots) {
  return (q.value && names(*q.value, slots)) ||
         std::ranges::any_of(q.arguments, [&](const Argument& a) { return names(a, slots); }) ||
         std::ranges::any_of(q.children, [&](const Query& c) { return names(c, slots); });
}

/// Whether it holds in no two ways: what holds says then what is known of what it reads.
bool is_literal(const Query& q) {
  return q.kind == Query::Kind::Known || q.kind == Query::Kind::KnownValue ||
         q.kind == Query::Kind::Same || q.kind == Query::Kind::True || q.kind == Query::Kind::False;
}

std::vector<Index> successors(const Plan::Node& node) {
  std::vector<Index> next;
  if (!node.branches) next.push_back(node.next);
  for (const Plan::Branch::Case& c : node.branch.cases) next.push_back(c.next);
  return next;
}

/// Whether it leaves out worlds, by the value of its fact.
bool observes(const Update& u) {
  using D = Update::Database;
  if (!u.add) return false;
  return u.database == D::Kw || u.database == D::Kv || u.database == D::Lcw ||
         (u.database == D::Kf && u.literals[0].function && u.literals[0].negated);
}

}  // namespace

Fact branch_fact(const Plan::Branch& b) {
  Fact f = {b.function ? Index{1} : Index{0}, b.symbol};
  f.insert(f.end(), b.arguments.begin(), b.arguments.end());
  return f;
}

std::vector<Index> bind(const Action& a, const PlanAction& action) {
  std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
  std::copy(action.arguments.begin(), action.arguments.end(), slots.begin());
  return slots;
}

LiveFacts::LiveFacts(const Model& model, const Plan& plan, const QueryEvaluator& evaluator,
                     Sensing sensing)
    : model_(model), evaluator_(evaluator), sensing_(sensing) {
  Part goal;
  std::vector<Index> slots(std::max<Index>(model.goal_slots, 1), 0);
  read_query(model.goal, slots, {}, goal);
  std::map<std::pair<Index, std::vector<Index>>, Part> actions;
  std::vector<const Part*> parts(plan.nodes.size(), nullptr);
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const Plan::Node& node = plan.nodes[n];
    if (!node.acts) continue;
    const auto [at, fresh] =
        actions.try_emplace(std::pair(node.action.schema, node.action.arguments));
    if (fresh) read_action(node.action, at->second);
    parts[n] = &at->second;
  }
  FactNumbers facts;
  const auto number = [&](const Part& p) {
    facts.add(p.always);
    facts.add(p.changed);
  };
  number(goal);
  for (const auto& [action, part] : actions) number(part);
  for (const Condition& c : conditions_) facts.add(c.facts);
  for (const Plan::Node& node : plan.nodes)
    if (node.branches) facts.add(branch_fact(node.branch));
  const std::set<Fact> unsure = unsure_at_start();
  facts.add(unsure);

  /// What a node and all that may follow it do.
  struct Sets {
    BitSet always, changed, conditions;
    bool all = false;
  };
  const auto with = [&](const Part& part, Sets& sets) {
    facts.insert(part.always, sets.always);
    facts.insert(part.changed, sets.changed);
    for (const Index c : part.conditions) sets.conditions.insert(c);
    sets.all |= part.all;
  };
  const Sets nothing{BitSet(facts.size()), BitSet(facts.size()), BitSet(conditions_.size())};
  Sets at_end = nothing;
  with(goal, at_end);
  std::vector<Sets> sets(plan.nodes.size(), nothing);
  const std::vector<Index> nodes = order(plan);
  for (const Index n : nodes) {
    const Plan::Node& node = plan.nodes[n];
    for (const Index m : successors(node)) {
      const Sets& below = m == kNone ? at_end : sets[m];
      sets[n].always.insert(below.always);
      sets[n].changed.insert(below.changed);
      sets[n].conditions.insert(below.conditions);
      sets[n].all |= below.all;
    }
    if (node.branches) sets[n].always.insert(facts.add(branch_fact(node.branch)));
    if (parts[n] != nullptr) with(*parts[n], sets[n]);
  }
  // What no two states differ in needs no looking at.
  BitSet differs = plan.root == kNone ? nothing.changed : sets[plan.root].changed;
  facts.insert(unsure, differs);
  const auto finish = [&](const Sets& s, Reads& reads, Future& future) {
    reads.all = s.all;
    BitSet always = s.always, read = s.always;
    for (Index c = 0; c < conditions_.size(); ++c) {
      if (!s.conditions.contains(c)) continue;
      const std::set<Fact>& of = conditions_[c].facts;
      facts.insert(of, read);
      if (facts.meets(of, differs) && !facts.meets(of, s.changed))
        future.open.push_back(c);
      else
        facts.insert(of, always);
    }
    facts.list(read, reads.facts);
    if (!future.open.empty()) facts.list(always, future.always);
  };
  finish(at_end, goal_, end_);
  by_node_.resize(plan.nodes.size());
  futures_.resize(plan.nodes.size());
  for (const Index n : nodes) finish(sets[n], by_node_[n], futures_[n]);
}

/// Nodes, each after all that may follow it.
std::vector<Index> LiveFacts::order(const Plan& plan) const {
  std::vector<Index> order;
  std::vector<char> done(plan.nodes.size(), 0);
  // Acyclic: repeat over a stack until successors are done.
  std::vector<Index> stack;
  if (plan.root != kNone) stack.push_back(plan.root);
  while (!stack.empty()) {
    const Index n = stack.back();
    bool ready = true;
    for (const Index m : successors(plan.nodes[n]))
      if (m != kNone && !done[m]) {
        stack.push_back(m);
        ready = false;
      }
    if (!ready) continue;
    stack.pop_back();
    if (done[n]) continue;
    done[n] = 1;
    order.push_back(n);
  }
  return order;
}

/// Facts in which states differ from the start.
std::set<Fact> LiveFacts::unsure_at_start() const {
  std::set<Fact> facts;
  const std::vector<Index> none;
  for (const Update& u : model_.initial)
    if (u.database != Update::Database::Kf && u.database != Update::Database::Lcw)
      for (const Update::Literal& l : u.literals)
        facts.insert(fact(l.function, l.symbol, l.arguments, none));
  return facts;
}

void LiveFacts::read_action(const PlanAction& action, Part& part) {
  const Action& a = model_.actions[action.schema];
  std::vector<Index> slots = bind(a, action);
  std::set<Index> bound;
  add_bound(a.precondition, bound);
  read_query(a.precondition, slots, bound, part);
  for (const Effect& e : a.effects) read_effect(e, slots, part);
}

/// @param bound  slots that external functions give their values.
void LiveFacts::read_query(const Query& q, std::vector<Index>& slots, const std::set<Index>& bound,
                           Part& part) {
  if (q.kind == Query::Kind::And) {
    for (const Query& c : q.children) read_query(c, slots, bound, part);
    return;
  }
  if (q.kind == Query::Kind::ForAll) {
    for (const Index o : model_.types[q.type].objects) {
      slots.at(q.symbol) = o;
      read_query(q.children[0], slots, bound, part);
    }
    return;
  }
  if (is_literal(q) || asks_external(q) || names(q, bound)) {
    part.all |= !evaluator_.reads(q, slots, part.always);
    return;
  }
  const auto [at, fresh] =
      numbers_.try_emplace({&q, slots}, static_cast<Index>(conditions_.size()));
  if (fresh) conditions_.push_back({&q, slots, {}});
  part.all |= !evaluator_.reads(q, slots, conditions_[at->second].facts);
  part.conditions.insert(at->second);
}

void LiveFacts::read_effect(const Effect& e, std::vector<Index>& slots, Part& part) const {
  if (e.kind == Effect::Kind::When) part.all |= !evaluator_.reads(e.condition, slots, part.always);
  if (e.kind == Effect::Kind::Update) {
    const Update& u = e.update;
    if (const auto& value = u.literals[0].value; value && value->term)
      part.always.insert(fact(true, value->term->function, value->term->arguments, slots));
    // A disjunction combines with what is known of its atoms by then.
    const bool reads =
        u.database == Update::Database::Kx || (sensing_ == Sensing::Reads && observes(u));
    for (const Update::Literal& l : u.literals) {
      const Fact f = fact(l.function, l.symbol, l.arguments, slots);
      part.changed.insert(f);
      if (reads) part.always.insert(f);
    }
  }
  if (e.kind == Effect::Kind::ForAll) {
    for (const Index o : model_.types[e.type].objects) {
      slots.at(e.slot) = o;
      for (const Effect& c : e.children) read_effect(c, slots, part);
    }
    return;
  }
  for (const Effect& c : e.children) read_effect(c, slots, part);
}

bool LiveFacts::is_settled(const Condition& c, const RuntimeKnowledge& k,
                           const std::set<Fact>& tied) const {
  const auto undecided = [&](const Fact& f) { return tied.contains(f) || k.is_open(f); };
  if (std::ranges::any_of(c.facts, undecided)) return false;
  std::vector<Index> slots = c.slots;
  return evaluator_.holds(*c.query, slots, k);
}

LiveFacts::Residue LiveFacts::residue(Index node, RuntimeKnowledge k,
                                      const std::set<Fact>& asked) const {
  Residue residue;
  if (at(node).all) {
    residue.state = std::move(k);
    return residue;
  }
  const Future& future = node == kNone ? end_ : futures_[node];
  std::set<Fact> keep = future.open.empty() ? at(node).facts : future.always;
  if (!future.open.empty()) {
    const std::set<Fact> tied = k.tied();
    for (const Index c : future.open) {
      const Condition& condition = conditions_[c];
      if (is_settled(condition, k, tied))
        residue.settled.push_back(c);
      else
        keep.insert(condition.facts.begin(), condition.facts.end());
    }
  }
  keep.insert(asked.begin(), asked.end());
  k.restrict_to(keep);
  residue.state = std::move(k);
  return residue;
}

}  // namespace kaboum::plan
