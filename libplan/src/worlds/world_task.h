#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <map>
#include <vector>

namespace kaboum::plan::worlds {

using Word = std::uint64_t;

/// A ground atom or term that some action reads or changes, or of which not all is known. Values
/// are positions in the range; of an atom 0 is false and 1 true.
struct Variable {
  bool function = false;
  Index symbol = 0;
  std::vector<Index> arguments;
  Index size = 2;             ///< number of values
  Index initial = kNone;      ///< kNone: worlds may differ in it
  bool hidden = false;        ///< worlds may differ in it, at the start or later
  Index component = kNone;    ///< of a hidden one
  Index word = 0, shift = 0;  ///< in the common part of a belief, or in a world of the component
  Word mask = 0;              ///< not shifted

  [[nodiscard]] Index get(const Word* words) const {
    return static_cast<Index>((words[word] >> shift) & mask);
  }
  void set(Word* words, Index value) const {
    words[word] = (words[word] & ~(mask << shift)) | (static_cast<Word>(value) << shift);
  }
};

/// A ground query about what is known; of conditions of the world: about one world.
struct Condition {
  enum class Kind : std::uint8_t {
    True,
    False,
    And,
    Or,
    Xor,
    Not,
    Is,       ///< the variable is known to have the value
    IsNot,    ///< the variable is known to have another value
    Decided,  ///< the variable's value is known
    Whether   ///< it is known whether the variable has the value
  };
  Kind kind = Kind::True;
  Index variable = 0, value = 0;
  std::vector<Condition> children;
};

/// One update of an action with all conditions that stand before it.
struct Step {
  enum class Kind : std::uint8_t {
    Set,    ///< the variable takes the value
    Free,   ///< where it has the value (`differs`: another one; `any`) it may have any then
    Rule,   ///< an observation: the variable has not the value
    OneOf,  ///< an observation: one of the values of one variable, or exactly one of the atoms
    Sense   ///< the variable's value becomes known
  };
  Kind kind = Kind::Set;
  bool differs = false, any = false;
  bool deletion = false;  ///< these come first
  Index variable = 0, value = 0;
  std::vector<std::pair<Index, Index>> options;  ///< of OneOf: variables and values
  Condition known;                               ///< of the belief: else nothing happens
  Condition world;                               ///< of each world: there it happens
};

struct Operator {
  Index schema = 0;
  std::vector<Index> arguments;
  Condition precondition;
  std::vector<Step> steps;        ///< in the order to apply; sensing last
  std::vector<Index> components;  ///< that the steps change or sense, ascending
  std::int64_t cost = 1;
};

/// Initial constraints over hidden variables: at least one, or exactly one, of literals.
struct Constraint {
  bool exactly_one = false;
  struct Literal {
    Index variable, value;
    bool negated;
  };
  std::vector<Literal> literals;
};

/// A model, ground, as a task about possible worlds: every variable that may differ between worlds
/// belongs to a component; what components say of each other is nothing, at the start and ever, so
/// a belief is a product of one set of worlds for each, and the values of all other variables.
struct WorldTask {
  std::vector<Variable> variables;
  std::vector<Operator> operators;
  Condition goal;
  std::vector<Constraint> constraints;
  std::vector<Index> sensed;  ///< hidden variables known at run time from the start
  Index common_words = 0;
  struct Component {
    std::vector<Index> variables;
    Index words = 0;
  };
  std::vector<Component> components;
};

}  // namespace kaboum::plan::worlds
