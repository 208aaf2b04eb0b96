// What databases of knowledge say of effects that are conditional in the world, and of
// disjunctions.
#include "task/knowledge_view.h"

#include <algorithm>
#include <set>

namespace kaboum::plan {
namespace {

bool has_worlds(const std::vector<Effect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& e) { return e.of_world || has_worlds(e.children); });
}

/// The effects as such that may happen: sensing and observations say nothing then.
std::vector<Effect> possibly(std::vector<Effect> effects) {
  std::vector<Effect> all;
  for (Effect& e : effects) {
    if (e.kind == Effect::Kind::Update) {
      if (e.update.add && e.update.database != Update::Database::Kf) continue;
      e.update.maybe = e.update.add;
    } else {
      e.children = possibly(std::move(e.children));
      if (e.children.empty()) continue;
    }
    all.push_back(std::move(e));
  }
  return all;
}

Query denied(Query q) {
  Query n;
  n.kind = Query::Kind::Not;
  n.children.push_back(std::move(q));
  return n;
}

std::vector<Effect> view(const std::vector<Effect>& effects) {
  std::vector<Effect> all;
  for (const Effect& e : effects) {
    Effect known = e;
    known.children = view(e.children);
    known.of_world = false;
    known.denial = {};
    if (!e.of_world) {
      all.push_back(std::move(known));
      continue;
    }
    Effect open = known;
    all.push_back(std::move(known));
    open.children = possibly(std::move(open.children));
    if (open.children.empty()) continue;
    open.condition = {};
    open.condition.kind = Query::Kind::And;
    open.condition.children = {denied(e.condition), denied(e.denial)};
    all.push_back(std::move(open));
  }
  return all;
}

}  // namespace

std::optional<Model> knowledge_view(const Model& model) {
  const auto is_or = [](const Update& u) { return u.database == Update::Database::Or; };
  const bool worlds = std::any_of(model.actions.begin(), model.actions.end(),
                                  [](const Action& a) { return has_worlds(a.effects); });
  if (!worlds && std::none_of(model.initial.begin(), model.initial.end(), is_or))
    return std::nullopt;
  Model out = model;
  for (Action& a : out.actions) a.effects = view(a.effects);
  // An atom of a disjunction is stated: closing leaves it open.
  const auto key = [](const Update::Literal& l) {
    std::vector<Index> k = {l.symbol};
    for (const Argument& a : l.arguments) k.push_back(a.index);
    return k;
  };
  std::set<std::vector<Index>> stated;
  for (const Update& u : model.initial)
    if (is_or(u))
      for (const Update::Literal& l : u.literals) stated.insert(key(l));
  std::erase_if(out.initial, [&](const Update& u) {
    return is_or(u) || (u.database == Update::Database::Lcw && stated.contains(key(u.literals[0])));
  });
  return out;
}

}  // namespace kaboum::plan
