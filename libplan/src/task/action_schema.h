#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "task/formula.h"
#include "task/layout.h"
#include "task/query_grounder.h"

namespace kaboum::plan {

/// A ground action, or an outcome of sensing that a branch supposes: what a search applies.
using OperatorId = std::uint32_t;
inline constexpr OperatorId kNoOperator = ~OperatorId{0};

/// An action of the model, made ready to be instantiated parameter by parameter.
class ActionSchema {
 public:
  /// A conjunct of the precondition, tested when its last parameter has been chosen.
  struct Check {
    const Query* query = nullptr;
    std::vector<Index> slots;        ///< parameters that it depends on
    std::vector<const Query*> lets;  ///< that name what it reads, to be ground before it
    std::vector<Formula> grounded;   ///< by the slots' values; empty: too many to tabulate
    bool calls = false;              ///< an external function
  };
  struct Candidate {
    Index object = 0;
    BitTest test;          ///< stands for the single-parameter conjuncts, if its mask is not 0
    Formula full = kTrue;  ///< those conjuncts
  };
  struct Level {
    std::vector<Candidate> candidates;
    std::vector<Check> checks;  ///< of several parameters, in the precondition's order
  };

  /// @pre all arguments outlive the schema. @throws LimitExceeded
  ActionSchema(const Action& action, const Model& model, const Layout& layout, FormulaPool& pool,
               QueryGrounder& queries);

  [[nodiscard]] std::vector<Check>& constant() { return constant_; }  ///< without parameters
  [[nodiscard]] std::vector<Level>& levels() { return levels_; }      ///< by parameter

  /// The conjunct for these values of the slots.
  Formula grounded(Check& check, const Index* slots) {
    if (check.grounded.empty()) return ground(check, slots);
    std::size_t n = 0;
    for (const Index slot : check.slots) {
      const Index type = action_->parameters[slot].type;
      n = n * model_->types[type].objects.size() + layout_->position(type, slots[slot]);
    }
    Formula& f = check.grounded[n];
    if (f == kNotGrounded) f = ground(check, slots);
    return f;
  }

  /// Where the operator of these arguments is noted: kNoOperator if it has not been made yet.
  OperatorId& id(const std::vector<Index>& arguments);

 private:
  static constexpr Formula kNotGrounded = ~Formula{0};

  std::vector<std::vector<const Query*>> sort_conjuncts();
  void make_candidates(const std::vector<std::vector<const Query*>>& singles);
  Formula ground(const Check& check, const Index* slots);

  const Action* action_;
  const Model* model_;
  const Layout* layout_;
  FormulaPool* pool_;
  QueryGrounder* queries_;
  std::vector<Check> constant_;
  std::vector<Level> levels_;
  /// The number of these arguments among all, if that fits a word.
  [[nodiscard]] std::uint64_t number_of(const std::vector<Index>& arguments) const;

  std::vector<OperatorId> ids_;  ///< by the arguments' number; empty: too many to tabulate
  std::unordered_map<std::uint64_t, OperatorId> id_by_number_;
  std::unordered_map<std::string, OperatorId> id_by_arguments_;  ///< where these are too many
  bool numbered_ = true;
};

}  // namespace kaboum::plan
