#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "task/solve_limits.h"
#include "task/task.h"

namespace kaboum::plan {

struct Heuristics;

/// What an evaluator says of a state.
struct Estimate {
  std::uint64_t value = 0;  ///< steps, or cost, from the state to the goal; about
  bool dead_end = false;    ///< nothing leads from the state to the goal
  std::uint64_t work = 0;   ///< of saying so [ns, about; counted, not measured]
};

/// An estimate of the distance from a state to the goal. Searches take a list of evaluators; to add
/// one, derive it in a file of its own and name its maker below.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  virtual Estimate evaluate(const Word* state) = 0;
  /// Edges of the graph that an evaluation walks, at most.
  [[nodiscard]] virtual std::size_t size() const { return 1; }

  /// Whether what it calls a dead end is one, by proof. Searches go on where it is not.
  [[nodiscard]] virtual bool is_safe() const = 0;
  /// Whether its values are lower bounds of the cost, which A* needs.
  [[nodiscard]] virtual bool is_admissible() const { return false; }
  /// Whether it is worth its time; asked after an evaluation. One that is not is left out from then
  /// on.
  [[nodiscard]] virtual bool is_worthwhile() const { return true; }

  /// Marks those steps that are likely to lead on from the state evaluated last.
  /// @param steps   that are possible there
  /// @param marked  one for each step
  virtual void prefer(std::span<const OperatorId> /*steps*/, std::vector<char>& /*marked*/) const {}
  /// Steps that might reach the goal from the state evaluated last, in an order that is worth
  /// trying; empty: it knows none.
  [[nodiscard]] virtual std::vector<OperatorId> outline() const { return {}; }
};

/// Makes an evaluator of a task.
using EvaluatorMaker = std::unique_ptr<Evaluator>(Task&, Limits&, Heuristics&);

EvaluatorMaker relaxed_plan_steps;  ///< relaxed_plan.h
EvaluatorMaker landmark_steps;      ///< landmarks.h: LandmarkHeuristic::count
EvaluatorMaker landmark_cost;       ///< landmarks.h: LandmarkHeuristic::evaluate; admissible

/// Those that greedy search takes turns with. The first also tells when to look ahead, and where.
inline constexpr EvaluatorMaker* kGreedyEvaluators[] = {relaxed_plan_steps, landmark_steps};

}  // namespace kaboum::plan
