// Possible worlds for the validator: queries over all worlds of a belief, effects world by world.
#include "check/world_rules.h"

#include <kaboum/base/error.h>

#include <algorithm>

#include "check/query_evaluator.h"
#include "check/world_enumeration.h"

namespace kaboum::plan {
std::vector<Index> WorldRules::range(const Fact& f) const {
  if (f[0] == 0) return {0, 1};
  return model_.types[model_.functions[f[1]].range].objects;
}

Fact WorldRules::fact_of(const Update::Literal& l, const std::vector<Index>& slots) const {
  return fact(l.function, l.symbol, l.arguments, slots);
}

/// Adds what initial entries of Kx and Or tie to these facts.
void WorldRules::tie(std::set<Fact>& facts) const {
  const std::vector<Index> none;
  for (bool again = true; again;) {
    again = false;
    for (const Update& u : model_.initial) {
      if (u.literals.size() < 2) continue;
      const bool tied = std::any_of(u.literals.begin(), u.literals.end(), [&](const auto& l) {
        return facts.contains(fact_of(l, none));
      });
      if (!tied) continue;
      for (const auto& l : u.literals) again |= facts.insert(fact_of(l, none)).second;
    }
  }
}

std::optional<std::vector<WorldRules::Belief>> WorldRules::start(std::set<Fact> facts) {
  tie(facts);
  const std::vector<Index> none;
  World world;
  WorldEnumeration worlds;
  for (const Fact& f : facts) {
    columns_[f] = world.size();
    world.push_back(kNone);
    worlds.add_column(f[0] == 0, range(f));
  }
  std::vector<Fact> sensed;
  std::set<Fact> stated;
  for (const Update& u : model_.initial) {
    const Update::Literal& l = u.literals[0];
    const Fact f = fact_of(l, none);
    const auto at = columns_.find(f);
    const auto settle = [&](Index value) {
      if (at == columns_.end()) return;
      if (world[at->second] != kNone && world[at->second] != value)
        throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
      world[at->second] = value;
    };
    switch (u.database) {
      case Update::Database::Kf:
        stated.insert(f);
        if (!l.function)
          settle(l.negated ? 0 : 1);
        else if (!l.negated)
          settle(l.value->index);
        else if (at != columns_.end())
          worlds.add({false, {{at->second, l.value->index, true}}});
        break;
      case Update::Database::Kw:
      case Update::Database::Kv:
        stated.insert(f);
        if (at != columns_.end()) sensed.push_back(f);
        break;
      case Update::Database::Kx:
      case Update::Database::Or: {
        WorldEnumeration::Constraint c;
        c.exactly_one = u.database == Update::Database::Kx;
        for (const auto& o : u.literals) {
          stated.insert(fact_of(o, none));
          if (const auto column = columns_.find(fact_of(o, none)); column != columns_.end())
            c.literals.push_back({column->second, o.function ? o.value->index : 1, o.negated});
        }
        if (c.literals.size() == u.literals.size()) worlds.add(std::move(c));
        break;
      }
      case Update::Database::Lcw:
        if (!stated.contains(f)) settle(0);
        break;
    }
  }
  Belief all;
  if (!worlds.enumerate(world, kMostWorlds, all)) return std::nullopt;
  if (all.empty()) throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
  return split({std::move(all)}, sensed);
}

std::vector<WorldRules::Belief> WorldRules::split(std::vector<Belief> all,
                                                  const std::vector<Fact>& sensed) const {
  for (const Fact& f : sensed) {
    const auto column = columns_.find(f);
    if (column == columns_.end()) continue;  // nothing reads it
    std::vector<Belief> next;
    for (const Belief& b : all) {
      std::map<Index, Belief> parts;
      for (const World& w : b) parts[w[column->second]].insert(w);
      for (auto& [value, part] : parts) next.push_back(std::move(part));
    }
    all = std::move(next);
  }
  return all;
}

std::optional<Index> WorldRules::value(const Fact& f, const Belief& b) const {
  const auto column = columns_.find(f);
  if (column == columns_.end()) return std::nullopt;
  const Index first = (*b.begin())[column->second];
  for (const World& w : b)
    if (w[column->second] != first) return std::nullopt;
  return first;
}

WorldRules::Belief WorldRules::restricted(const Belief& b, const std::set<Fact>& live) const {
  std::vector<std::size_t> dead;
  for (const auto& [f, column] : columns_)
    if (!live.contains(f)) dead.push_back(column);
  Belief out;
  for (World w : b) {
    for (const std::size_t column : dead) w[column] = kNone;
    out.insert(std::move(w));
  }
  return out;
}

template <class Test>
bool WorldRules::always(const Fact& f, const Belief& b, const Test& test) const {
  const std::size_t column = columns_.at(f);
  return std::all_of(b.begin(), b.end(), [&](const World& w) { return test(w[column]); });
}

bool WorldRules::holds(const Query& q, std::vector<Index>& slots, const Belief& b) const {
  using K = Query::Kind;
  const auto child = [&](const Query& c) { return holds(c, slots, b); };
  const auto of = [&](bool function) { return fact(function, q.symbol, q.arguments, slots); };
  switch (q.kind) {
    case K::True:
      return true;
    case K::False:
      return false;
    case K::And:
      return std::all_of(q.children.begin(), q.children.end(), child);
    case K::Or:
      return std::any_of(q.children.begin(), q.children.end(), child);
    case K::Xor:
      return std::count_if(q.children.begin(), q.children.end(), child) == 1;
    case K::Not:
      return !child(q.children[0]);
    case K::Exists:
    case K::ForAll:
      for (const Index o : model_.types[q.type].objects) {
        slots.at(q.symbol) = o;
        if (child(q.children[0]) == (q.kind == K::Exists)) return q.kind == K::Exists;
      }
      return q.kind == K::ForAll;
    case K::Known:
      return always(of(false), b, [&](Index v) { return (v != 0) != q.negated; });
    case K::KnowWhether:
      return value(of(false), b).has_value();
    case K::KnowValue:
      return value(of(true), b).has_value();
    case K::KnownValue: {
      const Index wanted = object(*q.value, slots);
      return always(of(true), b, [&](Index v) { return (v == wanted) != q.negated; });
    }
    case K::WhetherValue: {
      const Index wanted = object(*q.value, slots);
      return always(of(true), b, [&](Index v) { return v == wanted; }) ||
             always(of(true), b, [&](Index v) { return v != wanted; });
    }
    case K::Same:
      return object(q.arguments[0], slots) == object(q.arguments[1], slots);
    case K::Derived:
    case K::External:
    case K::Let:
      break;
  }
  throw Error(ErrorCode::Internal,
              "neither external functions nor rules are asked about possible worlds");
}

void WorldRules::fire(const std::vector<Effect>& effects, Happening so_far, const Belief& b,
                      std::vector<Happening>& out) const {
  for (const Effect& e : effects) {
    if (e.kind == Effect::Kind::Update) {
      out.push_back(so_far);
      out.back().update = &e.update;
    } else if (e.kind == Effect::Kind::ForAll) {
      for (const Index o : model_.types[e.type].objects) {
        so_far.slots.at(e.slot) = o;
        fire(e.children, so_far, b, out);
      }
    } else if (e.of_world) {
      Happening there = so_far;
      there.conditions.push_back(&e.condition);
      there.condition_slots.push_back(so_far.slots);
      fire(e.children, std::move(there), b, out);
    } else {
      std::vector<Index> slots = so_far.slots;
      if (holds(e.condition, slots, b)) fire(e.children, so_far, b, out);
    }
  }
}

bool WorldRules::in_range(const Happening& h) const {
  for (const Update::Literal& l : h.update->literals) {
    const Symbol& s = (l.function ? model_.functions : model_.predicates)[l.symbol];
    for (std::size_t i = 0; i < l.arguments.size(); ++i)
      if (!model_.is_a(object(l.arguments[i], h.slots), s.parameters[i])) return false;
    if (l.value && !model_.is_a(object(*l.value, h.slots), s.range)) return false;
  }
  return true;
}

/// Conditions of the world look at it as it was before the action.
bool WorldRules::happens(const Happening& h, const Changing& w) const {
  if (h.conditions.empty()) return true;
  const Belief alone = {w.origin};
  for (std::size_t i = 0; i < h.conditions.size(); ++i) {
    std::vector<Index> slots = h.condition_slots[i];
    if (!holds(*h.conditions[i], slots, alone)) return false;
  }
  return true;
}

/// In each world that `which` picks, the fact may have any value afterwards.
template <class Which>
void WorldRules::free(const Happening& h, std::size_t column, const Fact& f, const Which& which,
                      std::vector<Changing>& worlds) const {
  const std::size_t n = worlds.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!which(worlds[i].now[column]) || !happens(h, worlds[i])) continue;
    for (const Index v : range(f)) {
      worlds.push_back(worlds[i]);
      worlds.back().now[column] = v;
    }
  }
  std::sort(worlds.begin(), worlds.end());
  worlds.erase(std::unique(worlds.begin(), worlds.end()), worlds.end());
  if (worlds.size() > kMostWorlds)
    throw Error(ErrorCode::LimitReached, "too many possible worlds to replay");
}

