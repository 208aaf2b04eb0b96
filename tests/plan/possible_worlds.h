#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <optional>
#include <set>
#include <vector>

/// Knowledge as sets of possible worlds, the naive way: an oracle for small models. It shares
/// nothing with the planner or the validator but the loaded model.
namespace kaboum::plan::test {

/// The value of every ground atom (0, 1) and term (an object), in the order of Worlds::items.
using World = std::vector<Index>;
/// Worlds that the agent cannot tell apart at run time.
using Belief = std::set<World>;

class Worlds {
 public:
  struct Item {
    bool function = false;
    Index symbol = 0;
    std::vector<Index> arguments;
    auto operator<=>(const Item&) const = default;
  };

  explicit Worlds(const Model& model) : model_(model) {
    const auto list = [&](bool function, const std::vector<Symbol>& symbols) {
      for (Index s = 0; s < symbols.size(); ++s) {
        std::vector<Index> arguments;
        const auto visit = [&](const auto& self) -> void {
          if (arguments.size() == symbols[s].parameters.size()) {
            number_[{function, s, arguments}] = items_.size();
            items_.push_back({function, s, arguments});
            return;
          }
          for (const Index o : model.types[symbols[s].parameters[arguments.size()]].objects) {
            arguments.push_back(o);
            self(self);
            arguments.pop_back();
          }
        };
        visit(visit);
      }
    };
    list(false, model.predicates);
    list(true, model.functions);
  }

  [[nodiscard]] const std::vector<Item>& items() const { return items_; }
  [[nodiscard]] std::size_t number(bool function, Index symbol,
                                   const std::vector<Index>& arguments) const {
    return number_.at({function, symbol, arguments});
  }
  [[nodiscard]] std::vector<Index> values(std::size_t item) const {
    if (!items_[item].function) return {0, 1};
    return model_.types[model_.functions[items_[item].symbol].range].objects;
  }

  /// The beliefs that the agent may start with.
  [[nodiscard]] std::vector<Belief> initial() const {
    Belief all = {World(items_.size(), 0)};
    for (std::size_t i = 0; i < items_.size(); ++i) {
      Belief next;
      for (World w : all)
        for (const Index v : values(i)) {
          w[i] = v;
          next.insert(w);
        }
      all = std::move(next);
    }
    std::vector<std::size_t> sensed;
    std::set<std::size_t> stated;
    for (const Update& u : model_.initial) {
      const std::vector<Index> none;
      const Update::Literal& l = u.literals[0];
      const std::size_t i = item(l, none);
      switch (u.database) {
        case Update::Database::Kf:
          std::erase_if(all, [&](const World& w) { return !true_in(l, none, w); });
          stated.insert(i);
          break;
        case Update::Database::Kw:
        case Update::Database::Kv:
          sensed.push_back(i);
          stated.insert(i);
          break;
        case Update::Database::Kx:
          for (const Update::Literal& o : u.literals) stated.insert(item(o, none));
          std::erase_if(all, [&](const World& w) { return !one_of(u, none, w); });
          break;
        case Update::Database::Or:
          for (const Update::Literal& o : u.literals) stated.insert(item(o, none));
          std::erase_if(all, [&](const World& w) {
            return std::none_of(u.literals.begin(), u.literals.end(),
                                [&](const Update::Literal& o) { return true_in(o, none, w); });
          });
          break;
        case Update::Database::Lcw:
          if (!stated.contains(i)) std::erase_if(all, [&](const World& w) { return w[i] != 0; });
          break;
      }
    }
    return split({all}, sensed);
  }

  [[nodiscard]] bool holds(const Query& q, std::vector<Index>& slots, const Belief& b) const {
    const auto always = [&](const auto& test) { return std::all_of(b.begin(), b.end(), test); };
    const auto constant = [&](std::size_t i) {
      return always([&](const World& w) { return w[i] == (*b.begin())[i]; });
    };
    const auto at = [&](bool function) {
      std::vector<Index> arguments;
      for (const Argument& a : q.arguments) arguments.push_back(of(a, slots));
      return number(function, q.symbol, arguments);
    };
    switch (q.kind) {
      case Query::Kind::Derived:
        return false;  // all is known where there are some
      case Query::Kind::True:
        return true;
      case Query::Kind::False:
        return false;
      case Query::Kind::And:
        return std::all_of(q.children.begin(), q.children.end(),
                           [&](const Query& c) { return holds(c, slots, b); });
      case Query::Kind::Or:
        return std::any_of(q.children.begin(), q.children.end(),
                           [&](const Query& c) { return holds(c, slots, b); });
      case Query::Kind::Xor:
        return std::count_if(q.children.begin(), q.children.end(),
                             [&](const Query& c) { return holds(c, slots, b); }) == 1;
      case Query::Kind::Not:
        return !holds(q.children[0], slots, b);
      case Query::Kind::Exists:
      case Query::Kind::ForAll: {
        bool any = false;
        bool all = true;
        for (const Index o : model_.types[q.type].objects) {
          slots.at(q.symbol) = o;
          const bool h = holds(q.children[0], slots, b);
          any |= h;
          all &= h;
        }
        return q.kind == Query::Kind::Exists ? any : all;
      }
      case Query::Kind::Known: {
        const std::size_t i = at(false);
        return always([&](const World& w) { return (w[i] != 0) != q.negated; });
      }
      case Query::Kind::KnowWhether:
        return constant(at(false));
      case Query::Kind::KnownValue: {
        const std::size_t i = at(true);
        const Index v = of(*q.value, slots);
        return always([&](const World& w) { return (w[i] == v) != q.negated; });
      }
      case Query::Kind::WhetherValue: {
        const std::size_t i = at(true);
        const Index v = of(*q.value, slots);
        return always([&](const World& w) { return w[i] == v; }) ||
               always([&](const World& w) { return w[i] != v; });
      }
      case Query::Kind::KnowValue:
        return constant(at(true));
      case Query::Kind::Same:
        return of(q.arguments[0], slots) == of(q.arguments[1], slots);
      case Query::Kind::External:
      case Query::Kind::Let:
        break;
    }
    throw std::logic_error("the oracle has no externals");
  }

