#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "task/formula.h"
#include "task/ground_action.h"
#include "task/layout.h"
#include "task/query_grounder.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// Makes the effects of ground actions.
class EffectGrounder {
 public:
  EffectGrounder(const Model& model, const Layout& layout, FormulaPool& pool,
                 QueryGrounder& queries, Limits& limits)
      : model_(model), layout_(layout), pool_(pool), queries_(queries), limits_(limits) {}

  /// Appends the effects of the action's schema to `action`, for these slots.
  /// @throws Error{LimitReached} if they are too many; LimitExceeded.
  void ground(std::vector<Index>& slots, GroundAction& action);

 private:
  void ground(const std::vector<Effect>& effects, Formula condition, std::vector<Index>& slots,
              GroundAction& action);
  /// @pre `action` has an effect, to which the update is added.
  void add_update(const Update& u, const std::vector<Index>& slots, GroundAction& action);
  /// Whether a term takes over a value in one of the effects so far.
  static bool is_transferred(Index fluent, const GroundAction& action);
  [[nodiscard]] Layout::Field field(const Update::Literal& l,
                                    const std::vector<Index>& slots) const;
  [[nodiscard]] Index position(const Update::Literal& l, const std::vector<Index>& slots) const;
  [[nodiscard]] Change change_of(const Update& u, const std::vector<Index>& slots,
                                 Index fluent) const;
  [[nodiscard]] Change exclusive_change(const Update& u, const std::vector<Index>& slots,
                                        Index fluent) const;
  [[nodiscard]] bool is_direct(const Change& c) const;
  void add_write(const Change& c, ConditionalEffect& out) const;

  const Model& model_;
  const Layout& layout_;
  FormulaPool& pool_;
  QueryGrounder& queries_;
  Limits& limits_;
  std::size_t updates_ = 0;  ///< of the action at hand
};

}  // namespace kaboum::plan
