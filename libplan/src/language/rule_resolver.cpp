// Rules of derived predicates, and their stratification: a predicate's level is the number of a
// component of the graph of dependencies, those that it depends on first.
#include "language/rule_resolver.h"

#include <algorithm>
#include <set>
#include <utility>

#include "language/plural.h"

namespace kaboum::plan {
namespace {

namespace sx = syntax;

/// Rules have no truth value where their conditions have none.
void require_complete(const sx::Document& document) {
  const auto plain = [](const auto& self, const sx::Effect& e) -> bool {
    using Kind = sx::Effect::Kind;
    if (e.kind == Kind::When || e.kind == Kind::ForAll)
      return !e.of_world &&
             std::ranges::all_of(e.children, [&](const sx::Effect& c) { return self(self, c); });
    return e.kind == Kind::Add && e.database == sx::Database::Kf;
  };
  const auto all_plain = [&](const std::vector<sx::Effect>& list) {
    return std::ranges::all_of(list, [&](const sx::Effect& e) { return plain(plain, e); });
  };
  if ((!closes_world(document) && !document.goals.empty()) || !document.unknown.empty() ||
      !document.externals.empty() || !all_plain(document.initial) ||
      !std::ranges::all_of(document.actions,
                           [&](const sx::Action& a) { return all_plain(a.effects); }))
    document.rules[0].head.location.fail(
        "derived predicates need complete knowledge: nothing unknown, sensed or given up, and no "
        "external functions");
}

Rule resolve_rule(const sx::Rule& r, const QueryResolver& queries, const Model& model) {
  const SymbolTable& symbols = queries.symbols();
  Rule rule;
  rule.predicate = symbols.predicate(r.head);
  const Symbol& p = model.predicates[rule.predicate];
  if (r.parameters.size() != p.parameters.size())
    r.head.location.fail("'" + p.name + "' takes " + plural(p.parameters.size(), "argument") +
                         ", not " + std::to_string(r.parameters.size()));
  Scope scope;
  scope.location = r.head.location;
  for (std::size_t i = 0; i < r.parameters.size(); ++i) {
    const sx::TypedVariable& v = r.parameters[i];
    if (scope.find(v.name.text) != nullptr)
      v.name.location.fail("parameter '?" + v.name.text + "' is declared twice");
    const Index wanted = p.parameters[i];
    Index type = symbols.enumerated_type(v.type);
    if (symbols.is_subtype(wanted, type)) type = wanted;
    symbols.check_type(v.name, type, wanted);
    scope.variables.push_back({v.name.text, scope.fresh(), type});
    rule.parameters.push_back(type);
  }
  rule.body = queries.query(r.body, scope);
  rule.slots = scope.slots;
  return rule;
}

/// The derived predicates that a body reads, and whether their negations.
void reads(const Query& q, bool negated, std::vector<std::pair<Index, bool>>& out) {
  if (q.kind == Query::Kind::Derived) out.emplace_back(q.symbol, q.negated != negated);
  const bool inner = q.kind == Query::Kind::Not ? !negated : negated;
  for (const Query& c : q.children) {
    reads(c, inner, out);
    if (q.kind == Query::Kind::Xor) reads(c, !inner, out);
  }
}

/// Depth first over `edges`, without recursion: appends the nodes not yet seen, successors first.
void finish(Index root, const std::vector<std::vector<Index>>& edges, std::vector<char>& seen,
            std::vector<Index>& out) {
  if (seen[root] != 0) return;
  std::vector<std::pair<Index, std::size_t>> stack = {{root, 0}};
  seen[root] = 1;
  while (!stack.empty()) {
    auto& [node, next] = stack.back();
    if (next == edges[node].size()) {
      out.push_back(node);
      stack.pop_back();
      continue;
    }
    const Index to = edges[node][next++];
    if (seen[to] != 0) continue;
    seen[to] = 1;
    stack.emplace_back(to, 0);
  }
}

/// Levels are strongly connected components (Kosaraju and Sharir).
void give_levels(const std::vector<std::vector<Index>>& depends, Model& model) {
  const auto count = static_cast<Index>(model.predicates.size());
  std::vector<std::vector<Index>> users(count);
  for (Index p = 0; p < count; ++p)
    for (const Index q : depends[p]) users[q].push_back(p);
  std::vector<char> seen(count, 0);
  std::vector<Index> order;
  for (Index p = 0; p < count; ++p) finish(p, users, seen, order);
  seen.assign(count, 0);
  Index level = 0;  // what nothing below uses comes last in the order: it depends on nothing left
  for (auto p = order.rbegin(); p != order.rend(); ++p) {
    if (!model.predicates[*p].derived() || seen[*p] != 0) continue;
    std::vector<Index> component;
    finish(*p, depends, seen, component);
    for (const Index q : component) {
      model.predicates[q].level = level;
      model.predicates[q].recursive =
          component.size() > 1 || std::ranges::find(depends[q], q) != depends[q].end();
    }
    ++level;
  }
}

}  // namespace

void require_values(const sx::Document& document, const Model& model) {
  if (document.rules.empty() || document.goals.empty()) return;
  std::set<std::vector<Index>> known;
  std::vector<double> missing(model.functions.size(), 0);
  for (std::size_t f = 0; f < missing.size(); ++f) {
    if (model.functions[f].numeric) continue;
    missing[f] = 1;
    for (const Index type : model.functions[f].parameters)
      missing[f] *= static_cast<double>(model.types[type].objects.size());
  }
  for (const Update& u : model.initial) {
    const Update::Literal& l = u.literals[0];
    if (!l.function || l.negated) continue;
    std::vector<Index> term = {l.symbol};
    for (const Argument& a : l.arguments) term.push_back(a.index);
    if (known.insert(std::move(term)).second) --missing[l.symbol];
  }
  for (std::size_t f = 0; f < missing.size(); ++f)
    if (missing[f] > 0)
      document.rules[0].head.location.fail(
          "derived predicates need complete knowledge: the initial state has no value of '" +
          model.functions[f].name + "' for some arguments");
}

void resolve_rules(const sx::Document& document, const QueryResolver& queries, Model& model) {
  if (document.rules.empty()) return;
  require_complete(document);
  std::vector<std::vector<Index>> depends(model.predicates.size());
  std::vector<std::vector<std::pair<Index, bool>>> read(document.rules.size());
  for (std::size_t i = 0; i < document.rules.size(); ++i) {
    model.rules.push_back(resolve_rule(document.rules[i], queries, model));
    reads(model.rules[i].body, false, read[i]);
    for (const auto& [p, negated] : read[i]) depends[model.rules[i].predicate].push_back(p);
  }
  give_levels(depends, model);
  for (std::size_t i = 0; i < document.rules.size(); ++i)
    for (const auto& [p, negated] : read[i])
      if (negated && model.predicates[p].level == model.predicates[model.rules[i].predicate].level)
        document.rules[i].head.location.fail(
            "'" + document.rules[i].head.text + "' depends on the negation of '" +
            model.predicates[p].name +
            "', which depends on it: rules are not stratified, which is not supported");
}

}  // namespace kaboum::plan
