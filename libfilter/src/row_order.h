#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model.h"

namespace kaboum::filter::detail {

/// Numbers of rows in an order in which those that follow each other are mostly near each other, so
/// that those that share vectors look at the same pairs; the same everywhere. Empty: the order is
/// good as it is.
std::vector<std::uint32_t> order_of(const Model& model, std::span<const double> rows);

}  // namespace kaboum::filter::detail
