// Beliefs as products of sets of worlds: queries over all worlds, effects world by world, sensing
// as a split.
#include "worlds/belief_space.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan::worlds {

using Kind = Condition::Kind;

BeliefSpace::BeliefSpace(const WorldTask& task) : task_(task) {
  for (const WorldTask::Component& c : task.components) sets_.emplace_back(c);
}

std::optional<std::vector<Outcome>> BeliefSpace::start(std::size_t most, Limits& limits) {
  for (const Constraint& c : task_.constraints)
    if (is_contradicted(task_, c))
      throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
  Outcome whole;
  whole.belief.assign(words(), 0);
  for (const Variable& v : task_.variables)
    if (!v.hidden) v.set(whole.belief.data(), v.initial);
  for (Index c = 0; c < sets_.size(); ++c) {
    auto worlds = initial_worlds(task_, c, most, sets_[c], limits);
    if (!worlds) return std::nullopt;
    whole.belief[task_.common_words + c] = sets_[c].set(*worlds);
  }
  std::vector<Index> sensed;
  for (const Index v : task_.sensed)
    if (task_.variables[v].hidden) sensed.push_back(v);
  return split(std::move(whole), sensed);
}

bool BeliefSpace::holds_of_variable(const Condition& c, const Word* belief) const {
  const Variable& v = task_.variables[c.variable];
  if (!v.hidden) {
    if (c.kind == Kind::Decided || c.kind == Kind::Whether) return true;
    return (v.get(belief) == c.value) == (c.kind == Kind::Is);
  }
  const WorldSets& sets = sets_[v.component];
  const Index set = set_of(v.component, belief);
  const Index all = v.get(sets.in_all(set));
  const Index some = v.get(sets.in_some(set));
  if (all == some) {  // one value
    if (c.kind == Kind::Decided || c.kind == Kind::Whether) return true;
    return (all == c.value) == (c.kind == Kind::Is);
  }
  if (c.kind == Kind::Is || c.kind == Kind::Decided) return false;
  if (!v.function) return false;
  return std::none_of(sets.members(set).begin(), sets.members(set).end(),
                      [&](Index w) { return v.get(sets.contents(w)) == c.value; });
}

bool BeliefSpace::holds(const Condition& c, const Word* belief) const {
  const auto child = [&](const Condition& k) { return holds(k, belief); };
  switch (c.kind) {
    case Kind::True:
      return true;
    case Kind::False:
      return false;
    case Kind::And:
      return std::all_of(c.children.begin(), c.children.end(), child);
    case Kind::Or:
      return std::any_of(c.children.begin(), c.children.end(), child);
    case Kind::Xor:
      return std::count_if(c.children.begin(), c.children.end(), child) == 1;
    case Kind::Not:
      return !child(c.children[0]);
    case Kind::Is:
    case Kind::IsNot:
    case Kind::Decided:
    case Kind::Whether:
      return holds_of_variable(c, belief);
  }
  return false;
}

/// @pre what the condition reads is common, or of the world's component.
bool BeliefSpace::holds_in(const Condition& c, const Word* common, const Word* world) const {
  const auto child = [&](const Condition& k) { return holds_in(k, common, world); };
  switch (c.kind) {
    case Kind::True:
      return true;
    case Kind::False:
      return false;
    case Kind::And:
      return std::all_of(c.children.begin(), c.children.end(), child);
    case Kind::Or:
      return std::any_of(c.children.begin(), c.children.end(), child);
    case Kind::Xor:
      return std::count_if(c.children.begin(), c.children.end(), child) == 1;
    case Kind::Not:
      return !child(c.children[0]);
    case Kind::Is:
    case Kind::IsNot: {
      const Variable& v = task_.variables[c.variable];
      return (v.get(v.hidden ? world : common) == c.value) == (c.kind == Kind::Is);
    }
    case Kind::Decided:
    case Kind::Whether:
      return true;
  }
  return false;
}

