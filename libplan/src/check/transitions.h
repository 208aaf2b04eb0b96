#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <vector>

#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"

namespace kaboum::plan {

/// The states of run-time knowledge that a model's initial entries and actions lead to.
///
/// Effects under a condition of the world happen where it holds in every world that what is known
/// allows, and may happen where it holds in some. A state that keeps less than follows then says so
/// (RuntimeKnowledge::cut).
///
/// All functions throw Error{LimitReached} where sensing has too many outcomes.
class Transitions {
 public:
  /// Whether states keep initial disjunctions (Or), or only that their atoms are stated.
  enum class Disjunctions : std::uint8_t { Kept, LeftOut };

  /// Whether states are those of one outcome each, or may leave open what was sensed until it is
  /// looked at. Then what looks at it, or changes it, is stopped by LeftOpen.
  enum class Outcomes : std::uint8_t { Apart, MayBeOpen };

  Transitions(const Model& model, const QueryEvaluator& evaluator, Disjunctions disjunctions,
              Outcomes outcomes = Outcomes::Apart)
      : model_(model), evaluator_(evaluator), disjunctions_(disjunctions), outcomes_(outcomes) {}

  /// @throws Error{InvalidInput} if the initial knowledge contradicts itself.
  [[nodiscard]] std::vector<RuntimeKnowledge> initial_states() const;

  /// One for each way that what the action senses may turn out; none if what it observes
  /// contradicts what is known. @param sensed  if not null, gets what it senses
  [[nodiscard]] std::vector<RuntimeKnowledge> after(const Action& action, std::vector<Index>& slots,
                                                    const RuntimeKnowledge& before,
                                                    std::vector<Fact>* sensed = nullptr) const;

  /// One for each outcome of what a state leaves open.
  [[nodiscard]] std::vector<RuntimeKnowledge> look_at(RuntimeKnowledge k, const Fact& f) const;

 private:
  /// An update that happens, or only may.
  struct GroundUpdate {
    const Update* update;
    std::vector<Index> slots;
    bool possibly;
  };
  /// What an action does in a state.
  struct Happening {
    std::vector<GroundUpdate> updates;
    bool tied = false;  ///< some hang on what is unknown, and the state cannot say how
  };

  [[nodiscard]] const std::vector<Index>& range(Index function) const;
  [[nodiscard]] bool may_leave_open(const RuntimeKnowledge& k, const Fact& f) const;
  void sense(RuntimeKnowledge state, const Fact& f, std::vector<RuntimeKnowledge>& next) const;
  [[nodiscard]] std::vector<RuntimeKnowledge> split(RuntimeKnowledge k,
                                                    const std::vector<Fact>& sensed) const;
  void fire(const std::vector<Effect>& effects, std::vector<Index>& slots,
            const RuntimeKnowledge& k, bool possibly, Happening& out) const;
  [[nodiscard]] bool is_handle(const Update::Literal& l) const {
    return l.function && model_.types[model_.functions[l.symbol].range].handle;
  }
  [[nodiscard]] bool in_range(const Update::Literal& l, const std::vector<Index>& slots) const;

  bool learn_literal(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l) const;
  bool learn_exclusive(RuntimeKnowledge& k, const Update& u, const std::vector<Index>& slots) const;
  void delete_literal(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                      const std::vector<Index>& slots) const;
  void delete_from(RuntimeKnowledge& k, const GroundUpdate& g) const;
  bool add_literal(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                   const std::vector<Index>& slots) const;
  bool add_to(RuntimeKnowledge& k, const GroundUpdate& g, const RuntimeKnowledge& before,
              std::vector<Fact>& sensed) const;
  void may_become(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                  const std::vector<Index>& slots) const;

  const Model& model_;
  const QueryEvaluator& evaluator_;
  Disjunctions disjunctions_;
  Outcomes outcomes_;
};

}  // namespace kaboum::plan
