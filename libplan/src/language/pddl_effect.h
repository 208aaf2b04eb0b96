#pragma once

#include <vector>

#include "language/pddl_formula.h"

namespace kaboum::plan {

namespace pddl {

/// PDDL: what one action both adds and deletes holds afterwards. Here the later update wins.
std::vector<syntax::Effect> additions_last(const std::vector<syntax::Effect>& effects);

/// A conditional effect happens or not in the world, known or not: with incomplete knowledge its
/// condition is one of the world.
void decide_in_world(std::vector<syntax::Effect>& effects);

}  // namespace pddl

}  // namespace kaboum::plan