  struct Happening {
    const Update* update;
    std::vector<Index> slots;
    std::vector<std::size_t> ground;  ///< items and values of its literals
    std::set<World> where;            ///< the worlds, as they were, in which it happens
    bool operator==(const Happening& o) const { return update == o.update && ground == o.ground; }
  };
  /// Updates of an action in a belief: conditions look at what is known before.
  [[nodiscard]] std::vector<Happening> fired(const Action& a, const std::vector<Index>& arguments,
                                             const Belief& b) const {
    std::vector<Happening> out;
    std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
    std::copy(arguments.begin(), arguments.end(), slots.begin());
    fire(a.effects, slots, b, b, out);
    return out;
  }

  /// What the updates make of a belief: several, if something is sensed; none, if an observation
  /// contradicts it.
  [[nodiscard]] std::vector<Belief> apply(const Belief& b,
                                          const std::vector<Happening>& updates) const {
    std::vector<std::size_t> sensed;
    Paired pairs;
    for (const World& w : b) pairs.insert({w, w});
    for (const bool add : {false, true})
      for (const Happening& h : updates)
        if (h.update->add == add) update(pairs, h, sensed);
    Belief after;
    for (const auto& [before, now] : pairs) after.insert(now);
    if (after.empty()) return {};
    return split({std::move(after)}, sensed);
  }

 private:
  /// Worlds before an action, and what has become of them.
  using Paired = std::set<std::pair<World, World>>;

