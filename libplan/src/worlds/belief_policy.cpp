// Policies over beliefs. What an entry requires is regressed from its successors, world by world: a
// belief is fit for it if each of its worlds, executed alone, gets through.
#include "worlds/belief_policy.h"

#include <algorithm>

#include "task/knowledge.h"

namespace kaboum::plan::worlds {
namespace {

using Kind = Condition::Kind;

void insert(std::vector<Index>& sorted, Index value) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  if (at == sorted.end() || *at != value) sorted.insert(at, value);
}

const Requirement::Component* find(const Requirement& r, Index component) {
  for (const Requirement::Component& c : r.components)
    if (c.component == component) return &c;
  return nullptr;
}

}  // namespace

BeliefPolicy::BeliefPolicy(BeliefSpace& space, const Model& model) : space_(space), model_(model) {
  const WorldTask& task = space.task();
  for (const Operator& o : task.operators) {
    std::vector<Word> writes(task.common_words, 0);
    for (const Step& s : o.steps) {
      const Variable& v = task.variables[s.variable];
      if (!v.hidden && s.kind == Step::Kind::Set && s.known.kind == Kind::True &&
          s.world.kind == Kind::True)
        writes[v.word] |= v.mask << v.shift;
    }
    operator_writes_.push_back(std::move(writes));
  }
}

/// All that a condition reads.
void BeliefPolicy::read(const Condition& c, Requirement& common,
                        std::vector<Index>& components) const {
  if (c.kind >= Kind::Is) {
    const Variable& v = space_.task().variables[c.variable];
    if (v.hidden)
      insert(components, v.component);
    else
      common.common[v.word] |= v.mask << v.shift;
  }
  for (const Condition& child : c.children) read(child, common, components);
}

/// @pre the condition holds in the belief.
void BeliefPolicy::explain(const Condition& c, const Word* belief, Requirement& out,
                           Reasons& reasons) const {
  switch (c.kind) {
    case Kind::True:
    case Kind::False:
      return;
    case Kind::And:
      for (const Condition& child : c.children) explain(child, belief, out, reasons);
      return;
    case Kind::Or:
      for (const Condition& child : c.children)
        if (space_.holds(child, belief)) {
          explain(child, belief, out, reasons);
          return;
        }
      return;
    case Kind::Is:
    case Kind::IsNot:
      if (space_.task().variables[c.variable].hidden) {
        reasons.literals.push_back(&c);
        return;
      }
      [[fallthrough]];
    case Kind::Xor:
    case Kind::Not:
    case Kind::Decided:
    case Kind::Whether:
      read(c, out, reasons.exact);
      return;
  }
}

/// Components of which something is required.
std::vector<Index> BeliefPolicy::involved(const Entry& e, const Reasons& reasons) const {
  const WorldTask& task = space_.task();
  std::vector<Index> all = reasons.exact;
  for (const Condition* c : reasons.literals) insert(all, task.variables[c->variable].component);
  for (const Case& c : e.cases) {
    for (const auto& [v, value] : c.sensed) insert(all, task.variables[v].component);
    for (const auto& later : entries_[c.next].required.components) insert(all, later.component);
  }
  return all;
}

bool BeliefPolicy::is_good(const Entry& e, const Word* belief, const Reasons& reasons,
                           Index component, Index world) {
  const WorldTask& task = space_.task();
  const Word* before = space_.sets(component).contents(world);
  for (const Condition* c : reasons.literals) {
    const Variable& v = task.variables[c->variable];
    if (v.component == component && (v.get(before) == c->value) != (c->kind == Kind::Is))
      return false;
  }
  if (e.op == kNone) return true;
  const Operator& o = task.operators[e.op];
  const bool changes = std::any_of(o.steps.begin(), o.steps.end(), [&](const Step& s) {
    return s.kind != Step::Kind::Sense && task.variables[s.variable].component == component;
  });
  const std::vector<Index> after =
      changes ? space_.apply_in(o, belief, component, world) : std::vector<Index>{world};
  for (const Index w : after) {
    bool some = false;
    for (const Case& c : e.cases) {
      const bool here = std::all_of(c.sensed.begin(), c.sensed.end(), [&](const auto& sensed) {
        const Variable& v = task.variables[sensed.first];
        return v.component != component ||
               v.get(space_.sets(component).contents(w)) == sensed.second;
      });
      if (!here) continue;
      some = true;
      const auto* later = worlds::find(entries_[c.next].required, component);
      if (later != nullptr && !later->admits(w)) return false;
    }
    if (!some) return false;
  }
  return true;
}

