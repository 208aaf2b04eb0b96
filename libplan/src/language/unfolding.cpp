// Nested terms: f(g(x)) as an argument becomes a variable that is quantified around the query or
// effect, with the condition that it is the value of the term.
#include "language/unfolding.h"

#include <optional>

namespace kaboum::plan {
namespace {

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

}  // namespace

Query negation(Query q) {
  Query n;
  n.kind = Query::Kind::Not;
  n.children.push_back(std::move(q));
  return n;
}

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

}  // namespace kaboum::plan