  static Index of(const Argument& a, const std::vector<Index>& slots) {
    return a.variable ? slots.at(a.index) : a.index;
  }
  [[nodiscard]] std::size_t item(const Update::Literal& l, const std::vector<Index>& slots) const {
    std::vector<Index> arguments;
    for (const Argument& a : l.arguments) arguments.push_back(of(a, slots));
    return number(l.function, l.symbol, arguments);
  }
  [[nodiscard]] bool true_in(const Update::Literal& l, const std::vector<Index>& slots,
                             const World& w) const {
    const Index v = w[item(l, slots)];
    return (l.function ? v == of(*l.value, slots) : v != 0) != l.negated;
  }
  [[nodiscard]] bool one_of(const Update& u, const std::vector<Index>& slots,
                            const World& w) const {
    std::set<std::pair<std::size_t, Index>> holding;
    for (const Update::Literal& l : u.literals)
      if (true_in(l, slots, w)) holding.insert({item(l, slots), w[item(l, slots)]});
    return holding.size() == 1;
  }
  [[nodiscard]] std::vector<Belief> split(std::vector<Belief> all,
                                          const std::vector<std::size_t>& sensed) const {
    for (const std::size_t i : sensed) {
      std::vector<Belief> next;
      for (const Belief& b : all) {
        std::map<Index, Belief> parts;
        for (const World& w : b) parts[w[i]].insert(w);
        for (auto& [v, part] : parts) next.push_back(std::move(part));
      }
      all = std::move(next);
    }
    return all;
  }
  /// `where`: the worlds that meet all conditions of the world so far.
  void fire(const std::vector<Effect>& effects, std::vector<Index>& slots, const Belief& b,
            const Belief& where, std::vector<Happening>& out) const {
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::Update) {
        std::vector<std::size_t> ground;
        for (const Update::Literal& l : e.update.literals) {
          ground.push_back(item(l, slots));
          if (l.value) ground.push_back(of(*l.value, slots));
        }
        out.push_back({&e.update, slots, std::move(ground), where});
      } else if (e.kind == Effect::Kind::When && e.of_world) {
        Belief there;
        for (const World& w : where)
          if (holds(e.condition, slots, {w})) there.insert(w);
        fire(e.children, slots, b, there, out);
      } else if (e.kind == Effect::Kind::When) {
        if (holds(e.condition, slots, b)) fire(e.children, slots, b, where, out);
      } else {
        for (const Index o : model_.types[e.type].objects) {
          slots.at(e.slot) = o;
          fire(e.children, slots, b, where, out);
        }
      }
    }
  }

  /// In each world that `which` picks the item may have any value afterwards.
  template <class Which>
  void free(Paired& b, const Happening& h, std::size_t i, const Which& which) const {
    Paired next = b;
    for (auto [before, now] : b) {
      if (!h.where.contains(before) || !which(now)) continue;
      for (const Index v : values(i)) {
        now[i] = v;
        next.insert({before, now});
      }
    }
    b = std::move(next);
  }

  void update(Paired& b, const Happening& h, std::vector<std::size_t>& sensed) const {
    const Update& u = *h.update;
    const Update::Literal& l = u.literals[0];
    const std::size_t i = item(l, h.slots);
    const auto true_here = [&](const World& w) { return true_in(l, h.slots, w); };
    const auto false_here = [&](const World& w) { return !true_in(l, h.slots, w); };
    const auto any = [](const World&) { return true; };
    const auto none = [&](const auto& test) {
      return std::none_of(b.begin(), b.end(), [&](const auto& p) { return test(p.second); });
    };
    const auto leave_out = [&](const auto& test) {
      std::erase_if(b, [&](const auto& p) { return h.where.contains(p.first) && test(p.second); });
    };
    switch (u.database) {
      case Update::Database::Kf:
        if (u.maybe) {
          free(b, h, i, false_here);
        } else if (!u.add) {
          free(b, h, i, true_here);
        } else if (!l.function || !l.negated) {
          Paired next;
          for (auto [before, now] : b) {
            if (h.where.contains(before))
              now[i] = l.function ? of(*l.value, h.slots) : (l.negated ? 0 : 1);
            next.insert({before, std::move(now)});
          }
          b = std::move(next);
        } else {
          if (none(true_here)) free(b, h, i, any);
          leave_out(false_here);
        }
        return;
      case Update::Database::Kw:
      case Update::Database::Kv:
        if (u.add) {
          sensed.push_back(i);
        } else {
          free(b, h, i, any);
        }
        return;
      case Update::Database::Lcw:
        if (u.add) {
          sensed.push_back(i);
        } else {
          free(b, h, i, false_here);
        }
        return;
      case Update::Database::Kx: {
        const auto possible = [&](const World& w) { return one_of(u, h.slots, w); };
        if (!u.add) {
          if (l.function) free(b, h, i, any);
          return;
        }
        // A value known to be none of the options has changed.
        if (l.function && none(possible) &&
            none([&](const World& w) { return w[i] != b.begin()->second[i]; }))
          free(b, h, i, any);
        leave_out([&](const World& w) { return !possible(w); });
        return;
      }
      case Update::Database::Or:
        throw std::logic_error("an initial entry as an effect");
    }
  }

  const Model& model_;
  std::vector<Item> items_;
  std::map<Item, std::size_t> number_;
};

/// Whether there is a plan, decided over all beliefs that can come about: the least fixed point of
/// "the goal holds, or some action leads to such beliefs only". nullopt: more than `limit` beliefs.
inline std::optional<bool> has_plan(const Model& model, std::size_t limit) {
  const Worlds worlds(model);
  std::map<Belief, std::size_t> number;
  std::vector<const Belief*> beliefs;
  const auto add = [&](const Belief& b) {
    const auto [it, fresh] = number.emplace(b, beliefs.size());
    if (fresh) beliefs.push_back(&it->first);
    return it->second;
  };
  std::set<std::size_t> starts;
  for (const Belief& b : worlds.initial()) starts.insert(add(b));
  std::vector<std::vector<std::vector<std::size_t>>> leads_to;  // belief, action: beliefs
  std::vector<char> good;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    if (beliefs.size() > limit) return std::nullopt;
    const Belief b = *beliefs[i];
    std::vector<Index> slots(std::max<Index>(model.goal_slots, 1), 0);
    good.push_back(worlds.holds(model.goal, slots, b) ? 1 : 0);
    leads_to.emplace_back();
    if (good.back()) continue;
    for (const Action& a : model.actions) {
      std::vector<Index> arguments;
      const auto visit = [&](const auto& self) -> void {
        if (arguments.size() < a.parameters.size()) {
          for (const Index o : model.types[a.parameters[arguments.size()].type].objects) {
            arguments.push_back(o);
            self(self);
            arguments.pop_back();
          }
          return;
        }
        std::vector<Index> bound(std::max<Index>(a.slots, 1), 0);
        std::copy(arguments.begin(), arguments.end(), bound.begin());
        if (!worlds.holds(a.precondition, bound, b)) return;
        std::vector<std::size_t> next;
        for (const Belief& n : worlds.apply(b, worlds.fired(a, arguments, b)))
          next.push_back(add(n));
        if (!next.empty()) leads_to[i].push_back(std::move(next));
      };
      visit(visit);
    }
  }
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < beliefs.size(); ++i) {
      if (good[i]) continue;
      for (const auto& next : leads_to[i])
        if (std::all_of(next.begin(), next.end(), [&](std::size_t n) { return good[n] != 0; })) {
          good[i] = 1;
          again = true;
          break;
        }
    }
  }
  return std::all_of(starts.begin(), starts.end(), [&](std::size_t s) { return good[s] != 0; });
}

}  // namespace kaboum::plan::test
