#pragma once

#include <kaboum/base/option.h>
#include <kaboum/distance/compare.h>

namespace kaboum::distance {

/// The options of measuring two shapes against each other.
const std::vector<Option<CompareOptions>>& compare_options();

}  // namespace kaboum::distance