void WorldRules::update(const Happening& h, std::vector<Changing>& worlds,
                        std::vector<Fact>& sensed) const {
  const Update& u = *h.update;
  const Update::Literal& l = u.literals[0];
  const Fact f = fact_of(l, h.slots);
  const auto at = columns_.find(f);
  if (at == columns_.end() && u.database != Update::Database::Kx) return;  // nothing reads it
  const std::size_t column = at == columns_.end() ? 0 : at->second;
  const Index wanted = l.function && l.value ? object(*l.value, h.slots) : 1;
  const auto holding = [&](Index v) { return (v == wanted) != l.negated; };
  const auto failing = [&](Index v) { return (v == wanted) == l.negated; };
  const auto any = [](Index) { return true; };
  switch (u.database) {
    case Update::Database::Kf:
      if (u.maybe) {
        free(h, column, f, failing, worlds);
      } else if (!u.add) {
        free(h, column, f, holding, worlds);
      } else if (!l.function || !l.negated) {
        for (Changing& w : worlds)
          if (happens(h, w)) w.now[column] = l.function ? wanted : (l.negated ? 0 : 1);
      } else {
        if (std::none_of(worlds.begin(), worlds.end(),
                         [&](const Changing& w) { return holding(w.now[column]); }))
          free(h, column, f, any, worlds);
        std::erase_if(worlds,
                      [&](const Changing& w) { return failing(w.now[column]) && happens(h, w); });
      }
      return;
    case Update::Database::Kw:
    case Update::Database::Kv:
      if (u.add)
        sensed.push_back(f);
      else
        free(h, column, f, any, worlds);
      return;
    case Update::Database::Lcw:
      if (u.add)
        sensed.push_back(f);
      else
        free(
            h, column, f, [](Index v) { return v == 0; }, worlds);
      return;
    case Update::Database::Kx: {
      if (!u.add) {
        if (l.function && at != columns_.end()) free(h, column, f, any, worlds);
        return;
      }
      const auto possible = [&](const Changing& w) {
        std::set<std::pair<Fact, Index>> met;
        for (const Update::Literal& o : u.literals) {
          const Fact g = fact_of(o, h.slots);
          const Index v = w.now[columns_.at(g)];
          if (v == (o.function ? object(*o.value, h.slots) : 1)) met.emplace(g, v);
        }
        return met.size() == 1;
      };
      const bool one_value = std::all_of(worlds.begin(), worlds.end(), [&](const Changing& w) {
        return w.now[column] == worlds[0].now[column];
      });
      if (l.function && one_value && std::none_of(worlds.begin(), worlds.end(), possible))
        free(h, column, f, any, worlds);
      std::erase_if(worlds, [&](const Changing& w) { return happens(h, w) && !possible(w); });
      return;
    }
    case Update::Database::Or:
      return;
  }
}

std::vector<WorldRules::Belief> WorldRules::after(const Action& a, std::vector<Index>& slots,
                                                  const Belief& b) const {
  std::vector<Happening> fired;
  fire(a.effects, {nullptr, slots, {}, {}}, b, fired);
  std::erase_if(fired, [&](const Happening& h) { return !in_range(h); });
  std::vector<Changing> worlds;
  for (const World& w : b) worlds.push_back({w, w});
  std::vector<Fact> sensed;
  for (const bool add : {false, true})
    for (const Happening& h : fired)
      if (h.update->add == add) update(h, worlds, sensed);
  Belief after;
  for (Changing& w : worlds) after.insert(std::move(w.now));
  if (after.empty()) return {};
  return split({std::move(after)}, sensed);
}

}  // namespace kaboum::plan