Requirement::Component BeliefPolicy::good_worlds(const Entry& e, const Word* belief,
                                                 const Reasons& reasons, Index component) {
  Requirement::Component made;
  made.component = component;
  const auto exact = [&](const Case& c) {
    const auto* later = worlds::find(entries_[c.next].required, component);
    return later != nullptr && later->exactly != kNone;
  };
  const Index set = space_.set_of(component, belief);
  if (std::binary_search(reasons.exact.begin(), reasons.exact.end(), component) ||
      std::any_of(e.cases.begin(), e.cases.end(), exact)) {
    made.exactly = set;
    return made;
  }
  const Index all = space_.sets(component).size();
  made.good.assign((all + 63) / 64, 0);
  const auto admit = [&](Index w) { made.good[w / 64] |= Word{1} << (w % 64); };
  for (const Index w : space_.sets(component).members(set)) admit(w);
  if (all <= kMostWorlds)
    for (Index w = 0; w < all; ++w)
      if (!made.admits(w) && is_good(e, belief, reasons, component, w)) admit(w);
  return made;
}

Index BeliefPolicy::end(const Word* belief) {
  Entry e;
  e.required.common.assign(space_.task().common_words, 0);
  Reasons reasons;
  explain(space_.task().goal, belief, e.required, reasons);
  return enter(std::move(e), belief, reasons);
}

Index BeliefPolicy::add(const Word* belief, Index op, std::vector<Case> cases) {
  const WorldTask& task = space_.task();
  const Operator& o = task.operators[op];
  Entry e;
  e.op = op;
  e.cases = std::move(cases);
  e.required.common.assign(task.common_words, 0);
  Reasons reasons;
  explain(o.precondition, belief, e.required, reasons);
  for (const Step& s : o.steps) {
    read(s.known, e.required, reasons.exact);
    std::vector<Index> ignored;
    read(s.world, e.required, ignored);
    if (s.kind == Step::Kind::Rule || s.kind == Step::Kind::OneOf)
      insert(reasons.exact, task.variables[s.variable].component);
  }
  for (const Case& c : e.cases)
    for (std::size_t i = 0; i < e.required.common.size(); ++i)
      e.required.common[i] |= entries_[c.next].required.common[i] & ~operator_writes_[op][i];
  return enter(std::move(e), belief, reasons);
}

Index BeliefPolicy::enter(Entry e, const Word* belief, const Reasons& reasons) {
  for (const Index component : involved(e, reasons)) {
    e.required.components.push_back(good_worlds(e, belief, reasons, component));
    bytes_ += e.required.components.back().good.size() * sizeof(Word) + 64;
  }
  bytes_ += sizeof(Entry) + e.cases.size() * 64;
  entries_.push_back(std::move(e));
  const auto number = static_cast<Index>(entries_.size() - 1);
  learn(number, belief);
  return number;
}

bool BeliefPolicy::admits(const Requirement& r, const Word* belief) const {
  return std::all_of(r.components.begin(), r.components.end(), [&](const auto& c) {
    const Index set = space_.set_of(c.component, belief);
    if (c.exactly != kNone) return c.exactly == set;
    const WorldSets::Members m = space_.sets(c.component).members(set);
    return std::all_of(m.begin(), m.end(), [&](Index w) { return c.admits(w); });
  });
}

std::uint64_t BeliefPolicy::key(const std::vector<Word>& mask, const Word* belief) const {
  std::uint64_t h = 0;
  for (std::size_t i = 0; i < mask.size(); ++i)
    h ^= word_hash(static_cast<Index>(i), belief[i] & mask[i]);
  return h;
}

