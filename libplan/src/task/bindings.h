#pragma once

#include <kaboum/plan/model.h>

#include <vector>

namespace kaboum::plan {

/// Conjuncts of a query; a query that is no conjunction is its own only conjunct.
std::vector<const Query*> conjuncts(const Query& query);

/// Free variables of a query (not those it quantifies), as slots, ascending.
std::vector<Index> free_slots(const Query& query);

/// The object an argument stands for.
inline Index value_of(const Argument& a, const Index* slots) {
  return a.variable ? slots[a.index] : a.index;
}

}  // namespace kaboum::plan
