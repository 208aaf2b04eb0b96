// Conjuncts and free variables of lifted queries.
#include "task/bindings.h"

#include <algorithm>
#include <set>

namespace kaboum::plan {
namespace {

void collect(const Query& q, std::set<Index>& free, std::set<Index>& bound) {
  const auto use = [&](const Argument& a) {
    if (a.variable && !bound.contains(a.index)) free.insert(a.index);
    if (a.term)
      for (const Argument& x : a.term->arguments)
        if (x.variable && !bound.contains(x.index)) free.insert(x.index);
  };
  for (const Argument& a : q.arguments) use(a);
  if (q.value && q.kind != Query::Kind::Let) use(*q.value);
  const bool quantifier = q.kind == Query::Kind::Exists || q.kind == Query::Kind::ForAll;
  if (quantifier) bound.insert(q.symbol);
  for (const Query& child : q.children) collect(child, free, bound);
  if (quantifier) bound.erase(q.symbol);
}

void flatten(const Query& q, std::vector<const Query*>& out) {
  if (q.kind == Query::Kind::And) {
    for (const Query& child : q.children) flatten(child, out);
  } else if (q.kind != Query::Kind::True) {
    out.push_back(&q);
  }
}

}  // namespace

std::vector<const Query*> conjuncts(const Query& query) {
  std::vector<const Query*> out;
  flatten(query, out);
  return out;
}

std::vector<Index> free_slots(const Query& query) {
  std::set<Index> free, bound;
  collect(query, free, bound);
  return {free.begin(), free.end()};
}

}  // namespace kaboum::plan