Index BeliefPolicy::find(const Word* belief) {
  for (const Pattern& p : patterns_) {
    const auto found = p.entries.find(key(p.mask, belief));
    if (found == p.entries.end()) continue;
    for (const auto& [values, entry] : found->second) {
      bool agrees = true;
      for (std::size_t i = 0; i < p.mask.size(); ++i)
        agrees &= (belief[i] & p.mask[i]) == values[i];
      if (agrees && admits(entries_[entry].required, belief)) return entry;
    }
  }
  return space_.holds(space_.task().goal, belief) ? end(belief) : kNone;
}

void BeliefPolicy::learn(Index entry, const Word* belief) {
  const Requirement& r = entries_[entry].required;
  const auto [known, fresh] = pattern_number_.emplace(r.common, patterns_.size());
  if (fresh) {
    if (patterns_.size() >= kMostPatterns) {
      pattern_number_.erase(known);
      return;
    }
    patterns_.push_back({r.common, {}});
  }
  auto& alike = patterns_[known->second].entries[key(r.common, belief)];
  if (alike.size() >= kMostAlike) alike.erase(alike.begin());
  std::vector<Word> values;
  for (std::size_t i = 0; i < r.common.size(); ++i) values.push_back(belief[i] & r.common[i]);
  alike.emplace_back(std::move(values), entry);
}

/// Makes `node` branch on what the cases from `from` to `to` sense next.
void BeliefPolicy::branch_at(const std::vector<Case>& cases, std::size_t from, std::size_t to,
                             std::size_t depth, const std::vector<Index>& nodes, Plan& plan,
                             Index node) const {
  if (to - from == 1) {
    plan.nodes[node].next = nodes[cases[from].next];
    return;
  }
  const Variable& v = space_.task().variables[cases[from].sensed.at(depth).first];
  Plan::Branch b;
  b.function = v.function;
  b.symbol = v.symbol;
  b.arguments = v.arguments;
  for (std::size_t i = from; i < to;) {
    std::size_t end = i + 1;
    const Index value = cases[i].sensed[depth].second;
    while (end < to && cases[end].sensed[depth].second == value) ++end;
    const Index named =
        v.function ? model_.types[model_.functions[v.symbol].range].objects[value] : value;
    b.cases.push_back({named, branch(cases, i, end, depth + 1, nodes, plan)});
    i = end;
  }
  plan.nodes[node].branches = true;
  plan.nodes[node].branch = std::move(b);
}

Index BeliefPolicy::branch(const std::vector<Case>& cases, std::size_t from, std::size_t to,
                           std::size_t depth, const std::vector<Index>& nodes, Plan& plan) const {
  if (to - from == 1) return nodes[cases[from].next];
  const auto node = static_cast<Index>(plan.nodes.size());
  plan.nodes.emplace_back();
  branch_at(cases, from, to, depth, nodes, plan, node);
  return node;
}

Plan BeliefPolicy::plan(const std::vector<Case>& start) const {
  // Entries come after those that they lead to; so the needed ones are numbered from the start.
  std::vector<char> needed(entries_.size(), 0);
  for (const Case& c : start) needed[c.next] = 1;
  for (std::size_t e = entries_.size(); e-- > 0;)
    if (needed[e] != 0)
      for (const Case& c : entries_[e].cases) needed[c.next] = 1;
  Plan plan;
  std::vector<Index> nodes(entries_.size(), kNone);
  for (std::size_t e = entries_.size(); e-- > 0;) {
    if (needed[e] == 0 || entries_[e].op == kNone) continue;
    nodes[e] = static_cast<Index>(plan.nodes.size());
    Plan::Node n;
    n.acts = true;
    const Operator& o = space_.task().operators[entries_[e].op];
    n.action = {o.schema, o.arguments};
    plan.nodes.push_back(std::move(n));
  }
  for (std::size_t e = entries_.size(); e-- > 0;)
    if (nodes[e] != kNone)
      branch_at(entries_[e].cases, 0, entries_[e].cases.size(), 0, nodes, plan, nodes[e]);
  plan.root = branch(start, 0, start.size(), 0, nodes, plan);
  return plan;
}

}  // namespace kaboum::plan::worlds
