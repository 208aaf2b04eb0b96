#pragma once

#include <kaboum/plan/model.h>

#include <string>
#include <vector>

#include "task/answer_tree.h"
#include "task/layout.h"

namespace kaboum::plan {

/// "g(a, b)".
std::string call_text(const Model& model, const HandleTable& handles, Index external,
                      const std::vector<Index>& arguments);

/// What was read: ", in a state where pose(o1) = p3, !held(o1)".
std::string state_text(const Model& model, const HandleTable& handles, const Layout& layout,
                       const Footprint& read);

}  // namespace kaboum::plan