bool BeliefSpace::change(const Step& s, const Word* common, std::vector<Changing>& worlds,
                         const WorldSets& sets) const {
  const Variable& v = task_.variables[s.variable];
  const auto happens = [&](const Changing& w) {
    return holds_in(s.world, common, sets.contents(w.origin));
  };
  const auto free = [&](const auto& which) {
    const std::size_t n = worlds.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (!happens(worlds[i]) || !which(worlds[i])) continue;
      const Index before = v.get(worlds[i].now.data());
      for (Index value = 0; value < v.size; ++value) {
        if (value == before) continue;
        worlds.push_back(worlds[i]);
        v.set(worlds.back().now.data(), value);
      }
    }
    std::sort(worlds.begin(), worlds.end());
    worlds.erase(std::unique(worlds.begin(), worlds.end()), worlds.end());
    if (worlds.size() > kMostWorlds) throw TooManyWorlds();
  };
  const auto any = [](const Changing&) { return true; };
  switch (s.kind) {
    case Step::Kind::Set:
      for (Changing& w : worlds)
        if (happens(w)) v.set(w.now.data(), s.value);
      return true;
    case Step::Kind::Free:
      free([&](const Changing& w) {
        return s.any || (v.get(w.now.data()) == s.value) != s.differs;
      });
      return true;
    case Step::Kind::Rule:
      if (std::all_of(worlds.begin(), worlds.end(),
                      [&](const Changing& w) { return v.get(w.now.data()) == s.value; }))
        free(any);
      std::erase_if(
          worlds, [&](const Changing& w) { return happens(w) && v.get(w.now.data()) == s.value; });
      return !worlds.empty();
    case Step::Kind::OneOf: {
      const auto one = [&](const Changing& w) {
        return std::count_if(s.options.begin(), s.options.end(), [&](const auto& option) {
                 return task_.variables[option.first].get(w.now.data()) == option.second;
               }) == 1;
      };
      // A value that is known and none of the options has changed.
      if (v.function && std::none_of(worlds.begin(), worlds.end(), one) &&
          std::all_of(worlds.begin(), worlds.end(), [&](const Changing& w) {
            return v.get(w.now.data()) == v.get(worlds[0].now.data());
          }))
        free(any);
      std::erase_if(worlds, [&](const Changing& w) { return happens(w) && !one(w); });
      return !worlds.empty();
    }
    case Step::Kind::Sense:
      return true;
  }
  return true;
}

std::vector<Outcome> BeliefSpace::split(Outcome whole, const std::vector<Index>& sensed) {
  std::vector<Outcome> all;
  all.push_back(std::move(whole));
  for (const Index variable : sensed) {
    const Variable& v = task_.variables[variable];
    WorldSets& sets = sets_[v.component];
    std::vector<Outcome> next;
    for (Outcome& o : all) {
      const Index set = set_of(v.component, o.belief.data());
      if (v.get(sets.in_all(set)) == v.get(sets.in_some(set))) {
        next.push_back(std::move(o));
        continue;
      }
      for (Index value = 0; value < v.size; ++value) {
        std::vector<Index> part;
        for (const Index w : sets.members(set))
          if (v.get(sets.contents(w)) == value) part.push_back(w);
        if (part.empty()) continue;
        Outcome copy = o;
        copy.belief[task_.common_words + v.component] = sets.set(part);
        copy.sensed.emplace_back(variable, value);
        next.push_back(std::move(copy));
      }
    }
    all = std::move(next);
  }
  return all;
}

std::vector<Outcome> BeliefSpace::apply(const Operator& o, const Word* belief) {
  Outcome whole;
  whole.belief.assign(belief, belief + words());
  std::vector<Index> sensed;
  std::vector<const Step*> happening;
  for (const Step& s : o.steps) {
    if (!holds(s.known, belief)) continue;
    const Variable& v = task_.variables[s.variable];
    if (s.kind == Step::Kind::Sense) {
      if (v.hidden) sensed.push_back(s.variable);
    } else if (v.hidden) {
      happening.push_back(&s);
    } else if (holds_in(s.world, belief, nullptr)) {
      v.set(whole.belief.data(), s.value);
    }
  }
  for (const Index c : o.components) {
    const auto touches = [&](const Step* s) { return task_.variables[s->variable].component == c; };
    if (std::none_of(happening.begin(), happening.end(), touches)) continue;
    WorldSets& sets = sets_[c];
    std::vector<Changing> worlds;
    for (const Index w : sets.members(set_of(c, belief)))
      worlds.push_back({w, {sets.contents(w), sets.contents(w) + sets.words()}});
    for (const Step* s : happening)
      if (touches(s) && !change(*s, belief, worlds, sets)) return {};
    std::vector<Index> made;
    made.reserve(worlds.size());
    for (const Changing& w : worlds) made.push_back(sets.world(w.now.data()));
    whole.belief[task_.common_words + c] = sets.set(made);
  }
  return split(std::move(whole), sensed);
}

std::vector<Index> BeliefSpace::apply_in(const Operator& o, const Word* belief, Index component,
                                         Index world) {
  WorldSets& sets = sets_[component];
  const Word* contents = sets.contents(world);
  std::vector<Changing> worlds = {{world, {contents, contents + sets.words()}}};
  for (const Step& s : o.steps)
    if (s.kind != Step::Kind::Sense && task_.variables[s.variable].component == component &&
        holds(s.known, belief))
      change(s, belief, worlds, sets);
  std::vector<Index> made;
  made.reserve(worlds.size());
  for (const Changing& w : worlds) made.push_back(sets.world(w.now.data()));
  return made;
}

std::size_t BeliefSpace::bytes() const {
  std::size_t sum = 0;
  for (const WorldSets& s : sets_) sum += s.bytes();
  return sum;
}

}  // namespace kaboum::plan::worlds
