#pragma once

#include <optional>
#include <tuple>
#include <vector>

#include "worlds/world_sets.h"
#include "worlds/world_task.h"

namespace kaboum::plan::worlds {

/// Thrown where an action makes more worlds than are kept.
struct TooManyWorlds {};

/// A belief as words: the common part, then the number of a set for each component.
using BeliefWords = std::vector<Word>;

/// One way that what an action senses may turn out.
struct Outcome {
  BeliefWords belief;
  std::vector<std::pair<Index, Index>> sensed;  ///< variables that differed, and their values
};

/// What is known in beliefs, and what operators make of them. Exact: a belief stands for the
/// product of its sets, and nothing ties components together.
class BeliefSpace {
 public:
  /// @pre `start` succeeded before anything else is asked.
  explicit BeliefSpace(const WorldTask& task);

  /// The beliefs that the agent may start with; nullopt: a component has more than `most` worlds.
  std::optional<std::vector<Outcome>> start(std::size_t most, Limits& limits);

  [[nodiscard]] const WorldTask& task() const { return task_; }
  [[nodiscard]] std::size_t words() const { return task_.common_words + task_.components.size(); }
  [[nodiscard]] bool holds(const Condition& c, const Word* belief) const;
  /// The outcomes of an operator whose precondition holds; none, if what it observes cannot be.
  /// @throws TooManyWorlds
  std::vector<Outcome> apply(const Operator& o, const Word* belief);

  /// What an operator without observations makes of one world of a component, sensing apart.
  std::vector<Index> apply_in(const Operator& o, const Word* belief, Index component, Index world);

  [[nodiscard]] const WorldSets& sets(Index component) const { return sets_[component]; }
  [[nodiscard]] Index set_of(Index component, const Word* belief) const {
    return static_cast<Index>(belief[task_.common_words + component]);
  }
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Changing {
    Index origin;  ///< the world before
    std::vector<Word> now;
    bool operator==(const Changing&) const = default;
    bool operator<(const Changing& o) const {
      return std::tie(origin, now) < std::tie(o.origin, o.now);
    }
  };
  static constexpr std::size_t kMostWorlds = 1U << 20U;

  [[nodiscard]] bool holds_of_variable(const Condition& c, const Word* belief) const;
  [[nodiscard]] bool holds_in(const Condition& c, const Word* common, const Word* world) const;
  /// @return false if an observation leaves no world.
  bool change(const Step& s, const Word* common, std::vector<Changing>& worlds,
              const WorldSets& sets) const;
  [[nodiscard]] std::vector<Outcome> split(Outcome whole, const std::vector<Index>& sensed);

  const WorldTask& task_;
  std::vector<WorldSets> sets_;
};

}  // namespace kaboum::plan::worlds
