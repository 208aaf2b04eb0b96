#pragma once

#include <kaboum/plan/model.h>

#include <vector>

namespace kaboum::plan {

/// An argument that is itself a term: slot `slot` stands for its value, `condition` says so.
struct Unfolded {
  Index slot;
  Index type;
  Query condition;
};

Query negation(Query q);

/// `inner` for the value that each unfolded term has.
Query wrap(std::vector<Unfolded> unfolded, Query inner);

/// The same of an effect. Where a term's value is not known, `inner` may happen for any value that
/// it may have, and takes the knowledge that would be wrong then.
Effect wrap(std::vector<Unfolded> unfolded, Effect inner);

}  // namespace kaboum::plan
