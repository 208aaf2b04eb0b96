// Grounding of rules. Conjuncts of a body are taken out of the quantifiers whose variable they do
// not name (miniscoping), so that static ones cut an enumeration short.
#include "task/rule_grounder.h"

#include <algorithm>

#include "task/bindings.h"
#include "task/query_grounder.h"

namespace kaboum::plan {
namespace {

/// Nodes of a formula, counted as often as they occur, up to which it stands for its atom.
constexpr std::size_t kLargest = 2000;
/// Predicates one in the rules of the other that are spelled out.
constexpr unsigned kDeepest = 16;

Query narrowed(Query q) {
  using K = Query::Kind;
  for (Query& c : q.children) c = narrowed(std::move(c));
  if (q.kind != K::Exists && q.kind != K::ForAll) return q;
  // exists x (a & b(x)) = a & exists x b(x), forall x (a | b(x)) = a | forall x b(x), also where
  // there is no object.
  const K inner = q.kind == K::Exists ? K::And : K::Or;
  if (q.children[0].kind != inner) return q;
  Query out, left;
  out.kind = left.kind = inner;
  for (Query& c : q.children[0].children) {
    const std::vector<Index> free = free_slots(c);
    (std::ranges::find(free, q.symbol) == free.end() ? out : left).children.push_back(std::move(c));
  }
  q.children = {std::move(left)};
  out.children.push_back(std::move(q));
  return out;
}

void derived_in(const Query& q, std::vector<Index>& out) {
  if (q.kind == Query::Kind::Derived) out.push_back(q.symbol);
  for (const Query& c : q.children) derived_in(c, out);
}

}  // namespace

RuleGrounder::RuleGrounder(const Model& model, Limits& limits, FormulaPool& pool,
                           DerivedAtoms& atoms)
    : model_(model),
      limits_(limits),
      pool_(pool),
      atoms_(atoms),
      rules_(model.predicates.size()),
      named_(model.predicates.size(), 0),
      formulas_(model.predicates.size()) {
  std::vector<Index> order;
  for (Index p = 0; p < model.predicates.size(); ++p)
    if (model.predicates[p].derived()) order.push_back(p);
  std::ranges::sort(order, {}, [&](Index p) { return model.predicates[p].level; });
  for (const Rule& r : model.rules) {
    rules_[r.predicate].push_back(r);
    rules_[r.predicate].back().body = narrowed(r.body);
  }
  std::vector<unsigned> depth(model.predicates.size(), 0);
  for (const Index p : order) {
    std::vector<Index> below;
    for (const Rule& r : rules_[p]) derived_in(r.body, below);
    for (const Index b : below) depth[p] = std::max(depth[p], named_[b] ? 1 : depth[b] + 1);
    named_[p] = model.predicates[p].recursive || depth[p] > kDeepest ? 1 : 0;
  }
}

Formula RuleGrounder::atom(Index predicate, const std::vector<Index>& objects,
                           QueryGrounder& queries) {
  const auto known = formulas_[predicate].find(objects);
  if (known != formulas_[predicate].end()) return known->second;
  constexpr std::size_t kEntry = 64;
  limits_.work(kEntry + objects.size() * sizeof(Index));
  const Symbol& symbol = model_.predicates[predicate];
  Formula f = kFalse;
  if (named_[predicate]) {
    const Index atom = atoms_.add(symbol.level, symbol.recursive);
    f = formulas_[predicate][objects] = pool_.derived(atom);
    pending_.push_back({atom, predicate, objects});
    define_pending(queries);
    return f;
  }
  f = body(predicate, objects, queries);
  if (is_large(f)) {
    const Index atom = atoms_.add(symbol.level, false);
    atoms_.define(atom, f);
    f = pool_.derived(atom);
  }
  return formulas_[predicate][objects] = f;
}

/// Not within one another: chains of rules may be long.
void RuleGrounder::define_pending(QueryGrounder& queries) {
  if (defining_) return;
  defining_ = true;
  while (!pending_.empty()) {
    const Pending p = std::move(pending_.back());
    pending_.pop_back();
    atoms_.define(p.atom, body(p.predicate, p.objects, queries));
  }
  defining_ = false;
}

Formula RuleGrounder::body(Index predicate, const std::vector<Index>& objects,
                           QueryGrounder& queries) {
  std::vector<Formula> any;
  for (const Rule& r : rules_[predicate]) {
    bool fits = true;
    for (std::size_t i = 0; i < objects.size(); ++i)
      fits = fits && model_.is_a(objects[i], r.parameters[i]);
    if (!fits) continue;
    std::vector<Index> slots(std::max<Index>(r.slots, 1), 0);
    std::ranges::copy(objects, slots.begin());
    any.push_back(queries.ground(r.body, slots));
    if (any.back() == kTrue) return kTrue;
  }
  return pool_.any(any);
}

bool RuleGrounder::is_large(Formula f) const {
  std::vector<Formula> todo = {f};
  for (std::size_t nodes = 1; !todo.empty(); ++nodes) {
    if (nodes > kLargest) return true;
    const Formula at = todo.back();
    todo.pop_back();
    const FormulaPool::Kind kind = pool_.node(at).kind;
    if (kind == FormulaPool::Kind::And || kind == FormulaPool::Kind::Or ||
        kind == FormulaPool::Kind::Xor || kind == FormulaPool::Kind::Not)
      todo.insert(todo.end(), pool_.begin(at), pool_.end(at));
  }
  return false;
}

}  // namespace kaboum::plan
