#pragma once

#include <vector>

#include "language/pddl_formula.h"

namespace kaboum::plan {

namespace pddl {

/// PDDL: what one action both adds and deletes holds afterwards. Here the later update wins.
std::vector<syntax::Effect> additions_last(const std::vector<syntax::Effect>& effects);

/// A conditional effect happens or not in the world, known or not: with incomplete knowledge, it
/// may happen where its condition is not known to fail. So far a When has two formulas: that its
/// condition is known to hold, and that it is known to fail.
std::vector<syntax::Effect> conditions_decided(const std::vector<syntax::Effect>& effects,
                                               bool incomplete);

}  // namespace pddl

}  // namespace kaboum::plan
