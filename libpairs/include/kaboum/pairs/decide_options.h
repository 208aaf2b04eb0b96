#pragma once

#include <kaboum/base/option.h>
#include <kaboum/pairs/decide.h>

namespace kaboum::pairs {

/// The options of deciding pairs of links: max-boxes, samples, timeout.
const std::vector<Option<DecideOptions>>& decide_options();

}  // namespace kaboum::pairs
