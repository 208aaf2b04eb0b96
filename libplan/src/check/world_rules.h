#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "check/runtime_knowledge.h"

namespace kaboum::plan {

/// What queries and actions mean of sets of possible worlds, written for the validator alone, on
/// the lifted model: docs/planning/knowledge-states.md, "Possible worlds".
class WorldRules {
 public:
  /// Values of facts, in the order of their columns; of an atom 0 or 1, of a term an object.
  /// kNone: nothing reads it any more.
  using World = std::vector<Index>;
  using Belief = std::set<World>;

  explicit WorldRules(const Model& model) : model_(model) {}

  /// The beliefs that the agent may start with, over these facts and what initial entries tie to
  /// them. nullopt: too many worlds.
  std::optional<std::vector<Belief>> start(std::set<Fact> facts);

  [[nodiscard]] bool holds(const Query& q, std::vector<Index>& slots, const Belief& b) const;
  /// What an action makes of a belief: several, if something is sensed; none, if what it observes
  /// contradicts all worlds.
  [[nodiscard]] std::vector<Belief> after(const Action& a, std::vector<Index>& slots,
                                          const Belief& b) const;
  /// The value that a fact has in all worlds.
  [[nodiscard]] std::optional<Index> value(const Fact& f, const Belief& b) const;
  /// Without the facts that are not in `live`.
  [[nodiscard]] Belief restricted(const Belief& b, const std::set<Fact>& live) const;

 private:
  static constexpr std::size_t kMostWorlds = 1U << 17U;

  /// An update that happens: in those worlds that meet all conditions.
  struct Happening {
    const Update* update;
    std::vector<Index> slots;
    std::vector<const Query*> conditions;
    std::vector<std::vector<Index>> condition_slots;
  };
  struct Changing {
    World origin, now;
    bool operator==(const Changing&) const = default;
    bool operator<(const Changing& o) const {
      return std::tie(origin, now) < std::tie(o.origin, o.now);
    }
  };

  [[nodiscard]] std::vector<Index> range(const Fact& f) const;
  [[nodiscard]] Fact fact_of(const Update::Literal& l, const std::vector<Index>& slots) const;
  void tie(std::set<Fact>& facts) const;
  [[nodiscard]] std::vector<Belief> split(std::vector<Belief> all,
                                          const std::vector<Fact>& sensed) const;
  template <class Test>
  [[nodiscard]] bool always(const Fact& f, const Belief& b, const Test& test) const;
  void fire(const std::vector<Effect>& effects, Happening so_far, const Belief& b,
            std::vector<Happening>& out) const;
  [[nodiscard]] bool in_range(const Happening& h) const;
  [[nodiscard]] bool happens(const Happening& h, const Changing& w) const;
  template <class Which>
  void free(const Happening& h, std::size_t column, const Fact& f, const Which& which,
            std::vector<Changing>& worlds) const;
  void update(const Happening& h, std::vector<Changing>& worlds, std::vector<Fact>& sensed) const;

  const Model& model_;
  std::map<Fact, std::size_t> columns_;
};

}  // namespace kaboum::plan
