#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "check/runtime_knowledge.h"

namespace kaboum::plan {

/// The atom or term for these slots.
Fact fact(bool function, Index symbol, const std::vector<Argument>& arguments,
          const std::vector<Index>& slots);

/// The object that an argument stands for.
inline Index object(const Argument& a, const std::vector<Index>& slots) {
  return a.variable ? slots.at(a.index) : a.index;
}

/// Evaluates queries of the lifted model, or lists what they read.
class QueryEvaluator {
 public:
  explicit QueryEvaluator(const Model& model) : model_(model) {}

  bool holds(const Query& q, std::vector<Index>& slots, const RuntimeKnowledge& k) const;
  void reads(const Query& q, std::vector<Index>& slots, std::set<Fact>& out) const;

 private:
  bool holds_of_value(const Query& q, const std::vector<Index>& slots,
                      const RuntimeKnowledge& k) const;
  std::optional<Index> call(Index external, std::vector<Index> arguments) const;

  const Model& model_;
  mutable std::map<std::pair<Index, std::vector<Index>>, std::optional<Index>> calls_;
};

}  // namespace kaboum::plan
